"""A frame service under everything at once: clients of which some stream, others who come and go, and one attacker of each
kind (as in the study `hostile`). Nobody but the attackers may get an error; memory keeps to its budget and descriptors
stay as many as they are. Writes the latencies for docs/service.md.
"""

import multiprocessing
import os
import sys
import threading
import time

from study.lumulus import add_program_option
from study.service import Server, percentile
from study.studies.hostile import ATTACKS, LIMITS, again
from study.tables import Table

SMALL = {"width": 64, "height": 36, "budget": {"photons": 0}}
STREAMED = {"width": 160, "height": 90, "encoding": "jpeg", "budget": {"photons": 0}, "max_rate": 10}
CONNECTIONS = 160  # of each listener: room for all of them


class Work(threading.Thread):
    """What a client does again and again until the end: `once(client)`; its seconds, and why it failed."""

    def __init__(self, server, until, begin, once, pause=0.0):
        super().__init__()
        self.server, self.until, self.begin, self.once, self.pause = server, until, begin, once, pause
        self.times, self.error = [], None

    def run(self):
        try:
            with self.server.client(timeout=120) as client:
                state = self.begin(client)
                while time.monotonic() < self.until:
                    started = time.monotonic()
                    self.once(client, state)
                    self.times.append(time.monotonic() - started)
                    time.sleep(self.pause)
        except Exception as error:  # whatever it is, the run has failed
            self.error = f"{type(error).__name__}: {error}"


def come_and_go(server, until, failures):
    """Clients that connect, look once and leave."""
    while time.monotonic() < until:
        try:
            with server.client(timeout=120) as client:
                client.frame(**SMALL)
        except Exception as error:  # as above
            failures.append(f"a client that came: {type(error).__name__}: {error}")
        time.sleep(0.2)


def descriptors(server):
    return len(os.listdir(f"/proc/{server.process.pid}/fd"))


def add_options(parser):
    add_program_option(parser)
    parser.add_argument("--seconds", type=float, default=900.0)
    parser.add_argument("--clients", type=int, default=64)
    parser.add_argument("--streams", type=int, default=16)


def crowd(server, options, until):
    """The clients that are no attackers, by what they do."""
    nothing = lambda client: None
    one_frame = lambda client, _: client.frame(**SMALL)
    streams = [Work(server, until, lambda client: client.start_stream(**STREAMED),
                    lambda client, number: client.next_frame(number)) for _ in range(options.streams)]
    lone = [Work(server, until, nothing, one_frame, 0.1)]
    pings = [Work(server, until, nothing, lambda client, _: client.ping(), 1.0)
             for _ in range(options.clients - options.streams - 1)]
    return {"streams of 160×90": streams, "a lone client's frames of 64×36": lone, "pings of the others": pings}


def watched(server, until):
    """Most bytes of the budget in use, most resident bytes, and descriptors: after the first third, and most later."""
    used, resident, open_at_first, most_open = 0, 0, 0, 0
    begin = time.monotonic()
    with server.client(timeout=120) as client:
        while time.monotonic() < until:
            used = max(used, client.statistics()["memory_bytes"])
            resident = max(resident, server.memory())
            if time.monotonic() - begin < (until - begin) / 3:
                open_at_first = max(open_at_first, descriptors(server))
            most_open = max(most_open, descriptors(server))
            time.sleep(0.5)
        statistics = client.statistics()
    return used, resident, open_at_first, most_open, statistics


def main(options):
    limits = LIMITS.replace("connections = 48", f"connections = {CONNECTIONS}")
    server = Server(str(options.lumulus), limits=limits + "requests_per_second = 1000")
    attackers = [multiprocessing.Process(target=again(attack), args=(server.tcp, server.http), daemon=True)
                 for name, attack in ATTACKS.items() if name != "nobody"]
    until = time.monotonic() + options.seconds
    failures = []
    groups = crowd(server, options, until)
    guests = threading.Thread(target=come_and_go, args=(server, until, failures))
    try:
        for process in attackers:
            process.start()
        for work in sum(groups.values(), []):
            work.start()
        guests.start()
        used, resident, open_at_first, most_open, statistics = watched(server, until)
        for work in sum(groups.values(), []):
            work.join()
        guests.join()
    finally:
        for process in attackers:
            process.kill()
            process.join()
        code = server.stop()
    table = Table(["", "count", "p50", "p99", "most"])
    for name, works in groups.items():
        times = sum((work.times for work in works), [])
        failures += [f"{name}: {work.error}" for work in works if work.error]
        shown = [1e3 * percentile(times, 0.5), 1e3 * percentile(times, 0.99), 1e3 * max(times)]
        table.add({"case": name, "milliseconds": shown}, [name, str(len(times)), *(f"{value:.0f} ms" for value in shown)])
    print(f"memory of the budget: at most {used / 1e6:.0f} of {statistics['memory_limit_bytes'] / 1e6:.0f} MB; "
          f"resident: at most {resident / 1e6:.0f} MB")
    print(f"descriptors: at most {open_at_first} in the first third, {most_open} in all")
    failures += [f"the server ended with {code}"] if code else []
    failures += ["more memory than the budget"] if used > statistics["memory_limit_bytes"] else []
    for failure in failures:
        print("FAILED:", failure)
    sys.exit(1 if failures else 0)

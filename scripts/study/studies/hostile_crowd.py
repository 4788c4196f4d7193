"""A frame service under everything at once: clients of which some stream, others who come and go, and one attacker of each
kind (as in the study `hostile`). Nobody but the attackers may get an error; memory keeps to its budget and descriptors
stay as many as they are. Writes the latencies for docs/service.md. What else the machine does counts in them: the load
that is printed should be that of this study alone, of the server and 12 attackers.
"""

import collections
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
CONNECTIONS = 400  # of each listener: room for all of them, and for those of an attacker's that are not closed yet
WARM_UP = 5.0      # seconds before attacks begin, in which all have their first answer


class Work(threading.Thread):
    """What a client does again and again until the end: `once(client)`, which may return the seconds that count (by default
    those that it took); these, and why it failed."""

    def __init__(self, server, until, patience, begin, once, pause=0.0):
        super().__init__()
        self.server, self.until, self.patience = server, until, patience
        self.begin, self.once, self.pause = begin, once, pause
        self.times, self.error = [], None

    def run(self):
        started = time.monotonic()
        try:
            with self.server.client(timeout=self.patience) as client:
                state = self.begin(client)
                while time.monotonic() < self.until:
                    started = time.monotonic()
                    seconds = self.once(client, state)
                    self.times.append(time.monotonic() - started if seconds is None else seconds)
                    time.sleep(self.pause)
        except Exception as error:  # whatever it is, the run has failed
            self.error = (f"{type(error).__name__}: {error}, after {len(self.times)} answers and "
                          f"{time.monotonic() - started:.0f} s of waiting for one")


def delay_of_next(client, stream):
    """Seconds from when a frame of the stream was due until it was ready to be sent."""
    return client.next_frame(stream).info["milliseconds"]["total"] / 1e3


def ask(request):
    """Work that counts by the time that an answer takes."""
    def once(client, _):
        request(client)
    return once


def come_and_go(server, until, patience, failures):
    """Clients that connect, look once and leave."""
    while time.monotonic() < until:
        try:
            with server.client(timeout=patience) as client:
                client.frame(**SMALL)
        except Exception as error:  # as above
            failures.append(f"a client that came: {type(error).__name__}: {error}")
        time.sleep(0.2)


def later(attack):
    """The attack, when all others have begun."""
    def run(tcp, http):
        time.sleep(WARM_UP)
        attack(tcp, http)
    return run


def descriptors(server):
    return len(os.listdir(f"/proc/{server.process.pid}/fd"))


def add_options(parser):
    add_program_option(parser)
    parser.add_argument("--seconds", type=float, default=900.0)
    parser.add_argument("--clients", type=int, default=64)
    parser.add_argument("--streams", type=int, default=16)
    parser.add_argument("--patience", type=float, default=120.0,
                        help="seconds that a client waits for an answer; more where the machine has other work")


def crowd(server, options, until):
    """The clients that are no attackers, by what they do."""
    def work(begin, once, pause=0.0):
        return Work(server, until, options.patience, begin, once, pause)

    def nothing(_):
        return None

    streams = [work(lambda client: client.start_stream(**STREAMED), delay_of_next) for _ in range(options.streams)]
    lone = [work(nothing, ask(lambda client: client.frame(**SMALL)), 0.1)]
    pings = [work(nothing, ask(lambda client: client.ping()), 1.0)
             for _ in range(options.clients - options.streams - 1)]
    return {"frames of the streams of 160×90: from due to ready": streams,
            "frames of 64×36 of a lone client: from asked to there": lone, "pings of the others": pings}


class Watch:
    """Looks at the server twice a second until the end."""

    def __init__(self, server, until, patience):
        self.used, self.resident, self.open, self.load = 0, 0, [], 0.0
        with server.client(timeout=patience) as client:
            while time.monotonic() < until:
                self.used = max(self.used, client.statistics()["memory_bytes"])
                self.resident = max(self.resident, server.memory())
                self.open.append(descriptors(server))
                self.load = max(self.load, os.getloadavg()[0])
                time.sleep(0.5)
            self.statistics = client.statistics()
        self.limit = self.statistics["memory_limit_bytes"]

    def open_in(self, third):
        """Most descriptors in the first, second or last third (0 to 2) of the time."""
        size = max(1, len(self.open) // 3)
        return max(self.open[third * size:(third + 1) * size] or self.open)

    def failures(self):
        spare = 16  # those who come at the moment
        if self.used > self.limit:
            yield "more memory than the budget"
        if self.open_in(2) > self.open_in(0) + spare:
            yield f"descriptors grow: {self.open_in(0)} in the first third, {self.open_in(2)} in the last"

    def report(self):
        print(f"memory of the budget: at most {self.used / 1e6:.0f} of {self.limit / 1e6:.0f} MB; "
              f"resident: at most {self.resident / 1e6:.0f} MB")
        print("descriptors: at most {}, {} and {} in the three thirds".format(*(self.open_in(i) for i in range(3))))
        print(f"load of the machine: at most {self.load:.0f}, {os.cpu_count()} cores")


def report(groups):
    """A table of what each group waited for. Returns what failed."""
    table = Table(["", "count", "p50", "p99", "most"])
    failures = []
    for name, works in groups.items():
        times = sum((work.times for work in works), [])
        failures += [f"{name}: {work.error}" for work in works if work.error]
        failures += [f"{name}: no answer at all" for work in works if not work.times and not work.error]
        if times:
            shown = [1e3 * percentile(times, 0.5), 1e3 * percentile(times, 0.99), 1e3 * max(times)]
            table.add({"case": name, "milliseconds": shown},
                      [name, str(len(times)), *(f"{value:.0f} ms" for value in shown)])
    return failures


def main(options):
    limits = LIMITS.replace("connections = 48", f"connections = {CONNECTIONS}")
    server = Server(str(options.lumulus), limits=limits + "requests_per_second = 1000")
    attackers = [multiprocessing.Process(target=later(again(attack)), args=(server.tcp, server.http), daemon=True)
                 for name, attack in ATTACKS.items() if name != "nobody"]
    until = time.monotonic() + WARM_UP + options.seconds
    failures = []
    groups = crowd(server, options, until)
    everybody = sum(groups.values(), [])
    everybody.append(threading.Thread(target=come_and_go, args=(server, until, options.patience, failures)))
    try:
        for process in attackers:  # before there are threads, since these processes are forks
            process.start()
        for work in everybody:
            work.start()
        watch = Watch(server, until, options.patience)
        for work in everybody:
            work.join()
    finally:
        for process in attackers:
            if process.pid:
                process.kill()
                process.join()
        code = server.stop()
    failures += report(groups)
    watch.report()
    failures += [f"the server ended with {code}"] if code else []
    failures += watch.failures()
    for failure, count in collections.Counter(failures).items():
        print("FAILED:", failure, f"({count} times)" if count > 1 else "")
    sys.exit(1 if failures else 0)

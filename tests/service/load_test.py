"""Many clients at once: load_test.py [--seconds S] [--clients N] [--streams N]. Prints what it measured.

Connects the clients, of which some stream, and asks: no error, memory flat after the first 10 s (the first third of a
shorter run), Jain's fairness index of the frames that each stream got at least .9 (Jain, Chiu and Hawe 1984), and
latencies against that of one lone frame.
"""

import argparse
import os
import sys
import threading
import time

from server import LUMULUS, Server

WISHES = {"width": 320, "height": 180, "encoding": "jpeg", "budget": {"photons": 0}}


def jain(counts):
    return sum(counts) ** 2 / (len(counts) * sum(count * count for count in counts))


def percentile(values, share):
    return sorted(values)[min(len(values) - 1, int(share * len(values)))]


class Client(threading.Thread):
    """Work of one client; `error` is why it ended early."""

    def __init__(self, server, until, work):
        super().__init__()
        self.server, self.until, self.work, self.times, self.error = server, until, work, [], None

    def run(self):
        try:
            with self.server.client() as client:
                self.work(client, self)
        except Exception as error:  # whatever it is, the run has failed
            self.error = error

    def going(self):
        self.times.append(time.monotonic())
        return self.times[-1] < self.until

    def waits(self):
        """Seconds from one frame to the next."""
        return [after - before for before, after in zip(self.times, self.times[1:])]


def ask(client, run):
    while run.going():
        client.frame(**WISHES)


def stream(client, run):
    number = client.start_stream(max_rate=1000, **WISHES)
    while run.going():
        client.next_frame(number)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=15.0)
    parser.add_argument("--clients", type=int, default=64)
    parser.add_argument("--streams", type=int, default=16)
    options = parser.parse_args()
    server = Server(LUMULUS, limits="connections = 128")
    idle = [server.client() for _ in range(options.clients - options.streams)]
    lone = Client(server, time.monotonic() + 3.0, ask)
    lone.run()
    end = time.monotonic() + options.seconds
    streams = [Client(server, end, stream) for _ in range(options.streams)]
    for one in streams:
        one.start()
    settled = min(10.0, options.seconds / 3.0)
    time.sleep(settled)
    after, peak = server.memory(), 0
    while time.monotonic() < end:
        time.sleep(0.2)
        peak = max(peak, server.memory())
    for one in streams:
        one.join()
    statistics = idle[0].statistics()
    for client in idle:
        client.ping()
        client.close()
    code = server.stop()
    counts = [len(one.times) - 1 for one in streams]
    waits = [wait for one in streams for wait in one.waits()]
    print(f"{sum(counts)} frames to {options.streams} of {options.clients} clients in {options.seconds:.0f} s")
    print(f"Jain index {jain(counts):.4f}")
    print(f"memory {after / 1e6:.0f} MB after {settled:.0f} s, at most {peak / 1e6:.0f} MB later")
    for what, values in (("one lone client asks", lone.waits()), (f"{options.streams} streams", waits)):
        print(f"{what}: a frame every {1e3 * percentile(values, 0.5):.1f} ms (p50), "
              f"{1e3 * percentile(values, 0.99):.1f} ms (p99)")
    errors = [str(one.error) for one in [lone, *streams] if one.error]
    problems = errors + ([f"the server ended with {code}"] if code else [])
    if peak > 1.05 * after + 20e6:
        problems.append("memory grows")
    if jain(counts) < 0.9:
        problems.append("shares are not fair")
    if statistics["requests_refused_total"]:
        problems.append(f"{statistics['requests_refused_total']} requests were refused")
    for problem in problems:
        print("FAILED:", problem)
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()

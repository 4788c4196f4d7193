"""How long a client waits for small frames beside others who ask for much: fairness_test.py [unittest arguments]."""

import threading
import time
import unittest

from server import Server

SMALL = {"width": 48, "height": 36, "encoding": "half", "budget": {"photons": 0}}
LARGE = {"width": 1024, "height": 768, "encoding": "float", "budget": {"photons": 0}}
CROWD = 8


class Waits(threading.Thread):
    """A client who asks for one small frame after the other, with short pauses, until it is told that that is enough."""

    def __init__(self, server):
        super().__init__()
        self.server, self.seconds, self.error, self.done = server, [], None, threading.Event()

    def run(self):
        try:
            with self.server.client() as client:
                while not self.done.is_set():
                    begin = time.monotonic()
                    client.frame(**SMALL)
                    self.seconds.append(time.monotonic() - begin)
                    time.sleep(0.01)
        except Exception as error:  # whatever it is, the run has failed
            self.error = error

    def end(self):
        self.done.set()
        self.join()
        if self.error:
            raise self.error
        return sorted(self.seconds)


class Fairness(unittest.TestCase):
    def setUp(self):
        self.server = Server()
        self.addCleanup(self.server.stop)
        with self.server.client() as client:
            client.frame(width=16, height=16)  # fills the ring
            for wishes in (SMALL, LARGE):  # compiles what they need
                client.frame(**wishes)
            begin = time.monotonic()
            client.frame(**LARGE)
            self.large = time.monotonic() - begin

    def test_streams_of_large_frames(self):
        """Each of many clients has a stream of large frames: they get less often what takes longer."""
        crowd = [self.server.client() for _ in range(CROWD)]
        for one in crowd:
            self.addCleanup(one.close)
            one.start_stream(max_rate=1000, **LARGE)
            threading.Thread(target=self.read, args=(one,), daemon=True).start()
        time.sleep(2 * self.large)
        waits = Waits(self.server)
        waits.start()
        time.sleep(max(5.0, 20 * self.large))
        seconds = waits.end()
        typical = seconds[len(seconds) // 2]
        print(f"a lone large frame {1e3 * self.large:.0f} ms; small ones beside {CROWD} streams of them: "
              f"{1e3 * typical:.0f} ms (p50), {1e3 * seconds[-1]:.0f} ms (most)")
        self.assertGreater(len(seconds), 10)
        self.assertLess(typical, 1.5 * self.large, "a small frame waits for one large one, not for all")

    def read(self, client):
        try:
            while client.receive():
                pass
        except (OSError, ValueError):
            pass  # the test is over

    def test_frames_come_within_a_long_one(self):
        """A frame of many large views takes seconds: small frames come between its parts."""
        views = [{"width": 1024, "height": 768}] * 5
        waits = Waits(self.server)
        with self.server.client() as client:
            begin = time.monotonic()
            request = client.send("frame", {"views": views, "encoding": "jpeg", "budget": {"photons": 0}})
            waits.start()
            client.wait(request)
            whole = time.monotonic() - begin
        seconds = waits.end()
        print(f"a frame of {len(views)} views {1e3 * whole:.0f} ms; small ones meanwhile: "
              f"{1e3 * seconds[len(seconds) // 2]:.0f} ms (p50), {1e3 * seconds[-1]:.0f} ms (most)")
        self.assertGreater(len(seconds), 3)
        self.assertLess(seconds[-1], 0.6 * whole)


if __name__ == "__main__":
    unittest.main(verbosity=2)

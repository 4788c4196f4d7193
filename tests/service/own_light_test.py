"""Clients that change the light of a scene others see: own_light_test.py [unittest arguments]."""

import threading
import time
import unittest

from server import Server
from lumulus_client import ServiceError  # server.py knows where it lies

WISHES = {"width": 48, "height": 36, "encoding": "half"}
EVENING = {"sun": {"azimuth": 90, "elevation": 5, "irradiance": [3, 2, 1]}}
HEAVY = 1e6  # 1/m: the cloud has an optical thickness of some 10^8


def picture(client, **wishes):
    return client.frame(**WISHES, **wishes).info["hash"]


class Gaps(threading.Thread):
    """A client who asks for one frame after the other; `longest` is how many seconds it had to wait for one."""

    def __init__(self, server):
        super().__init__()
        self.server, self.longest, self.frames, self.error, self.done = server, 0.0, 0, None, threading.Event()

    def run(self):
        try:
            with self.server.client() as client:
                client.frame(**WISHES)
                while not self.done.is_set():
                    start = time.monotonic()
                    client.frame(**WISHES, budget={"photons": 0})
                    self.longest = max(self.longest, time.monotonic() - start)
                    self.frames += 1
        except Exception as error:  # whatever it is, the run has failed
            self.error = error


class OwnLight(unittest.TestCase):
    def serve(self, **options):
        server = Server(**options)
        self.addCleanup(server.stop)
        return server

    def test_nobody_changes_what_others_see(self):
        server = self.serve()
        with server.client() as one, server.client() as other:
            before = picture(one)
            self.assertEqual(picture(other), before)
            changed = picture(one, **EVENING)
            self.assertNotEqual(changed, before)
            self.assertEqual(picture(other), before)
            self.assertEqual(picture(one), changed, "the light stays the client's")
            other.change(extinction=0.001)
            self.assertNotIn(picture(other), (before, changed))
            self.assertEqual(picture(one), changed)
            with server.client() as third:
                self.assertEqual(picture(third), before)
            one.load_scene("small.toml")
            self.assertEqual(picture(one), before, "who loads the scene sees it as it was loaded")

    def test_light_of_its_own_is_that_of_a_scene_loaded_with_it(self):
        server = self.serve()
        with server.client() as one, server.client() as other:
            changed = picture(one, **EVENING)
            other.load_scene("small.toml", private=True, set=["sun.azimuth=90", "sun.elevation=5", "sun.irradiance=[3,2,1]"])
            self.assertEqual(picture(other), changed)

    def test_the_light_of_the_scene_is_no_change(self):
        server = self.serve(limits="own_lights = 0")
        with server.client() as one:
            before = picture(one)
            self.assertEqual(picture(one, extinction=0.03), before)
            with self.assertRaises(ServiceError) as refused:
                picture(one, extinction=0.02)
            self.assertEqual(refused.exception.code, "busy")
            self.assertEqual(picture(one), before)

    def test_room_is_given_back(self):
        server = self.serve(limits="own_lights = 1")
        with server.client() as one:
            with server.client() as other:
                picture(other, **EVENING)
                for ask in (lambda: picture(one, **EVENING), lambda: one.change(**EVENING),
                            lambda: one.next_frame(one.start_stream(**WISHES, **EVENING))):
                    with self.assertRaises(ServiceError) as refused:
                        ask()
                    self.assertEqual(refused.exception.code, "busy")
            deadline = time.monotonic() + 20
            while True:
                try:
                    picture(one, **EVENING)
                    break
                except ServiceError as error:
                    self.assertEqual(error.code, "busy")
                    self.assertLess(time.monotonic(), deadline, "the room of a client that has gone is free")
                    time.sleep(0.1)

    def test_shared_light(self):
        server = self.serve(security="shared_light = true")
        with server.client() as one, server.client() as other:
            before = picture(other)
            changed = picture(one, **EVENING)
            self.assertNotEqual(changed, before)
            self.assertEqual(picture(other), changed)


class HeavyWork(unittest.TestCase):
    """Work that takes longer than the limits is cut off; others hardly notice."""

    def setUp(self):
        self.server = Server(limits="generation_seconds = 2")
        self.addCleanup(self.server.stop)

    def test_only_who_asks_for_it_is_told(self):
        other = Gaps(self.server)
        other.start()
        with self.server.client() as client:
            before = picture(client)
            for ask in (lambda: picture(client, extinction=HEAVY), lambda: (client.change(extinction=HEAVY), picture(client))):
                with self.assertRaises(ServiceError) as refused:
                    ask()
                self.assertEqual(refused.exception.code, "too_large")
                self.assertIn("longer than the limits", str(refused.exception))
                self.assertEqual(picture(client), before, "the light of before comes back")
            changed = picture(client, **EVENING)
            with self.assertRaises(ServiceError):
                picture(client, extinction=HEAVY)
            picture(client)
            self.assertNotEqual(changed, before)
        other.done.set()
        other.join()
        self.assertIsNone(other.error)
        self.assertGreater(other.frames, 20)
        print(f"another client's longest wait for a frame: {1e3 * other.longest:.0f} ms")
        with self.server.client() as client:
            self.assertEqual(picture(client), before, "the default scene is there")

    def test_light_of_others_changes_meanwhile(self):
        """Neither a change of light nor the photons of another client's light wait for the end of heavy work."""
        outcome = []

        def attack():
            with self.server.client() as client:
                try:
                    outcome.append(picture(client, extinction=HEAVY))
                except ServiceError as error:
                    outcome.append(error.code)

        with self.server.client() as client:
            picture(client, **EVENING)
            attacker = threading.Thread(target=attack)
            attacker.start()
            self.server.event("light_made")
            self.server.event("light_made")
            hashes, longest = set(), 0.0
            while not outcome:
                start = time.monotonic()
                client.change(sun={"azimuth": 10 * len(hashes) % 360, "elevation": 40 + len(hashes) // 36})
                hashes.add(picture(client))
                if not outcome:
                    longest = max(longest, time.monotonic() - start)
            attacker.join()
        self.assertEqual(outcome, ["too_large"])
        self.assertGreater(len(hashes), 3, "each change is seen before the heavy work ends")
        print(f"{len(hashes)} pictures of a changed light, longest wait for one: {1e3 * longest:.0f} ms")


if __name__ == "__main__":
    unittest.main(verbosity=2)

"""What breaks: clients that die, a server that is killed, a full disk, a scene file that goes."""

import hashlib
import os
import queue
import resource
import signal
import subprocess
import threading
import time
import unittest

from server import LUMULUS, SCENE, Server, ServiceTest
from supervisor_test import get
from lumulus_client import ServiceError


def limit_file_size():
    """Files of the server end at 1 MiB, as on a full disk."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 20, 1 << 20))


class Faults(ServiceTest):
    options = {"limits": "message_seconds = 5"}

    def served(self):
        with self.server.client() as client:
            self.assertTrue(client.frame(width=16, height=16).verify())

    def uploads(self):
        return os.listdir(os.path.join(self.server.folder, "uploads"))

    def test_clients_die_at_any_moment(self):
        with self.server.client() as other:
            stream = other.start_stream(width=32, height=32, max_rate=1000)
            for number in range(40):
                client = self.server.client()
                if number % 4 == 0:  # in the middle of a request
                    client.socket.sendall(b"LMLS\x01\0\x04\0")
                elif number % 4 == 1:  # in the middle of a frame
                    client.send("frame", {"width": 512, "height": 384})
                    time.sleep(0.01)
                elif number % 4 == 2:  # in the middle of an upload
                    client.ask("upload", {"hash": "a" * 64, "size": 1000, "offset": 0}, b"x" * 500)
                else:  # while a scene is loaded
                    client.send("load_scene", {"name": "small.toml", "private": True})
                client.close()
                self.assertTrue(other.next_frame(stream).verify())
        self.served()
        deadline = time.monotonic() + 10
        while self.uploads() or self.open_connections() > 1:
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.1)

    def open_connections(self):
        with self.server.client() as client:
            return client.statistics()["connections_open"]

    def test_the_scene_file_goes(self):
        path = self.server.write("scenes/passing.toml", SCENE)
        with self.server.client() as client:
            client.load_scene("passing.toml")
            before = client.frame().info["hash"]
            os.remove(path)
            self.assertEqual(client.frame().info["hash"], before)
            with self.assertRaises(ServiceError) as caught:
                client.load_scene("passing.toml")
            self.assertEqual(caught.exception.code, "not_found")
            self.assertEqual(client.frame().info["hash"], before)

    def test_uploads(self):
        path = os.path.join(self.server.folder, "ball.vdb")
        os.spawnlp(os.P_WAIT, LUMULUS, "lumulus", "cloud", "sphere", "-o", path, "--resolution", "24",
                   "--quiet")
        with self.server.client() as client:
            digest = client.upload(path)
            with open(path, "rb") as file:
                self.assertEqual(digest, "sha256:" + hashlib.sha256(file.read()).hexdigest())
            self.assertEqual(self.uploads(), [digest.removeprefix("sha256:") + ".vdb"])
            self.assertEqual([entry["hash"] for entry in client.list_uploads()["uploads"]], [digest])
            client.load_scene("small.toml", vdb=digest)
            self.assertGreater(client.frame(products=["cloud"]).values("cloud")[..., 3].max(), 0.1)
            with self.assertRaises(ServiceError) as caught:
                client.load_scene("small.toml", vdb="0" * 64)
            self.assertEqual(caught.exception.code, "not_found")
            # bytes that are no cloud are stored, and refused when they are loaded
            junk = os.path.join(self.server.folder, "junk.vdb")
            with open(junk, "wb") as file:
                file.write(os.urandom(5000))
            junk_digest = client.upload(junk)
            with self.assertRaises(ServiceError) as caught:
                client.load_scene("small.toml", vdb=junk_digest)
            self.assertEqual(caught.exception.code, "bad_request")
            # the message names the upload, and nothing of the server
            self.assertIn("upload " + junk_digest, str(caught.exception))
            self.assertNotIn(self.server.folder, str(caught.exception))
            fetched = subprocess.run([LUMULUS, "fetch", "--address", self.server.tcp, "--vdb", junk, "-o",
                                      os.path.join(self.server.folder, "out.png")], capture_output=True, text=True)
            self.assertEqual(fetched.returncode, 2)
            self.assertIn(f"({junk})", fetched.stderr)
            self.assertNotIn("uploads", fetched.stderr)
            with self.server.client() as another:  # of the same address
                self.assertTrue(another.delete_upload(digest))
                self.assertTrue(another.delete_upload(junk_digest))
                self.assertFalse(another.delete_upload(digest))
                self.assertEqual(another.list_uploads()["uploads"], [])
        self.assertEqual(self.uploads(), [])


class FullDisk(ServiceTest):
    options = {"preexec": limit_file_size}

    def test_an_upload_fails_and_leaves_nothing(self):
        path = os.path.join(self.server.folder, "large.vdb")
        with open(path, "wb") as file:
            file.write(os.urandom(3 << 20))
        with self.server.client() as client:
            with self.assertRaises(ServiceError) as caught:
                client.upload(path)
            self.assertEqual(caught.exception.code, "storage")
            self.assertEqual(os.listdir(os.path.join(self.server.folder, "uploads")), [])
            self.assertTrue(client.frame(width=16, height=16).verify())


class Restart(unittest.TestCase):
    def test_a_streaming_client_comes_back(self):
        first = Server(LUMULUS)
        first.owns = False
        ports = tuple(int(address.rsplit(":", 1)[1]) for address in (first.tcp, first.http))
        stop, frames, losses = threading.Event(), [], []

        def stream():
            while not stop.is_set():
                try:
                    with first.client(timeout=5) as client:
                        number = client.start_stream(width=32, height=32, max_rate=50)
                        while not stop.is_set():
                            frames.append(client.next_frame(number).info["number"])
                except OSError:
                    losses.append(1)
                    time.sleep(0.1)

        thread = threading.Thread(target=stream)
        thread.start()
        try:
            self.wait(lambda: len(frames) > 5)
            first.kill()
            before = len(frames)
            second = Server(LUMULUS, folder=first.folder, ports=ports)
            second.owns = True
            self.wait(lambda: len(frames) > before + 5)
            self.assertTrue(losses)
        finally:
            stop.set()
            thread.join(20)
        self.assertEqual(second.stop(), 0)

    def wait(self, condition):
        deadline = time.monotonic() + 60
        while not condition():
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.05)


class DefaultScene(unittest.TestCase):
    """A default scene whose photons take longer than the limits allow goes. It does so when the server stands still in the
    middle of a generation, as on a machine that swaps; there is one under way for most of the time."""

    SCENE = SCENE.replace("photons = 40000", "photons = 2000000000").replace("generations = 4", "generations = 4000").replace(
        "bands = 3", "bands = 1")
    SECONDS = 2.0  # for a generation

    def served(self, reload_seconds):
        server = Server(LUMULUS, scene=self.SCENE, limits=f"generation_seconds = {self.SECONDS}\nreload_seconds = {reload_seconds}")
        self.addCleanup(server.stop)
        return server

    def stand_still(self, server):
        """Until that is within a generation: before the first one and between two, it counts for none."""
        for _ in range(6):
            server.process.send_signal(signal.SIGSTOP)
            time.sleep(self.SECONDS + 0.5)
            server.process.send_signal(signal.SIGCONT)
            try:
                event = server.event("generation_failed", 10)
            except queue.Empty:
                continue
            return self.assertIn("longer than the limits", event["message"])
        self.fail(f"no generation was cut off: {server.log}")

    def frame(self, server):
        with server.client() as client:
            return client.frame(width=16, height=16, budget={"photons": 0}).verify()

    def refused(self, server, code):
        with server.client() as client, self.assertRaises(ServiceError) as caught:
            client.frame(width=16, height=16, budget={"photons": 0})
        self.assertEqual(caught.exception.code, code)

    def test_it_is_loaded_again(self):
        server = self.served(0)
        for _ in range(2):
            self.assertTrue(self.frame(server))
            self.stand_still(server)
            server.event("scene_loaded", 60)
        self.assertTrue(self.frame(server))
        self.assertEqual(get(server, "/ready"), (200, "ready\n"))

    def test_one_that_did_not_last_stays_gone(self):
        """Loading it again would not end."""
        server = self.served(600)
        self.assertTrue(self.frame(server))
        self.stand_still(server)
        self.refused(server, "no_scene")
        self.assertEqual(get(server, "/ready"), (503, "the default scene is gone\n"))
        self.assertEqual(sum(event["event"] == "scene_loading" for event in server.log), 1)
        with server.client() as client:
            client.load_scene(toml='[[cloud]]\nprocedural = "sphere"\nresolution = 8\n[photon_map]\nphotons = 1000\n')
            self.assertTrue(client.frame(width=16, height=16).verify())

    def test_its_file_has_gone(self):
        server = self.served(0)
        os.remove(os.path.join(server.folder, "scenes", "small.toml"))
        self.stand_still(server)
        self.assertIn("small.toml", server.event("scene_refused")["message"])
        self.refused(server, "no_scene")
        self.assertEqual(get(server, "/ready"), (503, "the default scene is gone\n"))


if __name__ == "__main__":
    unittest.main()

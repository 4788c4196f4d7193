"""What those who watch the service see: /health, /ready, systemd's notifications, the end in time, the unit file."""

import datetime
import hashlib
import os
import socket
import subprocess
import tempfile
import threading
import time
import unittest
import urllib.error
import urllib.request

from server import Server
from lumulus_client import HEADER, MAGIC, TYPES, ServiceError

HERE = os.path.dirname(os.path.abspath(__file__))
UNIT = os.path.join(HERE, "..", "..", "configs", "lumulus.service")
LARGE_SCENE = '[[cloud]]\nprocedural = "cumulus"\nresolution = 480\n'  # takes seconds to make


def get(server, path):
    try:
        with urllib.request.urlopen(f"http://{server.http}{path}", timeout=10) as answer:
            return answer.status, answer.read().decode()
    except urllib.error.HTTPError as error:
        with error:
            return error.code, error.read().decode()


class Loading(unittest.TestCase):
    def test_listens_while_the_default_scene_loads(self):
        server = Server(scene=LARGE_SCENE, wait=False)
        server.listening()
        self.assertEqual(get(server, "/health"), (200, "ok\n"))
        self.assertEqual(get(server, "/ready"), (503, "the default scene is being loaded\n"))
        with server.client() as client:
            client.ping()
            with self.assertRaises(ServiceError) as caught:
                client.change(extinction=0.1)
            self.assertEqual(caught.exception.code, "busy")
            client.send("load_scene", {"name": "small.toml"})  # the default scene is not loaded twice
            client.ping()
        self.assertEqual(server.stop(10), 0)
        self.assertEqual(len([e for e in server.log if e["event"] == "scene_loading"]), 1)

    def test_what_is_asked_for_meanwhile_waits(self):
        server = Server(wait=False)
        server.listening()
        with server.client() as client:
            request = client.send("frame", {"width": 16, "height": 16})
            self.assertTrue(client.wait(request)[1])
        server.event("ready")
        self.assertEqual(get(server, "/ready"), (200, "ready\n"))
        self.assertEqual(server.stop(), 0)

    def test_frames_end_with_the_service(self):
        server = Server(scene=LARGE_SCENE, wait=False)
        server.listening()
        with server.client() as client:
            request = client.send("frame", {"width": 16, "height": 16})
            client.ping()
            server.process.terminate()
            with self.assertRaises(ServiceError) as caught:
                client.wait(request)
            self.assertEqual(caught.exception.code, "shutting_down")
        self.assertEqual(server.stop(10), 0)

    def test_a_bad_default_scene_ends_it(self):
        for scene, word in (("[image]\nwidht = 3\n", "widht"), ('[[cloud]]\nvdb = "absent.vdb"\n', "absent.vdb")):
            server = Server(scene=scene, wait=False)
            self.assertEqual(server.process.wait(30), 2)
            server.reader.join(5)
            errors = [event["text"] for event in server.log if event["event"] == "text"]
            self.assertEqual(len(errors), 1, server.log)
            self.assertIn("the default scene: ", errors[0])
            self.assertIn(word, errors[0])
            server.stop()


class Systemd(unittest.TestCase):
    def test_is_told_of_life_and_end(self):
        with tempfile.TemporaryDirectory() as folder, socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as notes:
            path = os.path.join(folder, "notify")
            notes.bind(path)
            notes.settimeout(30)
            server = Server(env={**os.environ, "NOTIFY_SOCKET": path, "WATCHDOG_USEC": "2000000"})
            told = []

            def read_until(word):
                while not any(word in note for note in told):
                    told.append(notes.recv(4096).decode())

            read_until("READY=1")
            self.assertIn("READY=1", told[0])
            read_until("STATUS=serving")
            told.clear()
            for _ in range(3):
                read_until("WATCHDOG=1")
                told.clear()
            server.process.terminate()
            read_until("STOPPING=1")
            self.assertEqual(server.stop(), 0)

    def test_nobody_waits_for_who_does_not_listen(self):
        with tempfile.TemporaryDirectory() as folder, socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as notes:
            path = os.path.join(folder, "notify")
            notes.bind(path)
            notes.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1)
            with open("/proc/sys/net/unix/max_dgram_qlen") as file:
                room = int(file.read())
            filler = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
            filler.setblocking(False)
            self.addCleanup(filler.close)
            try:
                for _ in range(room + 2):
                    filler.sendto(b"x", path)
            except BlockingIOError:
                pass
            server = Server(env={**os.environ, "NOTIFY_SOCKET": path, "WATCHDOG_USEC": "400000"},
                            limits="shutdown_seconds = 1")
            with server.client(timeout=10) as client:
                self.assertTrue(client.frame(width=16, height=16).verify())
                time.sleep(1)  # several times the watchdog's period
                client.ping()
            self.assertEqual(server.stop(20), 0)

    def test_the_unit_exposes_little(self):
        result = subprocess.run(["systemd-analyze", "security", "--offline=true", "--threshold=24", "--no-pager", UNIT],
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stdout[-200:] + result.stderr)
        with open(UNIT) as file:
            unit = file.read()
        for line in ("Type=notify", "WatchdogSec=", "SystemCallFilter=@system-service", "ProtectProc=invisible",
                     "PrivateUsers=yes", "DevicePolicy=closed", "IPAddressDeny=any"):
            self.assertIn("\n" + line, unit)


class Ending(unittest.TestCase):
    def test_in_time_under_a_hostile_load(self):
        """Floods, half messages, an upload, large pictures and a scene that loads, and then SIGTERM."""
        server = Server(limits="shutdown_seconds = 3\nrequests_per_second = 1000000")
        stop, threads, sockets = threading.Event(), [], []

        def flood():
            pings = b"".join(HEADER.pack(MAGIC, 1, TYPES["ping"], number + 9, 0, 0, 0) for number in range(1000))
            try:
                with server.client() as client:
                    client.socket.settimeout(0.1)
                    while not stop.is_set():
                        try:
                            client.socket.sendall(pings)
                            client.socket.recv(1 << 20)
                        except TimeoutError:
                            pass
            except (OSError, ServiceError):
                pass

        try:
            for _ in range(3):
                threads.append(threading.Thread(target=flood))
                threads[-1].start()
            busy = [server.client() for _ in range(4)]
            sockets += [client.socket for client in busy]
            busy[0].start_stream(width=1280, height=720, max_rate=1000, encoding="png")
            busy[1].send("frame", {"width": 2560, "height": 1440, "encoding": "exr"})
            busy[2].send("load_scene", payload=LARGE_SCENE.encode())
            digest = hashlib.sha256(bytes(4 << 20)).hexdigest()
            busy[3].send("upload", {"hash": "sha256:" + digest, "size": 4 << 20, "offset": 0}, bytes(1 << 20))
            time.sleep(1)
            self.assertEqual(server.stop(60), 0)
            # by the clock of the server, which shares its cores with all of the above: answered by then, and gone soon after
            times = {event["event"]: datetime.datetime.fromisoformat(event["time"]) for event in server.log if "time" in event}
            drained = (times["stopped"] - times["shutting_down"]).total_seconds()
            self.assertLess(drained, 3 + 2)
        finally:
            stop.set()
            for thread in threads:
                thread.join(10)
            for one in sockets:
                one.close()


if __name__ == "__main__":
    unittest.main()

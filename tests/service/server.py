"""Starts `lumulus serve` for tests, on ports of its own, with a small scene."""

import json
import os
import queue
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "service", "client", "python"))
from lumulus_client import Client

# The program; the variable is for other builds.
LUMULUS = os.environ.get("LUMULUS", os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "build",
                                                 "release", "lumulus"))

SCENE = """
[image]
width = 64
height = 48
[sky]
model = "constant"
[[cloud]]
procedural = "sphere"
resolution = 24
extinction = 0.03
[preparation]
samples = 400
max_leaves = 400
[photon_map]
photons = 40000
generations = 4
bands = 3
"""


class Server:
    """A running server: `folder` (with scenes/ and uploads/), `tcp`, `http`, `log` (its events)."""

    def __init__(self, lumulus=LUMULUS, scene=SCENE, limits="", security="", listen="", folder=None, ports=(0, 0), env=None,
                 preexec=None, wait=True):
        self.folder = folder or tempfile.mkdtemp(prefix="lumulus-service-")
        self.owns = folder is None
        os.makedirs(os.path.join(self.folder, "scenes"), exist_ok=True)
        self.write("scenes/small.toml", scene)
        self.config = self.write("service.toml", f"""
[listen]
tcp = "127.0.0.1:{ports[0]}"
http = "127.0.0.1:{ports[1]}"
{listen}
[scenes]
folder = "scenes"
uploads = "uploads"
default = "small.toml"
[security]
{security}
[limits]
{limits}
""")
        self.log = []
        self.events = queue.Queue()
        self.process = subprocess.Popen([lumulus, "serve", "--config", self.config], stderr=subprocess.PIPE, text=True,
                                        env=env, preexec_fn=preexec)
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()
        if wait:
            self.listen()

    def listen(self):
        """Waits until it listens, and its scene is there."""
        self.listening()
        self.event("ready", 120)

    def listening(self):
        """Waits until it listens."""
        listening = self.event("listening", 120)
        self.tcp, self.http = next(iter(listening["frames"]), ""), listening["http"]

    def _read(self):
        for line in self.process.stderr:
            try:
                event = json.loads(line)
            except ValueError:
                event = {"event": "text", "text": line}
            self.log.append(event)
            self.events.put(event)
        self.events.put(None)

    def event(self, name, seconds=20):
        """Waits for an event of the log, and returns it."""
        while True:
            event = self.events.get(timeout=seconds)
            if event is None:
                self.events.put(None)
                raise AssertionError(f"the server ended: {self.log}")
            if event["event"] == name:
                return event

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "w") as file:
            file.write(text)
        return path

    def client(self, **arguments):
        return Client(self.tcp, **{"timeout": 60.0, **arguments})

    def memory(self):
        """Resident bytes."""
        with open(f"/proc/{self.process.pid}/statm") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    def cpu_seconds(self):
        with open(f"/proc/{self.process.pid}/stat") as file:
            fields = file.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def kill(self):
        self.process.kill()
        self.process.wait()
        self.reader.join(5)
        self.process.stderr.close()

    def stop(self, seconds=30):
        """Ends it as systemd would, and returns its exit code."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        try:
            code = self.process.wait(seconds)
        except subprocess.TimeoutExpired:
            self.kill()
            raise AssertionError("the server does not end")
        finally:
            self.reader.join(5)
            self.process.stderr.close()
            if self.owns:
                shutil.rmtree(self.folder, ignore_errors=True)
        return code


class ServiceTest(unittest.TestCase):
    """Tests that share one server; `options` are the Server's. LUMULUS is the program."""

    options = {}
    server = None

    @classmethod
    def setUpClass(cls):
        cls.server = Server(LUMULUS, **cls.options)

    @classmethod
    def tearDownClass(cls):
        code = cls.server.stop()
        if code != 0:
            raise AssertionError(f"the server ended with {code}: {cls.server.log[-5:]}")

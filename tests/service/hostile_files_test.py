"""Files that claim much: what is loaded of them is counted before it is made, and nobody else waits.

The argument is the program make_vdb_fixtures."""

import os
import subprocess
import sys
import threading
import time
import unittest

from server import LUMULUS, SCENE, ServiceTest
from lumulus_client import ServiceError

FIXTURES = sys.argv.pop()

# thin, so that light costs nothing even where a cloud is as large as a country
CLOUD = SCENE.replace('procedural = "sphere"\nresolution = 24\nextinction = 0.03',
                      'vdb = "small.vdb"\ngrid = "density"\nextinction = 1e-6')
MOST = 300e6  # bytes that a scene of 2²⁰ voxels takes, with its light, while it is loaded
BUDGET = 2  # MiB of densities; 2²⁰ voxels are always allowed


class Bystander(threading.Thread):
    """Another client, who asks for pings and small frames meanwhile. `slowest` [s] of either, `peak` memory [bytes]."""

    def __init__(self, server):
        super().__init__()
        self.server, self.client = server, server.client()
        self.done = threading.Event()
        self.frames, self.slowest, self.peak, self.error = 0, 0.0, 0, None

    def run(self):
        try:
            while not self.done.is_set():
                for ask in (self.client.ping, lambda: self.client.frame(width=16, height=16)):
                    began = time.monotonic()
                    ask()
                    self.slowest = max(self.slowest, time.monotonic() - began)
                    self.peak = max(self.peak, self.server.memory())
                self.frames += 1
                time.sleep(0.01)
        except Exception as error:  # shown by the test
            self.error = error


class HostileFiles(ServiceTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.files = os.path.join(cls.server.folder, "files")
        os.mkdir(cls.files)
        subprocess.run([FIXTURES, cls.files], check=True)
        with cls.server.client() as client:  # what the service keeps once it has loaded something
            cls.load(client, client.upload(os.path.join(cls.files, "ball.vdb")))
            client.load_scene("small.toml")
            client.frame(width=16, height=16)

    @staticmethod
    def load(client, digest):
        return client.load_scene(toml=CLOUD, vdb=digest, set=[f"preparation.memory_budget={BUDGET}"])

    def attempt(self, name):
        """Uploads a file and loads it while another client looks on. Returns the size of the file, the memory that the
        service took meanwhile [bytes], and what the load was refused with, or None."""
        path = os.path.join(self.files, name)
        bystander = Bystander(self.server)
        before = self.server.memory()
        bystander.start()
        refused = None
        try:
            with self.server.client() as client:
                digest = client.upload(path)
                try:
                    self.load(client, digest)
                    self.assertTrue(client.frame(width=16, height=16).verify())
                except ServiceError as error:
                    refused = error
                client.load_scene("small.toml")
                client.delete_upload(digest)
        finally:
            bystander.done.set()
            bystander.join()
            bystander.client.close()
        self.assertIsNone(bystander.error)
        self.assertGreater(bystander.frames, 0)
        print(f"{name}: {os.path.getsize(path)} bytes, {(bystander.peak - before) / 1e6:.0f} MB, "
              f"{bystander.frames} frames of another client, slowest answer {1e3 * bystander.slowest:.0f} ms, "
              f"{refused.code if refused else 'loaded'}")
        self.assertLess(bystander.slowest, 5.0)  # also where the machine is busy with other work
        return os.path.getsize(path), bystander.peak - before, refused

    def test_claims_of_many_voxels(self):
        """10¹⁵ voxels at two bytes are two million GB: they are averaged, or refused, before any memory is theirs."""
        size, memory, refused = self.attempt("many-tiles.vdb")
        self.assertLess(size, 400e3)
        self.assertIsNone(refused)
        self.assertLess(memory, MOST)

    def test_voxels_far_apart(self):
        size, memory, refused = self.attempt("two-far-voxels.vdb")
        self.assertLess(size, 40e3)
        self.assertIsNone(refused)
        self.assertLess(memory, MOST)

    def test_only_the_grid_that_is_asked_for_is_read(self):
        _, memory, refused = self.attempt("crowded.vdb")
        self.assertIsNone(refused)
        # 100,000 leaves of 512 floats are 205 MB
        self.assertLess(memory, 60e6)


if __name__ == "__main__":
    unittest.main()

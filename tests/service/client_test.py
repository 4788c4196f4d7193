"""The installed C++ client: its one header and library, and nothing else of Lumulus: client_test.py BUILD [FLAGS]"""

import os
import subprocess
import sys
import tempfile
import unittest

from server import Server

PROGRAM = r"""
#include <lumulus_client.h>
#include <cstdio>

int main(int, char** arguments) {
    try {
        lumulus::Client client(arguments[1]);
        lumulus::FrameQuery query;
        query.width = 40;
        query.height = 30;
        query.position = {300.0, 100.0, 0.0};
        query.products = {"cloud", "depth"};
        const lumulus::Frame frame = client.frame(query);
        const std::vector<float> cloud = frame.values(0, "cloud"), depth = frame.values(0, "depth");
        const std::uint64_t stream = client.startStream(query);
        for (int i = 0; i < 3; ++i)
            if (client.nextFrame(stream).views.at(0).width != 40) return 3;
        client.stopStream(stream);
        client.upload(arguments[2]);
        std::printf("%d %zu %zu %.3f\n", frame.generations, cloud.size(), depth.size(), cloud[4 * (15 * 40 + 20) + 3]);
        query.width = -1;
        client.frame(query);
    } catch (const lumulus::ClientError& error) {
        std::printf("%s\n", error.code.c_str());
        return 0;
    }
    return 4;
}
"""


class InstalledClient(unittest.TestCase):
    def test_a_program_of_its_own(self):
        server = Server()
        self.addCleanup(lambda: self.assertEqual(server.stop(), 0))
        with tempfile.TemporaryDirectory() as folder:
            prefix, source, program = (os.path.join(folder, name) for name in ("prefix", "main.cpp", "main"))
            subprocess.run(["cmake", "--install", BUILD, "--prefix", prefix], check=True, stdout=subprocess.DEVNULL)
            for name in ("man/man1/lumulus-render.1", "bash-completion/completions/lumulus"):
                self.assertTrue(os.path.exists(os.path.join(prefix, "share", name)), name)
            with open(source, "w") as file:
                file.write(PROGRAM)
            library = next(os.path.join(path, "liblumulus_client.a") for path, _, files in os.walk(prefix)
                           if "liblumulus_client.a" in files)
            subprocess.run(["g++", "-std=c++20", "-Wall", "-Wextra", "-Werror", *FLAGS, "-I", f"{prefix}/include", source,
                            library, "-lImath-3_1", "-lcrypto", "-o", program], check=True)
            result = subprocess.run([program, server.tcp, source], capture_output=True, text=True, timeout=100)
        self.assertEqual(result.returncode, 0, result)
        generations, cloud, depth, alpha = result.stdout.split()[:4]
        self.assertEqual((generations, cloud, depth), ("4", "4800", "1200"))
        self.assertGreater(float(alpha), 0.5)
        self.assertEqual(result.stdout.split()[4], "bad_request")


if __name__ == "__main__":
    BUILD, FLAGS = sys.argv[1], [flag for flag in sys.argv[2:] if flag]
    unittest.main(argv=sys.argv[:1])

"""The Debian package and what is in it: package_test.py BUILD [unittest arguments]."""

import gzip
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

BUILD = sys.argv.pop(1)

FILES = """
/etc/lumulus/service.toml /lib/systemd/system/lumulus.service /usr/bin/lumulus /usr/include/lumulus_client.h
/usr/lib/liblumulus_client.a /usr/lib/python3/dist-packages/lumulus/__init__.py
/usr/lib/python3/dist-packages/lumulus/__init__.pyi /usr/lib/python3/dist-packages/lumulus/py.typed
/usr/lib/python3/dist-packages/lumulus_client.py /usr/lib/sysusers.d/lumulus.conf
/usr/share/bash-completion/completions/lumulus /usr/share/doc/lumulus/README.md
/usr/share/doc/lumulus/changelog.Debian.gz /usr/share/doc/lumulus/copyright /usr/share/doc/lumulus/docs/service.md
/usr/share/doc/lumulus/examples/cloud_from_numpy.py /usr/share/lumulus/scenes/cumulus.toml
/usr/share/man/man1/lumulus.1.gz /usr/share/man/man1/lumulus-bake.1.gz
""".split()


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls._folder = tempfile.TemporaryDirectory()
        folder = Path(cls._folder.name)
        made = subprocess.run(["cpack", "-G", "DEB", "-B", str(folder / "made")], cwd=BUILD, capture_output=True, text=True)
        assert made.returncode == 0, made.stdout + made.stderr
        cls.package = str(next((folder / "made").glob("*.deb")))
        cls.root = folder / "root"
        subprocess.run(["dpkg-deb", "-R", cls.package, str(cls.root)], check=True)
        cls.listing = output("dpkg-deb", "-c", cls.package)

    @classmethod
    def tearDownClass(cls):
        cls._folder.cleanup()

    def field(self, name):
        return output("dpkg-deb", "-f", self.package, name).strip()

    def test_files(self):
        names = [line.split()[5][1:] for line in self.listing.splitlines()]
        for name in FILES:
            self.assertIn(name, names)
        modules = [name for name in names if re.search(r"/lumulus/_core\.cpython-311-.*\.so$", name)]
        self.assertEqual(len(modules), 1)
        self.assertFalse([name for name in names if "local" in name or "__pycache__" in name])

    def test_owners_and_rights(self):
        for line in self.listing.splitlines():
            rights, owner, *_, name = line.split()
            self.assertEqual(owner, "root/root", name)
            wanted = "drwxr-xr-x" if name.endswith("/") else "-rwxr-xr-x" if "/usr/bin/" in name else "-rw-r--r--"
            self.assertEqual(rights, wanted, name)

    def test_control(self):
        self.assertEqual((self.field("Package"), self.field("Version")), ("lumulus", "0.1.0-1"))
        depends = self.field("Depends")
        for name in ("libvulkan1", "mesa-vulkan-drivers | vulkan-icd", "libopenvdb10.0", "libopenexr-3-1-30", "libc6",
                     "python3 (<< 3.12)", "python3-numpy"):
            self.assertIn(name, depends)
        for name in ("-dev", "g++", "glslang"):
            self.assertNotIn(name, depends)
        self.assertEqual((self.root / "DEBIAN/conffiles").read_text(), "/etc/lumulus/service.toml\n")
        self.assertIn("lumulus (0.1.0-1)", gzip.decompress(
            (self.root / "usr/share/doc/lumulus/changelog.Debian.gz").read_bytes()).decode())

    def test_maintainer_is_somebody(self):
        """A name, and an address under no domain that is reserved for examples (RFC 2606) or names nobody's host."""
        maintainer = self.field("Maintainer")
        address = re.fullmatch(r"[^<>@]+ <([\w.+-]+)@([\w-]+(?:\.[\w-]+)+)>", maintainer)
        self.assertTrue(address, maintainer)
        self.assertNotEqual(address[1], "root", "no person")
        self.assertNotRegex(address[2], r"(?:^|\.)(?:invalid|test|example|localhost|localdomain|localnet|example\.\w+)$")
        changelog = gzip.decompress((self.root / "usr/share/doc/lumulus/changelog.Debian.gz").read_bytes()).decode()
        self.assertIn(f" -- {maintainer}  ", changelog)

    def test_paths_in_files_exist(self):
        unit = (self.root / "lib/systemd/system/lumulus.service").read_text()
        for path in re.findall(r"(?:file:|ExecStart=| )(/(?:usr|etc)/\S+)", unit):
            self.assertTrue((self.root / path[1:]).is_file(), path)
        folder = re.search(r'folder = "(/[^"]+)"', (self.root / "etc/lumulus/service.toml").read_text())[1]
        self.assertTrue((self.root / folder[1:] / "cumulus.toml").is_file())

    def test_program_and_module_run(self):
        self.assertEqual(output(str(self.root / "usr/bin/lumulus"), "--version"), "lumulus 0.1.0\n")
        script = f"import sys; sys.path.insert(0, '{self.root}/usr/lib/python3/dist-packages'); import lumulus; " \
                 "print(lumulus.__version__, lumulus.__file__)"
        self.assertEqual(output("/usr/bin/python3", "-c", script),
                         f"0.1.0 {self.root}/usr/lib/python3/dist-packages/lumulus/__init__.py\n")


if __name__ == "__main__":
    unittest.main()

"""One of the two programs, with a folder for its pictures and a frame service that starts when it is first asked."""

import sys
from dataclasses import dataclass
from typing import Callable

from study.pictures import read_exr
from study.program import ROOT, Failure, output_of

sys.path.insert(0, str(ROOT / "tests/service"))
from server import Server  # noqa: E402
from lumulus_client import ServiceError  # noqa: E402, F401

LIMIT = 300.0  # seconds that one picture may take


@dataclass
class Case:
    """`make` gives the layers, arrays by name, that a Side's program makes."""

    name: str
    make: Callable
    quick: bool = False


class Side:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder
        self.folder.mkdir(parents=True, exist_ok=True)
        self._server = None

    def picture(self, command, scene, name, *words):
        """The layers of what a command (render, reference) makes of a scene file."""
        path = self.folder / f"{name}.exr"
        path.unlink(missing_ok=True)
        output_of(self.program, command, scene, "-o", path, "--quiet", *words, limit=LIMIT)
        return read_exr(path)

    def composite(self, color, scene, name, *words):
        """The layers of a picture of another renderer, seen through the fog of a scene file."""
        path = self.folder / f"{name}.exr"
        output_of(self.program, "composite", "--color", color, "--scene", scene, "-o", path, *words, limit=LIMIT)
        return read_exr(path)

    def client(self):
        """A new connection to this program's frame service."""
        if self._server is None:
            try:
                self._server = Server(str(self.program))
            except (AssertionError, OSError) as error:
                raise Failure(f"the service does not start: {error}") from None
        return self._server.client(timeout=LIMIT)

    def close(self):
        if self._server is not None:
            self._server.stop()

"""One of the two programs, with a folder for its pictures and a frame service that starts when it is first asked."""

from dataclasses import dataclass
from typing import Callable

from study.lumulus import Lumulus
from study.pictures import read_exr
from study.program import Failure
from study.service import Server

LIMIT = 300.0  # seconds that one picture may take


@dataclass
class Case:
    """`make` gives the layers, arrays by name, that a Side's program makes."""

    name: str
    make: Callable
    quick: bool = False


class Side(Lumulus):
    def __init__(self, program, folder):
        super().__init__(program, folder, limit=LIMIT)
        self._server = None

    def picture(self, command, scene, name, *words):
        """The layers of what a command (render, reference) makes of a scene file."""
        path = self.path(name)
        path.unlink(missing_ok=True)
        self.succeeded(command, scene, "-o", path, "--quiet", *words)
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

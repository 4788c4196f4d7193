"""How the studies call programs: the one place where a process is started."""

import os
import pathlib
import subprocess
import tempfile
import threading
import time
from dataclasses import dataclass

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


class Failure(Exception):
    """A program that did not do its work, or input that a study cannot use: one line."""


@dataclass
class Finished:
    """A process that ended. `seconds` is the time on the clock, `user_seconds` the processor time in user mode,
    `rss_bytes` the largest resident memory."""

    code: int
    output: str
    complaint: str
    seconds: float
    user_seconds: float
    rss_bytes: int


def finished(*words, limit=None, environment=None):
    """Runs a program with these words to its end, with more environment variables where some are given. Raises Failure
    where it cannot be started or takes more than `limit` seconds."""
    with tempfile.TemporaryFile("w+") as output, tempfile.TemporaryFile("w+") as complaint:
        start = time.monotonic()
        try:
            process = subprocess.Popen([str(word) for word in words], stdout=output, stderr=complaint,
                                       env={**os.environ, **(environment or {})})
        except OSError as error:
            raise Failure(f"{words[0]}: {error.strerror}; run scripts/build.sh first") from None
        late = threading.Event()
        timer = threading.Timer(limit or threading.TIMEOUT_MAX, lambda: (late.set(), os.kill(process.pid, 9)))
        timer.daemon = True
        timer.start()
        _, status, used = os.wait4(process.pid, 0)  # unlike Popen.wait, it says what the process used
        timer.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        if late.is_set():
            raise Failure(f"not done after {limit:g} s")
        seconds = time.monotonic() - start
        texts = [file.seek(0) or file.read() for file in (output, complaint)]
        return Finished(process.returncode, *texts, seconds, used.ru_utime, used.ru_maxrss * 1024)


def succeeded(*words, **how):
    """The finished process. Raises Failure with the last line of its complaints where its exit code is not 0."""
    done = finished(*words, **how)
    if done.code != 0:
        raise Failure((done.complaint.strip().splitlines() or [f"{words[0]} ended with code {done.code}"])[-1])
    return done


def with_sets(overrides):
    """Overrides of scene keys (section.key=value) as words of the command line."""
    return [word for override in overrides for word in ("--set", override)]


def size_sets(width, height=None):
    """Overrides for the size of a picture in pixels; without a height it is 16:9."""
    return [f"image.width={width}", f"image.height={height or width * 9 // 16}"]

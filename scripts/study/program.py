"""How the studies call lumulus and other programs: the one place where a process is started."""

import os
import pathlib
import resource
import subprocess
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
    """Runs a program with these words to its end. Raises Failure where it cannot be started or takes more than `limit`
    seconds."""
    command = [str(word) for word in words]
    start = time.monotonic()
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                   env={**os.environ, **(environment or {})})
        said, complaint = process.communicate(timeout=limit)
    except OSError as error:
        raise Failure(f"{command[0]}: {error.strerror}; run scripts/build.sh first") from None
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        raise Failure(f"not done after {limit:g} s") from None
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return Finished(process.returncode, said, complaint, time.monotonic() - start, after.ru_utime - before.ru_utime,
                    after.ru_maxrss * 1024)


def output_of(*words, **how):
    """What a program writes to standard output. Raises Failure with the last line of its complaints where its exit code
    is not 0."""
    done = finished(*words, **how)
    if done.code != 0:
        raise Failure((done.complaint.strip().splitlines() or [f"{words[0]} ended with code {done.code}"])[-1])
    return done.output


def with_sets(overrides):
    """Overrides of scene keys (section.key=value) as words of the command line."""
    return [word for override in overrides for word in ("--set", override)]


def size_sets(width, height=None):
    """Overrides for the size of a picture in pixels; without a height it is 16:9."""
    return [f"image.width={width}", f"image.height={height or width * 9 // 16}"]

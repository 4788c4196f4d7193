"""The frame service for studies that talk to one: the tests' server and the Python client."""

import sys

from study.program import ROOT

sys.path.insert(0, str(ROOT / "tests/service"))
from server import Server  # noqa: E402, F401
from lumulus_client import ServiceError  # noqa: E402, F401


def percentile(values, share):
    """The value that this share (0 to 1) of the values lies below."""
    return sorted(values)[min(len(values) - 1, int(share * len(values)))]

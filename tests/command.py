"""The command line, run in the process of the tests, which it leaves as it was."""

from __future__ import annotations

import gc
import signal
import sys

import pytest

from replicate import cli


def status_of(*arguments: str) -> int:
    """Run the command and return its exit status."""
    argv, handler = sys.argv, signal.getsignal(signal.SIGTERM)
    sys.argv = ["replicate", *arguments]
    try:
        with pytest.raises(SystemExit) as end:
            cli.main()
    finally:
        sys.argv = argv
        signal.signal(signal.SIGTERM, handler)
        gc.unfreeze()  # the process does not end with the command
    code = end.value.code
    assert isinstance(code, int)
    return code

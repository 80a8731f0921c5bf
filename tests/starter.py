"""A process that has imported what programs need, and starts them as forks of it: they do little else than import.

What a program changes in its process is lost with it, and no program has run where the next one begins.
"""

from __future__ import annotations

import importlib
import json
import os
import runpy
import subprocess
import sys
import tempfile
import traceback
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path


class Starter:
    """Starts ``python -m MODULE`` as a fork of a process; what it starts has ended when `run` returns."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self._process = process

    def run(
        self, module: str, arguments: Sequence[str], folder: Path, environment: Mapping[str, str]
    ) -> subprocess.CompletedProcess[str]:
        """Run a module in a folder and return its status and all that it has written, as its output."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        with tempfile.NamedTemporaryFile() as output:
            request = [module, list(arguments), str(folder), dict(environment), output.name]
            self._process.stdin.write(f"{json.dumps(request)}\n")
            self._process.stdin.flush()
            status = int(self._process.stdout.readline())
            return subprocess.CompletedProcess(arguments, status, output.read().decode(), "")


@contextmanager
def starter(*modules: str) -> Iterator[Starter]:
    """Start a process that imports modules, and yield what starts programs in its forks."""
    command = [sys.executable, __file__, *modules]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        yield Starter(process)


def _run(module: str, arguments: list[str], folder: str, environment: dict[str, str], output: str) -> int:
    """Run a module as Python would, and return its status."""
    there, nothing = os.open(output, os.O_WRONLY), os.open(os.devnull, os.O_RDONLY)
    for source, target in ((nothing, 0), (there, 1), (there, 2)):
        os.dup2(source, target)
    os.environ.clear()
    os.environ.update(environment)
    os.chdir(folder)
    sys.path[0] = folder
    sys.argv = [module, *arguments]
    try:
        runpy.run_module(module, run_name="__main__", alter_sys=True)
    except SystemExit as end:
        return end.code if isinstance(end.code, int) else int(end.code is not None)
    except BaseException:  # noqa: BLE001  -- the end of the program, whatever it is
        traceback.print_exc()
        return 1
    return 0


def main() -> None:
    """Import what is asked for and start programs until there are no more."""
    for name in sys.argv[1:]:
        importlib.import_module(name)
    for line in sys.stdin:
        id = os.fork()
        if id == 0:
            status = _run(*json.loads(line))
            for stream in (sys.stdout, sys.stderr):
                stream.flush()
            os._exit(status)
        sys.stdout.write(f"{os.waitstatus_to_exitcode(os.waitpid(id, 0)[1])}\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()

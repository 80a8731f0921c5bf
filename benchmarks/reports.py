"""A report of all papers: processor time with nothing and with everything cached, and memory, beside plain imports."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from benchmarks.common import Table, seconds, times

PROCESSES = Path("/proc")
EVERY = 0.1  # seconds between two looks at the processes
IMPORTS = (
    "import numpy, scipy.optimize, scipy.integrate, pandas, matplotlib.pyplot, time; time.sleep(0.3)"  # to be seen
)
REPORT = ("-m", "replicate", "report", "--bundled", "--jobs", "1")


@dataclass(frozen=True)
class Spent:
    """What a command and all the processes that it started have used.

    Attributes
    ----------
    time
        Processor time in seconds.
    memory
        The largest memory of one of them, in MiB.
    """

    time: float
    memory: float


def spent_by(arguments: tuple[str, ...], folder: Path) -> Spent:
    """Run Python with its caches in a folder, and watch all processes that know of this folder.

    Workers are not children of a command to the end, so that the system does not add their time to its.
    """
    caches = f"{folder}/caches"
    environment = os.environ | {"XDG_CACHE_HOME": caches}
    command = subprocess.Popen(  # noqa: S603  -- our own words
        [sys.executable, *arguments], env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
    )
    mark, ticks, memory = f"XDG_CACHE_HOME={caches}".encode(), dict[str, int](), 0
    while command.poll() is None:
        for process in PROCESSES.glob("[0-9]*"):
            try:
                if mark not in (process / "environ").read_bytes().split(b"\0"):
                    continue
                fields = (process / "stat").read_text().rpartition(")")[2].split()
                status = (process / "status").read_text()
            except OSError:  # it has ended, or is another user's
                continue
            ticks[process.name] = int(fields[11]) + int(fields[12])  # utime and stime
            peak = [line.split()[1] for line in status.splitlines() if line.startswith("VmHWM")]
            memory = max(memory, *map(int, peak), 0)
        time.sleep(EVERY)
    assert command.stderr is not None  # noqa: S101  -- asked for
    if command.returncode:
        sys.exit(f"benchmarks: {' '.join(arguments)}: {command.stderr.read().decode().strip()}")
    return Spent(sum(ticks.values()) / os.sysconf("SC_CLK_TCK"), memory / 1024)


def tables() -> list[Table]:
    """Return the table of the report."""
    table = Table(
        "A report of the five papers by one worker process",
        ("work", "processor time of all processes", "times importing the libraries", "largest memory of one process"),
    )
    if not PROCESSES.is_dir():
        table.add("report", "is measured on Linux only", "", "")
        return [table]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        rows = {
            "importing numpy, scipy, pandas, matplotlib": ("-c", IMPORTS),
            "report, nothing cached": (*REPORT, "--out", str(folder / "build")),
            "report, everything cached": (*REPORT, "--out", str(folder / "build")),
        }
        anchor = 0.0
        for work, arguments in rows.items():
            spent = spent_by(arguments, folder)
            anchor = anchor or spent.time
            table.add(work, seconds(spent.time), times(spent.time / anchor), f"{spent.memory:.0f} MiB")
    return [table]

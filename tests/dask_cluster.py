"""A Dask cluster on loopback for tests: a scheduler and workers, each a process of its own."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path


@dataclass
class Cluster:
    """The address of a scheduler, and its workers' processes."""

    address: str
    workers: list[subprocess.Popen[bytes]] = field(default_factory=list)

    def kill_a_worker(self) -> None:
        """End one worker and what it has started, without a word."""
        os.killpg(self.workers.pop().pid, signal.SIGKILL)


@contextmanager
def cluster(folder: Path, workers: int = 2) -> Iterator[Cluster]:
    """Yield a running cluster; it is ended afterwards."""
    file = folder / "scheduler.json"
    started = [
        _start(
            folder, "scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--scheduler-file", str(file)
        )
    ]
    try:
        end = time.monotonic() + 600
        while not file.exists() or not file.read_text(encoding="utf-8").strip():
            assert time.monotonic() < end, "the scheduler has not started"
            time.sleep(0.1)
        running = Cluster(json.loads(file.read_text(encoding="utf-8"))["address"])
        for number in range(workers):
            own = folder / f"worker-{number}"
            own.mkdir()
            # The first has a nanny, as most have; the last has none that would start it again when it is killed.
            nanny = "--nanny" if number == 0 else "--no-nanny"
            options = ("--nthreads", "1", "--no-dashboard", nanny, "--local-directory", str(own))
            running.workers.append(_start(folder, "worker", running.address, *options))
        started += running.workers
        yield running
    finally:
        for process in started:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()


def _start(folder: Path, *command: str) -> subprocess.Popen[bytes]:
    with (folder / f"{command[0]}.log").open("ab") as log:
        return subprocess.Popen(
            [sys.executable, "-m", "dask", *command], stdout=log, stderr=log, start_new_session=True
        )  # fmt: skip

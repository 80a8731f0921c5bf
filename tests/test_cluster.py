"""The same on a real Dask scheduler with two workers, one of which is killed in the middle."""

from __future__ import annotations

import asyncio
import os
import socketserver
import subprocess
import sys
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import dask_cluster
import installed_paper
import pytest

from replicate.errors import ReplicateError
from replicate.run import backends
from replicate.run.backends import DaskCluster, LocalProcesses
from replicate.sweeps import read_sweep_file, run_sweep

SWEEP = """
plants = ["e^{-s}/(s+1)", "e^{-0.5s}/(s+1)^3"]
metrics = ["overshoot", "iae", "ms"]
block = 10

[controllers]
k = { from = 0.1, to = 1, points = 10 }
ki = { from = 0.1, to = 0.5, points = 10 }
"""


def files(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_a_sweep_survives_a_worker_and_ends_as_the_local_one(tmp_path: Path) -> None:
    (tmp_path / "s.toml").write_text(SWEEP, encoding="utf-8")
    sweep = read_sweep_file(tmp_path / "s.toml")
    with dask_cluster.cluster(tmp_path) as cluster:
        seen: list[int] = []
        killed = threading.Event()

        def watch(step: object) -> None:
            seen.append(getattr(step, "done"))  # noqa: B009
            if len(seen) == 4 and not killed.is_set():
                killed.set()
                cluster.kill_a_worker()

        blocks = run_sweep(sweep, tmp_path / "dask", "csv", DaskCluster(cluster.address), watch)
    assert killed.is_set()
    assert blocks == 20
    run_sweep(sweep, tmp_path / "local", "csv", LocalProcesses(2))
    assert files(tmp_path / "dask") == files(tmp_path / "local")


def test_report_and_check_on_a_cluster_are_those_of_this_machine(tmp_path: Path) -> None:
    with installed_paper.installed(tmp_path / "site"):
        pass
    environment = {**os.environ, "PYTHONPATH": str(tmp_path / "site"), "NO_COLOR": "1"}
    environment.pop("GITHUB_STEP_SUMMARY", None)

    def replicate(*arguments: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "replicate", *arguments]
        return subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)

    local = replicate("report", "lab", "--out", "local", "-j1")
    assert local.returncode == 0, local.stderr
    with dask_cluster.cluster(tmp_path, workers=1) as cluster:
        there = ("--backend", "dask", "--scheduler", cluster.address, "--no-cache")
        done = replicate("report", "lab", "--out", "cluster", *there)
        assert done.returncode == 0, done.stderr
        assert installed_paper.contents(tmp_path / "local") == {
            tmp_path / "local" / path.relative_to(tmp_path / "cluster"): content
            for path, content in installed_paper.contents(tmp_path / "cluster").items()
        }
        environment["LAB_BREAKS"] = "1"  # here, not on the cluster: nothing raises where the work is done
        assert "kettle" not in replicate("check", "lab", "--accepted", "state", *there).stderr


def test_a_scheduler_that_does_not_answer_is_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(backends, "ANSWER", 1)
    with pytest.raises(ReplicateError, match=r"^no scheduler answers at tcp://127\.0\.0\.1:9 within 1 s$"):
        list(DaskCluster("tcp://127.0.0.1:9").unordered(abs, [1]))


@pytest.fixture
def nobody(request: pytest.FixtureRequest) -> Iterator[str]:
    """Return the address of something that takes calls, says what the test wants, and is no scheduler."""

    class Answer(socketserver.BaseRequestHandler):
        def handle(self) -> None:
            self.request.sendall(request.param)
            while self.request.recv(1024):
                pass

    with socketserver.ThreadingTCPServer(("127.0.0.1", 0), Answer) as server:
        server.block_on_close = False
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"tcp://127.0.0.1:{server.server_address[1]}"
        server.shutdown()


@pytest.mark.parametrize("nobody", [b"", b"HTTP/1.1 400 Bad Request\r\n\r\n"], indirect=True)
def test_what_is_no_scheduler_but_takes_calls_is_one_line(nobody: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(backends, "ANSWER", 1)
    with pytest.raises(ReplicateError, match=rf"^no scheduler answers at {nobody} within 1 s$"):
        list(DaskCluster(nobody).unordered(abs, [1]))


def test_a_loop_that_runs_already_hinders_no_cluster(tmp_path: Path) -> None:
    async def in_a_notebook(address: str) -> list[tuple[int, int]]:
        return list(DaskCluster(address).unordered(abs, [-1]))

    # in a thread of its own: in this one, the tests in a browser may have left a loop that runs
    with dask_cluster.cluster(tmp_path, workers=1) as cluster, ThreadPoolExecutor(1) as thread:
        assert thread.submit(lambda: asyncio.run(in_a_notebook(cluster.address))).result() == [(-1, 1)]


def test_a_scheduler_without_workers_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(backends, "ANSWER", 6)  # the scheduler must have answered by then
    with (
        dask_cluster.cluster(tmp_path, workers=0) as cluster,
        pytest.raises(ReplicateError, match=r"has no worker after 6 s: start one with 'dask worker tcp://"),
    ):
        list(DaskCluster(cluster.address).unordered(abs, [1]))

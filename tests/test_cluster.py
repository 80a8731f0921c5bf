"""The same on a real Dask scheduler with two workers, one of which is killed in the middle."""

from __future__ import annotations

import asyncio
import os
import shutil
import socketserver
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import dask_cluster
import installed_paper
import pytest

from replicate.errors import ReplicateError
from replicate.exhibits.vocabulary import Table
from replicate.run import backends, same_program
from replicate.run.backends import DaskCluster, LocalProcesses
from replicate.run.cluster import ClusterPool
from replicate.run.units import Unit
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
        # Another project whose paper has the same package and other contents, on workers that know the first.
        other = tmp_path / "other"
        shutil.copytree(tmp_path / "site", other, ignore=shutil.ignore_patterns("__pycache__"))
        exhibits = other / "lab_paper/exhibits.py"
        text = exhibits.read_text(encoding="utf-8").replace("math.log(2)", "math.log(4)")
        more = '@paper.figure("fig-3", "Another", alt="Another.", size=(3.0, 2.0))\ndef other(fig): draw(fig)'
        exhibits.write_text(f"{text}\n\n{more}\n", encoding="utf-8")
        environment["PYTHONPATH"] = str(other)
        assert replicate("report", "lab", "--out", "local-2", "-j1", "--no-cache").returncode == 0
        done = replicate("report", "lab", "--out", "cluster-2", *there)
        assert done.returncode == 0, done.stderr
        of_both = [(tmp_path / name / "results.csv").read_bytes() for name in ("local", "local-2", "cluster-2")]
        assert of_both[0] != of_both[1] == of_both[2]
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


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Return the address of a scheduler with one worker."""
    with dask_cluster.cluster(tmp_path_factory.mktemp("cluster"), workers=1) as cluster:
        yield cluster.address


def test_a_loop_that_runs_already_hinders_no_cluster(address: str) -> None:
    async def in_a_notebook() -> list[tuple[int, int]]:
        return list(DaskCluster(address).unordered(abs, [-1]))

    # in a thread of its own: in this one, the tests in a browser may have left a loop that runs
    with ThreadPoolExecutor(1) as thread:
        assert thread.submit(lambda: asyncio.run(in_a_notebook())).result() == [(-1, 1)]


@pytest.mark.parametrize(
    ("key", "has"),
    [("scipy", r"scipy \S+, not 1\.0"), ("Python", r"Python 3\.\d+, not 1\.0"), ("code", "other code of replicate")],
)
def test_a_worker_with_another_program_computes_nothing(
    address: str, monkeypatch: pytest.MonkeyPatch, key: str, has: str
) -> None:
    monkeypatch.setattr(backends, "program", lambda: {**same_program.program(), key: "1.0"})
    with pytest.raises(ReplicateError, match=rf"^the worker tcp://\S+ has {has}: every machine needs the same version"):
        list(DaskCluster(address).unordered(abs, [-1]))


def test_a_worker_that_does_not_see_the_papers_is_named(address: str) -> None:
    unit = Unit("lab", "no_such_paper", "table-1", "as-written")
    exhibit = Table("table-1", "table", "Roots", rows=("2",), columns=("root",))
    with pytest.raises(
        ReplicateError, match=r"^lab/table-1 \(as-written\): the worker tcp://\S+ has no 'no_such_paper'"
    ):
        list(ClusterPool(DaskCluster(address), 60.0).run({unit: exhibit}))


def test_a_cluster_that_has_lost_its_workers_is_not_waited_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(backends, "ABSENCE", 1)
    monkeypatch.setattr(backends, "_LOOK", 0.5)
    begun = tmp_path / "begun"

    def lose(cluster: dask_cluster.Cluster) -> None:
        end = time.monotonic() + 600
        while not begun.exists() and time.monotonic() < end:
            time.sleep(0.05)
        cluster.kill_a_worker()

    with dask_cluster.cluster(tmp_path, workers=1) as cluster, ThreadPoolExecutor(1) as thread:
        lost = thread.submit(lose, cluster)
        with pytest.raises(ReplicateError, match=r"has had no worker for 1 s: what ended them is in their logs"):
            list(DaskCluster(cluster.address).unordered(subprocess.call, [["sh", "-c", f"touch '{begun}'; sleep 600"]]))
        lost.result()


def test_a_scheduler_without_workers_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(backends, "ANSWER", 6)  # the scheduler must have answered by then
    with (
        dask_cluster.cluster(tmp_path, workers=0) as cluster,
        pytest.raises(ReplicateError, match=r"has no worker after 6 s: start one with 'dask worker tcp://"),
    ):
        list(DaskCluster(cluster.address).unordered(abs, [1]))

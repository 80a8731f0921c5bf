"""A sweep from a file: its values, its blocks, what it does after an interruption, and what it refuses."""

from __future__ import annotations

import json
import math
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from replicate.errors import OutputError
from replicate.loops import PI, PID, Loop, Plant
from replicate.run.backends import LocalProcesses
from replicate.sweeps import read_sweep_file, run_sweep
from replicate.sweeps.running import SweepProgress, scattered
from replicate.sweeps.sides import Range
from replicate.sweeps.sweep_file import Block, SweepFile

Run = Callable[..., tuple[int, str, str]]

GRID = """
plants = ["e^{-s}/(s+1)", "e^{-0.5s}/(s+1)^3"]
metrics = ["overshoot", "iae", "rightmost_pole"]
block = 4

[controllers]
k = { from = 0.1, to = 1, points = 3 }
ki = [0.2, 5.0]
"""


def read(folder: Path) -> pd.DataFrame:
    return pd.concat([pd.read_csv(path) for path in sorted(folder.glob("block-*.csv"))], ignore_index=True)


def written(path: Path, text: str = GRID) -> SweepFile:
    path.write_text(text, encoding="utf-8")
    return read_sweep_file(path)


def test_every_loop_of_the_grid_has_its_row_with_the_values_of_the_loop(replicate: Run) -> None:
    Path("s.toml").write_text(GRID, encoding="utf-8")
    assert replicate("sweep", "s.toml", "-j1")[0] == 0
    rows = read(Path("build/sweeps/s"))
    assert list(zip(rows["plant"], rows["k"], rows["ki"], strict=True)) == [
        (plant, k, ki) for plant in ("e^{-s}/(s+1)", "e^{-0.5s}/(s+1)^3") for k in (0.1, 0.55, 1.0) for ki in (0.2, 5.0)
    ]
    row: Any
    for row in rows.itertuples():
        plant = Plant([1.0], [1.0, 1.0], 1.0) if row.plant == "e^{-s}/(s+1)" else Plant([1], [1, 3, 3, 1], 0.5)
        loop = Loop(plant, PI(row.k, row.ki))
        pole = loop.rightmost_pole()
        assert complex(row.rightmost_pole_re, row.rightmost_pole_im) == pytest.approx(pole, rel=1e-9)
        assert row.stable == loop.is_stable() == (row.ki < 1)
        if row.stable:
            assert row.iae == pytest.approx(loop.step().iae(), rel=1e-9)
        else:
            assert math.isnan(row.iae)
            assert "unstable" in row.reason


def test_parquet_holds_the_same_as_csv(tmp_path: Path) -> None:
    sweep = written(tmp_path / "s.toml")
    for file_format in ("csv", "parquet"):
        run_sweep(sweep, tmp_path / file_format, file_format, LocalProcesses(1))
    (tmp_path / "parquet" / ".block-000009.parquet.partial").write_bytes(b"of a run that was killed")
    parquet = pd.read_parquet(tmp_path / "parquet")  # the folder as a whole, whatever lies beside the blocks
    csv = read(tmp_path / "csv")
    assert list(parquet.columns) == list(csv.columns)
    np.testing.assert_allclose(parquet["iae"], csv["iae"], rtol=1e-11)


@pytest.mark.parametrize(("block", "pairing"), [(1, "grid"), (3, "grid"), (7, "grid"), (100, "grid"), (2, "pairwise")])
def test_blocks_hold_every_loop_once_in_order(tmp_path: Path, block: int, pairing: str) -> None:
    controllers = "[controllers]\nk = [0.1, 0.2, 0.3, 0.4, 0.5]\nki = 0.1\n"
    plants = "[plants]\ngain = [1, 2, 3, 4, 5]\ntime_constant = 2\ndead_time = 1\n"
    text = f"block = {block}\npairing = '{pairing}'\nmetrics = 'stable'\n{plants}{controllers}"
    sweep = written(tmp_path / "s.toml", text)
    run_sweep(sweep, tmp_path / "out", "csv", LocalProcesses(1))
    rows = read(tmp_path / "out")
    assert len(rows) == sweep.loops
    assert len(list((tmp_path / "out").glob("*.csv"))) == sweep.block_count
    assert max(len(pd.read_csv(path)) for path in (tmp_path / "out").glob("*.csv")) <= block
    expected = (
        [(gain, k) for gain in range(1, 6) for k in (0.1, 0.2, 0.3, 0.4, 0.5)]
        if pairing == "grid"
        else [(gain, gain / 10) for gain in range(1, 6)]
    )
    assert list(zip(rows["gain"], rows["k"], strict=True)) == expected


@pytest.mark.parametrize(("first", "last"), [(0.1, 3.7), (3.7, 0.1), (2.0, 2.0), (1e-300, 1e300)])
@pytest.mark.parametrize("points", [1, 2, 3, 50])
def test_a_range_has_the_values_of_numpy(first: float, last: float, points: int) -> None:
    some = np.array([points - 1, 0, points // 2])
    for scale, values in (("linear", np.linspace), ("log", np.geomspace)):
        assert list(Range(first, last, points, scale)[some]) == list(values(first, last, points)[some])


@pytest.mark.parametrize("count", [60, 500])
def test_the_first_blocks_that_are_computed_are_like_all(count: int) -> None:
    blocks = [Block(number, (number, number + 1), (0, 1)) for number in range(count)]
    order = scattered(blocks)
    assert sorted(order, key=lambda block: block.number) == blocks
    cost = np.array([block.number**2 for block in order], dtype=float)  # quick ones first, slow ones last
    for done in range(count // 5, count):
        told = cost[:done].mean() * (count - done)  # what progress says is left
        assert told == pytest.approx(cost[done:].sum(), abs=0.2 * cost.sum()), done  # 0.96 in order


#: A run that is ended after its third block, without a word.
KILLED = """
import os, signal, sys
from pathlib import Path
from replicate.run.backends import LocalProcesses
from replicate.sweeps import read_sweep_file, run_sweep

def watch(step, seen=[]):
    seen.append(step)
    if len(seen) == 3:
        os.kill(os.getpid(), signal.SIGKILL)

run_sweep(read_sweep_file(Path(sys.argv[1])), Path(sys.argv[2]), "csv", LocalProcesses(1), watch)
"""


def test_an_interrupted_sweep_goes_on_and_ends_as_one_that_was_not(tmp_path: Path) -> None:
    text = GRID.replace("points = 3", "points = 20")
    written(tmp_path / "s.toml", text)
    blocks = tmp_path / "killed"
    killed = subprocess.run([sys.executable, "-c", KILLED, str(tmp_path / "s.toml"), str(blocks)], check=False)
    assert killed.returncode == -signal.SIGKILL
    there = {path: path.stat().st_mtime_ns for path in blocks.glob("block-*.csv")}
    sweep = read_sweep_file(tmp_path / "s.toml")
    assert 2 <= len(there) < len(list(sweep.blocks()))
    run_sweep(sweep, blocks, "csv", LocalProcesses(1))
    assert {path: path.stat().st_mtime_ns for path in there} == there  # not done again
    run_sweep(sweep, tmp_path / "whole", "csv", LocalProcesses(1))
    names = sorted(path.name for path in (tmp_path / "whole").iterdir())
    assert sorted(path.name for path in blocks.iterdir()) == names
    assert all((blocks / name).read_bytes() == (tmp_path / "whole" / name).read_bytes() for name in names)


def test_an_interrupted_sweep_says_what_stays(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sweep = written(tmp_path / "s.toml")
    seen: list[SweepProgress] = []

    def interrupt(step: SweepProgress) -> None:
        seen.append(step)
        if len(seen) == 3:  # the beginning and two blocks
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_sweep(sweep, tmp_path / "out", "csv", LocalProcesses(1), interrupt)
    there = len(read(tmp_path / "out"))
    said = f"out: interrupted; {there} of 12 loops stay, and the next run goes on from there\n"
    assert capsys.readouterr().err.endswith(said)
    assert run_sweep(sweep, tmp_path / "out", "csv", LocalProcesses(1)) == sweep.block_count - 2


def test_a_damaged_block_is_computed_anew(tmp_path: Path) -> None:
    sweep = written(tmp_path / "s.toml")
    run_sweep(sweep, tmp_path / "out", "csv", LocalProcesses(1))
    block = tmp_path / "out/block-000001.csv"
    whole = block.read_bytes()
    block.write_bytes(whole[:-20])
    assert run_sweep(sweep, tmp_path / "out", "csv", LocalProcesses(1)) == 1
    assert block.read_bytes() == whole


#: Five blocks of as many rows, of plants and controllers that are written in every way.
ALIKE = """
plants = ["e^{-s}/(s+1)", " e^{-s} / (2s+1)", "e^{-s}\\n/(3s+1)", "e^{-s}/(4s+1)", "e^{-s}/(5s+1)"]
metrics = "ms"
block = 4

[controllers]
k = { from = 0.1, to = 0.3, points = 2 }
ki = { from = 1e-9, to = 0.1, points = 2, scale = "log" }
"""


@pytest.mark.parametrize("file_format", ["csv", "parquet"])
@pytest.mark.parametrize("side", ["plant", "controller"])
def test_a_block_that_is_another_one_is_computed_anew(tmp_path: Path, file_format: str, side: str) -> None:
    sweep = written(tmp_path / "s.toml", ALIKE if side == "plant" else ALIKE.replace("block = 4", "block = 2"))

    def computed() -> int:
        return run_sweep(sweep, tmp_path / "out", file_format, LocalProcesses(1))

    assert computed() == sweep.block_count
    first, second, *others = sorted((tmp_path / "out").glob("block-*"))
    assert computed() == 0
    right = [path.read_bytes() for path in (first, second)]
    first.write_bytes(second.read_bytes())
    second.write_bytes(others[0].read_bytes())
    assert computed() == 2
    assert [path.read_bytes() for path in (first, second)] == right


@pytest.mark.parametrize("file_format", ["csv", "parquet"])
def test_plants_whose_texts_are_numbers_are_kept(tmp_path: Path, file_format: str) -> None:
    sweep = written(tmp_path / "s.toml", 'plants = ["1", "0.50"]\ncontrollers = ["k=0.3,ki=0.2"]\nmetrics = ["ms"]\n')
    computed = [run_sweep(sweep, tmp_path / "out", file_format, LocalProcesses(1)) for _ in range(2)]
    assert computed == [1, 0]


def test_a_folder_of_something_else_is_left_alone(tmp_path: Path) -> None:
    sweep = written(tmp_path / "s.toml")
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine/thesis.tex").write_text("text", encoding="utf-8")
    with pytest.raises(OutputError, match=r"mine: holds thesis\.tex"):
        run_sweep(sweep, tmp_path / "mine", "csv", LocalProcesses(1))
    run_sweep(sweep, tmp_path / "out", "csv", LocalProcesses(1))
    other = written(tmp_path / "s.toml", GRID.replace("0.2, 5.0", "0.3, 5.0"))
    with pytest.raises(OutputError, match="holds the blocks of another sweep"):
        run_sweep(other, tmp_path / "out", "csv", LocalProcesses(1))
    with pytest.raises(OutputError, match="out: holds this sweep as csv, not parquet: remove the folder"):
        run_sweep(sweep, tmp_path / "out", "parquet", LocalProcesses(1))
    about = json.loads((tmp_path / "out/_sweep.json").read_text(encoding="utf-8"))
    assert about["loops"] == 12


@pytest.mark.parametrize(
    ("key", "message"),
    [
        ("numpy", "holds blocks that were computed by numpy 1.0, not "),
        ("replicate", "holds blocks that were computed by replicate 1.0, not "),
        ("Python", rf"holds blocks that were computed by Python 1\.0, not 3\.{sys.version_info.minor}: remove"),
        ("code", "holds blocks that were computed by other code of replicate: remove the folder"),
    ],
)
def test_blocks_of_another_program_are_not_continued(tmp_path: Path, key: str, message: str) -> None:
    sweep = written(tmp_path / "s.toml")
    run_sweep(sweep, tmp_path / "out", "csv", LocalProcesses(1))
    path = tmp_path / "out/_sweep.json"
    about = json.loads(path.read_text(encoding="utf-8"))
    about["program"][key] = "1.0"
    path.write_text(json.dumps(about), encoding="utf-8")
    (tmp_path / "out/block-000001.csv").unlink()
    with pytest.raises(OutputError, match=message):
        run_sweep(sweep, tmp_path / "out", "csv", LocalProcesses(1))
    assert not (tmp_path / "out/block-000001.csv").exists()


def test_a_run_killed_at_its_first_write_is_continued(tmp_path: Path) -> None:
    sweep = written(tmp_path / "s.toml")
    (tmp_path / "out").mkdir()
    (tmp_path / "out/._sweep.json.partial").write_text("{", encoding="utf-8")
    run_sweep(sweep, tmp_path / "out", "csv", LocalProcesses(1))
    assert len(read(tmp_path / "out")) == 12
    assert sorted(path.name for path in (tmp_path / "out").iterdir() if path.suffix != ".csv") == ["_sweep.json"]


#: Workers of which one may never have had anything to do, and none has any more.
IDLE = """
import sys, time
from pathlib import Path
from replicate.run.backends import LocalProcesses

def main():
    for _ in LocalProcesses(2).unordered(abs, [-1]):
        pass
    Path(sys.argv[1], "done").touch()
    time.sleep(600)

main()
"""


@pytest.mark.skipif(sys.platform != "linux", reason="looks at processes as Linux shows them")
def test_workers_end_when_the_run_is_killed(tmp_path: Path) -> None:
    def alive(pid: int) -> bool:
        stat = Path(f"/proc/{pid}/stat")
        return stat.exists() and stat.read_text(encoding="utf-8").rpartition(")")[2].split()[0] != "Z"

    def is_worker_of(main: int, pid: int) -> bool:
        with suppress(OSError):
            own = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()[1] == str(main)
            return own and b"LokyProcess" in Path(f"/proc/{pid}/cmdline").read_bytes()
        return False

    with subprocess.Popen([sys.executable, "-c", IDLE, str(tmp_path)]) as run:
        end = time.monotonic() + 600
        while not (tmp_path / "done").exists() and time.monotonic() < end:
            time.sleep(0.05)
        workers: list[int] = []
        while len(workers) < 2 and time.monotonic() < end:
            processes = [int(path.name) for path in Path("/proc").glob("[0-9]*")]
            workers = [pid for pid in processes if is_worker_of(run.pid, pid)]
        assert len(workers) == 2
        assert all(map(alive, workers))
        run.kill()  # nothing but the main process
    while any(map(alive, workers)) and time.monotonic() < end:
        time.sleep(0.05)
    assert not any(map(alive, workers))


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
def test_a_full_disk_is_one_line(tmp_path: Path) -> None:
    sweep = written(tmp_path / "s.toml")
    run_sweep(sweep, tmp_path / "out", "csv", LocalProcesses(1))
    (tmp_path / "out/block-000002.csv").unlink()
    (tmp_path / "out/.block-000002.csv.partial").symlink_to("/dev/full")
    with pytest.raises(OutputError, match=r"block-000002\.csv: cannot be written: No space left"):
        run_sweep(sweep, tmp_path / "out", "csv", LocalProcesses(1))
    assert (tmp_path / "out/block-000001.csv").is_file()
    assert run_sweep(sweep, tmp_path / "out", "csv", LocalProcesses(1)) == 1  # and goes on where it was


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("block = 4", "block = 0", "s.toml:4: block is 0; expected: a whole number of loops, 1 to 1,000,000"),
        ("block = 4", "block = 1_000_001", "s.toml:4: block is 1000001; expected: a whole number of loops, 1 to 1,000"),
        (
            "points = 3",
            "points = 1_000_001",
            "s.toml:4: 4,000,004 loops in blocks of at most 4 are 1,000,002 files; at",
        ),
        (
            "ki = [0.2, 5.0]",
            "ki = { from = 1, to = 2, points = 100_000_000 }\nb = { from = 0, to = 1, points = 10_000 }",
            "s.toml:6: controllers: 3,000,000,000,000 combinations are too many; at most 1,000,000,000,000",
        ),
        (
            "ki = [0.2, 5.0]",
            "measurement_filter_order = { from = 1, to = 2, points = 3 }",
            "s.toml:6: controllers[1]: the order of the ",
        ),
        ("block = 4", "blocks = 4", "s.toml:4: 'blocks' is unknown; allowed: plants, controllers"),
        ('"iae"', '"iea"', "s.toml:3: unknown metric 'iea': allowed are overshoot"),
        ("ki = [0.2, 5.0]", "ki = []", "s.toml:8: ki must be a number, a list of numbers, or a range"),
        ("ki = [0.2, 5.0]", "ki = [nan]", "s.toml:8: ki must be a number, a list of numbers, or a range"),
        ("ki = [0.2, 5.0]", "Ki = [0.2]", "s.toml:8: controllers: 'Ki' is unknown; allowed: k, ki"),
        ("ki = [0.2, 5.0]", "measurement_filter_order = [1, 1.5, 2]", "s.toml:6: controllers[1]: the order of the "),
        ("ki = [0.2, 5.0]", "ki = [inf]", "s.toml:8: ki must be a number, a list of numbers, or a range"),
        (
            "ki = [0.2, 5.0]",
            "derivative_filter = [-0.1]",
            "s.toml:6: controllers[0]: the controller's derivative_filter",
        ),
        ("points = 3", "points = 0", "s.toml:7: k is not a range; expected"),
        ("points = 3", "points = 1_000_000_000_000", "s.toml:7: k: a range has at most 100000000 points, not 1000000"),
        ("from = 0.1, to = 1,", "from = -1e308, to = 1e308,", "s.toml:7: k: the difference of 'from' and 'to' is too "),
        ("ki = [0.2, 5.0]", f"ki = 1{400 * '0'}", "s.toml:8: ki must be a number, a list of numbers, or a range"),
        ("block = 4", f"until = 1{400 * '0'}", "s.toml:4: until is 1000"),
        ("(s+1)^3", "(s+1^3", "s.toml:2: plants[1]: "),
        ('plants = ["e^{-s}/(s+1)", "e^{-0.5s}/(s+1)^3"]', "plants = []", "s.toml:2: plants must be a text"),
        ('plants = ["e^{-s}/(s+1)", "e^{-0.5s}/(s+1)^3"]', "", "s.toml:1: 'plants' is missing"),
        ("block = 4", "until = -1", "s.toml:4: until is -1; expected: a number above 0"),
        ("block = 4", "pairing = 'pairs'", "s.toml:4: pairing is 'pairs'; allowed: grid, pairwise"),
        ("block = 4", "pairing = 'pairwise'", "s.toml:4: pairs need as many plants as controllers, not 2 plants and 6"),
        ("block = 4", "block = ", "s.toml:4: is not readable TOML: "),
    ],
)
def test_what_is_wrong_in_the_file_is_one_line(replicate: Run, old: str, new: str, message: str) -> None:
    assert old in GRID
    Path("s.toml").write_text(GRID.replace(old, new), encoding="utf-8")
    status, out, err = replicate("sweep", "s.toml")
    assert (status, out) == (2, "")
    assert err.startswith(f"replicate: {message}")
    assert err.count("\n") == 1
    assert not Path("build").exists()


@pytest.mark.parametrize("dead_time", ["-1.0", "[0.5, -0.5, 1.0]"])
def test_a_negative_dead_time_is_one_line(replicate: Run, dead_time: str) -> None:
    text = f"[plants]\ngain = 1\ntime_constant = 1\ndead_time = {dead_time}\n[controllers]\nk = 1\n"
    Path("s.toml").write_text(text, encoding="utf-8")
    status, out, err = replicate("sweep", "s.toml")
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert "dead time" in err or "dead_time" in err


def test_an_order_of_the_filter_may_vary(tmp_path: Path) -> None:
    controllers = "[controllers]\nk = 0.5\nki = 0.2\nkd = 0.1\nmeasurement_filter = 0.05\n"
    text = f'plants = "e^{{-s}}/(s+1)"\nmetrics = "ms"\n{controllers}measurement_filter_order = [1, 2]\n'
    run_sweep(written(tmp_path / "s.toml", text), tmp_path / "out", "csv", LocalProcesses(1))
    frame = pd.read_csv(tmp_path / "out" / "block-000000.csv")
    plant = Plant([1.0], [1.0, 1.0], dead_time=1.0)
    assert list(frame["measurement_filter_order"]) == [1, 2]
    for order, ms in zip((1, 2), frame["ms"], strict=True):
        loop = Loop(plant, PID(0.5, 0.2, 0.1, measurement_filter=0.05, measurement_filter_order=order))
        assert ms == pytest.approx(float(loop.sensitivity_peak()), rel=1e-9)


def test_the_files_of_the_documentation_are_read(tmp_path: Path) -> None:
    root = Path(__file__).parent.parent
    assert read_sweep_file(root / "examples/sweeps/foptd.toml").loops == 500_000
    page = (root / "docs/sweeps.md").read_text(encoding="utf-8")
    assert written(tmp_path / "page.toml", page.split("```toml\n")[1].split("```")[0]).loops == 20_000


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--format", "xlsx"), "the format must be csv or parquet, not 'xlsx'"),
        (("--backend", "spark"), "--backend must be local or dask, not 'spark'"),
        (("--backend", "dask"), "--backend dask needs the address of a scheduler: --scheduler tcp://HOST:8786"),
        (
            ("--backend", "dask", "--scheduler", ""),
            "--backend dask needs the address of a scheduler: --scheduler tcp://HOST:8786",
        ),
        (("--scheduler", "tcp://here:1"), "--scheduler belongs to --backend dask"),
    ],
)
def test_what_is_wrong_in_the_options_is_one_line(replicate: Run, options: tuple[str, ...], message: str) -> None:
    Path("s.toml").write_text(GRID, encoding="utf-8")
    assert replicate("sweep", "s.toml", *options) == (2, "", f"replicate: {message}\n")

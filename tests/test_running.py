"""What the command line says about computing: why, what was written, what is kept, how long a unit may take."""

from __future__ import annotations

import multiprocessing
import os
import subprocess
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import ModuleType

import pytest

from replicate.run.starting import started
from replicate.run.worker import serve

Run = Callable[..., tuple[int, str, str]]


def add(folder: Path, text: str) -> None:
    with (folder / "exhibits.py").open("a", encoding="utf-8") as file:
        file.write(text)


def test_verbose_says_why_a_result_is_computed_and_what_its_code_writes(folder: Path, replicate: Run) -> None:
    add(
        folder,
        "\n@claims.claim('noisy', 'It is quiet.')\ndef _noisy():\n    print('hello\\x1b[2J')\n"
        "    np.random.seed(3)\n    return Finding('fails', 1.0, 'It is not.')\n",
    )
    (folder.parent / "lab_sibling.py").write_text("VALUE = 1\n")
    add(folder, "\nimport lab_sibling\n")
    status, _, errors = replicate("report", "lab", "-v")
    assert status == 0
    assert "because it has not been computed before" in errors
    assert "    | hello [2J\n" in errors
    assert "    left changed: numpy's random state\n" in errors
    status, _, errors = replicate("report", "lab", "-v")
    assert "because" not in errors
    (folder.parent / "lab_sibling.py").write_text("VALUE = 2\n")
    status, _, errors = replicate("report", "lab", "-v")
    assert errors.count("because module lab_sibling has changed\n") == 4
    add(folder, "\n")
    status, _, errors = replicate("report", "lab")
    assert status == 0
    assert "because" not in errors
    assert "hello" not in errors


def test_no_unit_depends_on_the_program_that_starts_the_run(
    tmp_path: Path, replicate: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    program = ModuleType("__main__")
    program.__file__ = str(tmp_path / "program.py")
    Path(program.__file__).write_text("from pathlib import Path\nPath(__file__).with_name('ran').touch()\n")
    monkeypatch.setitem(sys.modules, "__main__", program)
    assert replicate("report", "lab")[0] == 0
    assert sys.modules["__main__"] is program
    assert not (tmp_path / "ran").exists()


@pytest.mark.skipif("forkserver" not in multiprocessing.get_all_start_methods(), reason="workers are not forked here")
def test_threads_that_start_workers_together_leave_the_process_as_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from multiprocessing import forkserver

    ensure_running = forkserver.ensure_running

    def slowly() -> None:  # for the threads to overlap, and not to end in the order of their beginnings
        time.sleep(0.2)
        ensure_running()

    monkeypatch.setattr(forkserver, "ensure_running", slowly)
    monkeypatch.delenv("PYTHONSAFEPATH", raising=False)
    before, program = dict(os.environ), sys.modules["__main__"]

    def start(number: int) -> None:
        time.sleep(0.1 * number)
        process, connection = started(serve, tmp_path / f"output-{number}")
        connection.close()
        process.kill()
        process.join()

    with ThreadPoolExecutor(2) as threads:
        list(threads.map(start, range(2)))
    assert dict(os.environ) == before
    assert sys.modules["__main__"] is program


def test_the_folder_for_temporary_files_may_have_a_long_path(tmp_path: Path) -> None:
    temporary = tmp_path / ("t" * 100)  # more than the path of a socket may have
    temporary.mkdir()
    code = (
        "import os, tempfile\n"
        "from pathlib import Path\n"
        "from replicate.run.starting import started\n"
        "from replicate.run.worker import serve\n"
        "for number in range(2):\n"
        "    process, connection = started(serve, Path(f'output-{number}'))\n"
        "    connection.close()\n"
        "    process.kill()\n"
        "print(tempfile.gettempdir())\n"
    )
    run = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False,
        env={**os.environ, "TMPDIR": str(temporary)},
    )  # fmt: skip
    assert (run.returncode, run.stdout, run.stderr) == (0, f"{temporary}\n", "")


def test_a_unit_that_takes_too_long_breaks_the_run_by_name(folder: Path, replicate: Run) -> None:
    add(folder, "\n@table.reading('slow', 'Slow')\ndef _slow():\n    import time\n    time.sleep(60)\n")
    status, _, errors = replicate("report", "lab", "-j1", "--unit-timeout", "3")
    assert status == 2
    assert "lab/table-1 (slow): stopped after 3 s (--unit-timeout allows more) (lab_paper/exhibits.py:" in errors


def test_a_time_limit_is_more_than_nothing(replicate: Run) -> None:
    for given in ("0", "-1", "nan"):
        status, _, errors = replicate("report", "lab", "--unit-timeout", given)
        assert status == 2
        assert errors.splitlines()[-1].startswith("replicate: the time limit of a unit must be more than 0 s, not ")


def test_what_is_kept_is_counted_and_removed(folder: Path, replicate: Run) -> None:
    assert folder.is_dir()
    assert replicate("cache")[:2] == (0, "build/cache: 0 results, 0 texts, 0.0 MB of at most 1024 MB\n")
    replicate("report", "lab")
    assert replicate("cache")[1].startswith("build/cache: 4 results, ")
    assert replicate("cache", "--clear")[1].startswith("removed: 4 results, ")
    assert replicate("cache")[1].startswith("build/cache: 0 results, ")
    assert Path("build/report/index.html").is_file()


def test_nothing_heavy_is_imported_for_what_is_kept(folder: Path, replicate: Run) -> None:
    status, _, errors = replicate("report", "lab")
    assert status == 0, errors
    code = (
        "import sys; from replicate.cli import main; sys.argv = ['replicate', 'check', 'lab', '--accepted', '.']\n"
        "try:\n    main()\nexcept SystemExit:\n    pass\n"
        "heavy = ('matplotlib', 'multiprocessing.forkserver', 'joblib', 'scipy')\n"
        "print([name for name in heavy if name in sys.modules])"
    )
    run = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "PYTHONPATH": str(folder.parent)},
    )
    assert "4 of 4 results" in run.stderr
    assert run.stdout.splitlines()[-1] == "[]"

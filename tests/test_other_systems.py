"""What can be known here of other systems: no module that only POSIX has is needed, and workers can be spawned.

Windows and macOS themselves are tried by the workflow `systems.yml` alone.
"""

import os
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).parent.parent / "examples" / "student"

# Where Python on Windows has no module, and something that it has instead.
WITHOUT = """
import importlib, sys, types
import numpy, matplotlib.figure, pandas, rich.console, typer, joblib  # which ask for the system, too
for name in ("fcntl", "resource", "pwd", "grp", "termios", "tty", "multiprocessing.forkserver"):
    sys.modules[name] = None
sys.modules["msvcrt"] = types.SimpleNamespace(locking=None, LK_NBLCK=0)
sys.platform = "win32"
for name in ("run.starting", "run.pool", "run.worker", "run.ambience", "staging.lock", "baselines.scripts", "cli"):
    importlib.import_module(f"replicate.{name}")
"""


def test_what_depends_on_the_system_can_be_imported_without_what_only_posix_has() -> None:
    done = subprocess.run([sys.executable, "-c", WITHOUT], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("name", ["replicate", "templates"])
def test_no_two_files_differ_only_in_case_and_no_name_is_reserved(name: str) -> None:
    root = EXAMPLE.parent.parent / name
    files = [path.relative_to(root).as_posix() for path in root.rglob("*") if "__pycache__" not in path.parts]
    assert len({file.lower() for file in files}) == len(files)
    reserved = {"con", "prn", "aux", "nul", *(f"{port}{n}" for port in ("com", "lpt") for n in range(1, 10))}
    assert not [file for file in files if Path(file).stem.lower() in reserved or set(file) & set('<>:"|?*\\')]


def test_workers_can_be_spawned(tmp_path: Path) -> None:
    script = tmp_path / "spawned.py"
    script.write_text(
        "import multiprocessing, sys\n"
        'multiprocessing.get_all_start_methods = lambda: ["spawn"]\n'
        'if __name__ == "__main__":\n'
        "    import replicate.cli\n"
        "    replicate.cli.main()\n"
    )
    environment = os.environ | {"NO_COLOR": "1", "XDG_CACHE_HOME": str(tmp_path / "user-cache")}
    command = [sys.executable, str(script), "show", "student1908", "illustration-1", "-j1", "--out", str(tmp_path)]
    done = subprocess.run(command, cwd=EXAMPLE, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "computed 2/2" in done.stderr

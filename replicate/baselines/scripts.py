"""Run plotting scripts, each in a process of its own, and compare or accept the figures that they draw."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

from replicate.baselines.outcomes import Drawn, Outcome, accept, compared
from replicate.baselines.store import Store, name_of
from replicate.errors import FigureError, ReplicateError

_LAST_LINE = 300


@dataclass(frozen=True)
class ScriptRun:
    """A script that was run: its figures by name, and what went wrong, if anything did."""

    script: Path
    figures: Mapping[str, Drawn] = field(default_factory=dict)
    problem: str = ""


def find_scripts(patterns: Sequence[str], here: Path | None = None) -> list[Path]:
    """Return the scripts that patterns name: files, folders (their ``plot_*.py``), or patterns with ``*``.

    Raises
    ------
    FigureError
        If a pattern names no script.
    """
    here = here or Path()
    found: dict[Path, Path] = {}
    for pattern in patterns:
        path = here / pattern
        if path.is_dir():
            some = sorted(path.rglob("plot_*.py")) or sorted(path.rglob("*.py"))
        elif path.is_file():
            some = [path]
        else:
            base = Path(path.anchor) if path.is_absolute() else here
            some = sorted(base.glob(str(path.relative_to(path.anchor)) if path.is_absolute() else pattern))
        some = [script for script in some if script.suffix == ".py" and script.name != "__init__.py"]
        if not some:
            msg = f"'{pattern}' names no plotting script: needed is a .py file, a folder of them or a pattern"
            raise FigureError(msg)
        for script in some:
            found.setdefault(script.resolve(), script)
    return list(found.values())


def run_scripts(
    scripts: Sequence[Path],
    *,
    jobs: int | None = None,
    timeout: float = 300.0,
    tell: Callable[[str], None] | None = None,
) -> list[ScriptRun]:
    """Run scripts, several at a time; one that fails takes nothing else down.

    Raises
    ------
    FigureError
        If two scripts would give their figures the same names.
    """
    bases: dict[str, Path] = {}
    for script in scripts:
        base = _base(script)
        if base in bases:
            msg = f"two figures of one name: {bases[base]} and {script} would both draw '{base}-1'; rename one of them"
            raise FigureError(msg)
        bases[base] = script

    def one(item: tuple[str, Path]) -> ScriptRun:
        if tell is not None:
            tell(str(item[1]))
        return _run(item[1], item[0], timeout)

    with ThreadPoolExecutor(jobs or os.cpu_count() or 1) as pool:
        return list(pool.map(one, bases.items()))


def _base(script: Path) -> str:
    """Return what the names of a script's figures begin with: its folders and its own name."""
    with contextlib.suppress(ValueError):
        script = script.resolve().relative_to(Path.cwd())
    parts = [part for part in script.with_suffix("").parts if part not in {script.anchor, "..", "."}]
    return "/".join(map(name_of, parts))


def _run(script: Path, base: str, timeout: float) -> ScriptRun:
    with tempfile.TemporaryDirectory(prefix="figures-") as folder:
        command = [sys.executable, "-W", "ignore", "-m", "replicate.baselines.script_run", str(script), folder]
        environment = os.environ | {"MPLBACKEND": "agg", "PYTHONHASHSEED": "0"}
        with tempfile.TemporaryFile() as said:
            process = subprocess.Popen(  # noqa: S603  -- the user's own scripts
                command, stdin=subprocess.DEVNULL, stdout=said, stderr=said, env=environment, start_new_session=True
            )
            try:
                process.wait(timeout)
            except subprocess.TimeoutExpired:
                problem = f"{script}: is stopped, it took longer than {timeout:g} seconds"
                return ScriptRun(script, problem=problem)
            finally:
                with contextlib.suppress(ProcessLookupError, PermissionError):
                    if sys.platform != "win32":
                        os.killpg(process.pid, signal.SIGKILL)  # and whatever it has started
                    else:
                        process.kill()
                process.wait()
            said.seek(0)
            words = said.read().decode(errors="replace")
        return _read(script, base, Path(folder), process.returncode, words)


def _read(script: Path, base: str, folder: Path, code: int, words: str) -> ScriptRun:
    status = folder / "status.json"
    if not status.is_file():
        last = next((line for line in reversed(words.splitlines()) if line.strip()), "")
        why = f": {last[:_LAST_LINE]}" if last else ""
        return ScriptRun(script, problem=f"{script}: ended before its end, with status {code}{why}")
    content = json.loads(status.read_text(encoding="utf-8"))
    figures = {
        f"{base}-{number}": Drawn(
            (folder / f"{number}.json").read_text(encoding="utf-8"), (folder / f"{number}.png").read_bytes()
        )
        for number in range(1, content["figures"] + 1)
    }
    problem = content["problem"] and f"{script.parent / content['problem']}"
    if not figures and not problem:
        problem = f"{script}: draws nothing: no figure was saved, shown or open at its end; was it closed too early?"
    return ScriptRun(script, figures, problem)


def compare_runs(runs: Sequence[ScriptRun], store: Store, patterns: Sequence[str] = ()) -> list[Outcome]:
    """Compare the figures of scripts; a script that failed is an outcome, too, and so is a figure that is gone.

    Parameters
    ----------
    patterns
        What the scripts were found by: of the folders among them, figures whose script is gone are outcomes as well.
    """
    outcomes = [outcome for run in runs for outcome in _compared(run, store)]
    return outcomes + [outcome for pattern in dict.fromkeys(patterns) for outcome in _without_script(pattern, store)]


def _without_script(pattern: str, store: Store) -> Iterator[Outcome]:
    """Yield the accepted figures of the scripts that are no longer in a folder."""
    folder = Path(pattern)
    scope = _base(folder / "any.py").rpartition("/")[0]
    if not folder.is_dir() or not scope:  # in the topmost folder, figures of tests may lie beside those of scripts
        return
    there = {_base(script) for script in folder.rglob("*.py")}
    for name in store.names():
        base, _, number = name.rpartition("-")
        if number.isdigit() and base.startswith(f"{scope}/") and base not in there:
            said = ["was accepted, but its script is no longer there"]
            yield Outcome(name, "gone", pattern, said, ["named"], digest=store.digest(name))


def _compared(run: ScriptRun, store: Store) -> Iterator[Outcome]:
    where = str(run.script)
    for name, drawn in run.figures.items():
        yield compared(store, name, drawn, where)
    if run.problem:
        yield Outcome(_base(run.script), "failed", where, [run.problem], ["named"])
        return
    base = _base(run.script)
    for name in store.names():
        stem, _, number = name.rpartition("-")
        if stem == base and number.isdigit() and name not in run.figures:
            said = ["was accepted, but is not drawn any more"]
            yield Outcome(name, "gone", where, said, ["named"], digest=store.digest(name))


def accept_runs(
    runs: Sequence[ScriptRun],
    store: Store,
    reason: str,
    only: Mapping[str, str | None] | None = None,
    patterns: Sequence[str] = (),
) -> list[Outcome]:
    """Accept the figures of scripts.

    Parameters
    ----------
    patterns
        As of `compare_runs`.
    only
        Names of the figures to accept, each with the digest of the state that it replaces, if that is known.

    Raises
    ------
    ReplicateError
        If a script failed, a name is unknown, or an acceptance is stale; nothing is accepted, then.
    """
    failed = [run.problem for run in runs if run.problem]
    if failed:
        msg = f"nothing is accepted, because a script failed: {failed[0]}"
        raise ReplicateError(msg)
    outcomes = compare_runs(runs, store, patterns)
    drawn = {name: figure for run in runs for name, figure in run.figures.items()}
    known = {outcome.name for outcome in outcomes}
    for name, replaces in (only or {}).items():
        if name not in known:
            msg = f"no figure is called '{name}'; there are: {', '.join(sorted(known)[:12])}"
            raise ReplicateError(msg)
        if replaces is not None and replaces != store.digest(name):
            accept(store, Outcome(name, "changed"), None, reason, replaces)  # says why not, before anything is written
    return [
        accept(store, outcome, drawn.get(outcome.name), reason)
        for outcome in outcomes
        if only is None or outcome.name in only
    ]

"""Kill a swap by SIGKILL at each of its operations, and the recovery at each of its own. Run as a script.

It forks, so that a kill costs a millisecond and not the start of Python. Prints a JSON list of [case, what went wrong].
"""

from __future__ import annotations

import json
import os
import shutil
import signal
import sys
from collections.abc import Callable, Iterator
from itertools import count
from pathlib import Path

from crash_states import kill_at, watch

from replicate.staging import finish_interrupted, replace_files, staged

Tree = dict[str, str]

OWN = {"notes.txt": "mine", "report/main.tex": "thesis", "tables/own/x.csv": "1,2\n"}
FIRST = {"results.csv": "old", "report/index.html": "old", "report/lab.html": "same", "tables/lab/gone.csv": "old"}
SECOND = {"results.csv": "new", "report/index.html": "new", "report/lab.html": "same", "figures/lab/a/b.svg": "new"}


def tree(folder: Path) -> Tree:
    """Return what a user sees in a folder, behind links too, and the manifest; a link says where it leads."""
    found = {}
    for root, folders, files in os.walk(folder, followlinks=True):
        folders[:] = [name for name in folders if name != ".replicate"]
        for name in files:
            path = Path(root, name)
            found[path.relative_to(folder).as_posix()] = path.read_text(encoding="utf-8", errors="replace")
        for name in folders:
            if Path(root, name).is_symlink():
                found[Path(root, name).relative_to(folder).as_posix()] = f"-> {Path(root, name).readlink()}"
    return found


def leftovers(folder: Path) -> list[str]:
    """Return what a run leaves in its hidden folder, other than the manifest, and files for another disk."""
    hidden = [path for path in folder.rglob(".replicate/*") if path.name != "manifest.json"]
    return [path.relative_to(folder).as_posix() for path in (*hidden, *folder.rglob("*.replicate-*"))]


def write(folder: Path, files: Tree) -> None:
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")


def run(folder: Path, files: Tree) -> None:
    with staged(folder) as fresh:
        write(fresh, files)


def swap(folder: Path) -> None:
    run(folder, SECOND)


def linked(folder: Path) -> None:
    """Prepare as `plain` does, but the report lies elsewhere and a symbolic link leads there."""
    elsewhere = folder.parent / "elsewhere"
    shutil.rmtree(elsewhere, ignore_errors=True)
    elsewhere.mkdir()
    folder.mkdir()
    (folder / "report").symlink_to(elsewhere)
    write(folder, OWN)
    run(folder, FIRST)


def plain(folder: Path) -> None:
    write(folder, OWN)
    run(folder, FIRST)


def log_and_state(folder: Path) -> None:
    write(folder, {**OWN, "CHANGES.md": "one\n", "lab/a.csv": "old", "lab/b.csv": "old", "lab/c.csv": "old"})


def accept(folder: Path) -> None:
    replace_files(folder, {"CHANGES.md": b"one\ntwo\n", "lab/a.csv": b"new", "lab/d.csv": b"new"}, ["lab/b.csv"])


SCENARIOS: dict[str, tuple[Callable[[Path], None], Callable[[Path], None]]] = {
    "report": (plain, swap),
    "report behind a link": (linked, swap),
    "accept": (log_and_state, accept),
}


def child(action: Callable[[], None]) -> int:
    """Do something in a process of its own and return the signal that ended it, 0 if none did."""
    id = os.fork()
    if id == 0:
        status = 1
        try:
            os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
            action()
            status = 0
        except BaseException:  # noqa: BLE001  -- nothing may return into the code of the parent
            status = 1
        os._exit(status)
    _, status = os.waitpid(id, 0)
    return os.WTERMSIG(status) if os.WIFSIGNALED(status) else 0


def killing(at: int, folder: Path, action: Callable[[Path], None]) -> Callable[[], None]:
    """Return the action with a kill at one of its operations."""

    def act() -> None:
        kill_at(at, folder)
        action(folder)

    return act


def fresh(folder: Path, prepare: Callable[[Path], None]) -> None:
    shutil.rmtree(folder, ignore_errors=True)
    prepare(folder)


def killed(name: str, folder: Path, every: int) -> Iterator[tuple[str, str]]:
    """Yield every case of a scenario with what went wrong, and nothing where it held."""
    prepare, action = SCENARIOS[name]
    fresh(folder, prepare)
    old = tree(folder)
    action(folder)
    new = tree(folder)
    assert old != new
    for first in count(1, every):
        fresh(folder, prepare)
        if not child(killing(first, folder, action)):
            return
        yield f"{name}, killed at {first}: its files", torn(folder, old, new)
        for second in count(1, every):
            fresh(folder, prepare)
            child(killing(first, folder, action))
            again = child(killing(second, folder, recover))
            case = f"{name}, killed at {first}, the next run at {second}"
            wrong = torn(folder, old, new)
            recover(folder)
            wrong = wrong or whole(folder, old, new)
            action(folder)
            yield case, wrong or ("" if tree(folder) == new else "the run after it did not end as it should")
            if not again:
                break


def signalled(name: str, folder: Path, every: int) -> Iterator[tuple[str, str]]:
    """Yield the cases of two signals, one soon after the other; the state must be whole at once."""
    prepare, action = SCENARIOS[name]
    fresh(folder, prepare)
    old = tree(folder)
    action(folder)
    new = tree(folder)
    for gap in (1, 2, 5):
        for first in count(1, every):
            fresh(folder, prepare)
            reached = folder.parent / "reached"
            reached.unlink(missing_ok=True)

            def act(first: int = first, gap: int = gap, reached: Path = reached) -> None:
                two_signals(first, gap, folder, reached)
                action(folder)

            child(act)
            if not reached.exists():
                break
            yield f"{name}, signals at {first} and {first + gap}", "" if tree(folder) in (old, new) else "a mixture"


def two_signals(first: int, gap: int, folder: Path, reached: Path) -> None:
    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    seen = 0

    def maybe(_: str, __: str) -> None:
        nonlocal seen
        seen += 1
        if seen == first:
            reached.touch()
            signal.raise_signal(signal.SIGINT)
        elif seen == first + gap:
            signal.raise_signal(signal.SIGTERM)

    watch(folder, maybe)


def recover(folder: Path) -> None:
    """Do what the next run does first."""
    finish_interrupted(folder)
    replace_files(folder, {})


def torn(folder: Path, old: Tree, new: Tree) -> str:
    """Say which file is neither as before nor as after."""
    found = tree(folder)
    for name in old.keys() | new.keys() | found.keys():
        if found.get(name) not in (old.get(name), new.get(name)):
            return f"{name} is {found.get(name)!r}"
    return ""


def whole(folder: Path, old: Tree, new: Tree) -> str:
    if tree(folder) not in (old, new):
        return "a mixture of the earlier and the new state"
    left = leftovers(folder)
    return f"left behind: {', '.join(left)}" if left else ""


def main() -> None:
    """Run ``killed_swaps.py KIND SCENARIO FOLDER EVERY``: at every so many-th operation."""
    kind, name, folder, every = sys.argv[1:]
    cases = {"killed": killed, "signalled": signalled}[kind](name, Path(folder), int(every))
    json.dump(list(cases), sys.stdout)


if __name__ == "__main__":
    main()

"""Copy a folder at each file operation of a command, then let each fail in turn and say what became of the folder.

Run as a script it reads requests, each a line of JSON ``[HOW, FOLDER, SITE, EVERY, ARGUMENTS]``: a fork of it runs the
command line, which leaves copies in ``states/<number>`` and ``new`` beside the folder, and again in forks of its own,
which has imported everything by then. HOW is a list of ``once``, where one operation fails, and ``full``, where from
then on nothing can be created, or empty. Answers each by a line, a JSON object of lists of [case, what went wrong].

All requests share what the commands import, and the process that their workers are forked from.
"""

from __future__ import annotations

import errno
import importlib
import json
import os
import re
import shutil
import sys
import traceback
from itertools import count
from multiprocessing import forkserver
from pathlib import Path
from typing import Any

from crash_states import snapshot_each, watch

from replicate.run.isolation import isolate_matplotlib
from replicate.run.starting import started
from replicate.run.worker import serve

PROGRESS = re.compile(r"computed \d|\d+ of \d+ (results kept|sheets)|.*(removed|finished|put back) what a run")
#: What the commands import, among much else.
IMPORTED = ("replicate.report", "replicate.handout", "replicate.diff", "replicate.whatif", "replicate.run.drawing")
CREATING = {"open", "torn", "os.mkdir", "os.link", "os.symlink", "shutil.copyfile"}


def tree(folder: Path) -> dict[str, bytes]:
    """Return what a user sees of a folder, without what is kept for the next run."""
    hidden = {"cache", ".replicate"}
    files = (path for path in folder.rglob("*") if path.is_file() and not hidden & {*path.relative_to(folder).parts})
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


def command(arguments: list[str]) -> int:
    """Run the command line here and return its status."""
    from replicate import cli

    sys.argv = ["replicate", *arguments]
    try:
        cli.main()
    except SystemExit as error:
        return error.code if isinstance(error.code, int) else 1
    return 0


def fail_at(number: int, how: str, folder: Path, reached: Path) -> None:
    """Make the file operation of that number fail in this process."""
    seen = 0

    def maybe(event: str, path: str) -> None:
        nonlocal seen
        if event == "torn":
            return
        seen += 1
        if seen == number:
            reached.touch()
        if seen == number or (how == "full" and seen > number and event in CREATING):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), path)

    watch(folder, maybe)


def attempt(number: int, how: str, folder: Path, arguments: list[str], errors: Path) -> tuple[int, str]:
    """Run the command in a fork and return its status and what it said."""
    id = os.fork()
    if id == 0:
        sink = os.open(errors, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        os.dup2(sink, 2)
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        status = 99
        try:
            fail_at(number, how, folder, errors.with_name("reached"))
            status = command(arguments)
            sys.stderr.flush()
        finally:
            os._exit(status)
    _, status = os.waitpid(id, 0)
    return os.waitstatus_to_exitcode(status), errors.read_text(encoding="utf-8")


def keep_server() -> None:
    """Have forks use the server that their parent has started, which they would not find to be a child of theirs."""
    server: Any = forkserver._forkserver
    if server._forkserver_address is not None:
        server.ensure_running = forkserver.ensure_running = lambda: None


def attacked(ways: list[str], where: str, site: str, every: int, arguments: list[str]) -> dict[str, Any]:
    """Run the command and let its operations fail; return the cases of each way."""
    sys.path.insert(0, site)
    folder = Path(where)
    os.chdir(folder)
    kept = folder.parent / "kept"
    shutil.copytree(folder, kept, symlinks=True)
    old = tree(folder)
    end = snapshot_each(folder, folder.parent / "states")
    status = command(arguments)  # and imports everything
    end()
    assert status in (0, 1), status
    shutil.copytree(folder, folder.parent / "new", symlinks=True)
    new = tree(folder)
    assert old != new
    if (folder / "build/cache").is_dir():  # forks compute nothing
        shutil.copytree(folder / "build/cache", kept / "build/cache", dirs_exist_ok=True)
    return {way: attempts(way, folder, arguments, every, old, new) for way in ways}


def main() -> None:
    """Answer requests until there are no more."""
    isolate_matplotlib()
    for name in IMPORTED:
        importlib.import_module(name)
    # As `replicate.run.starting` does, which takes over what is imported here.
    worker, pipe = started(serve, Path(os.devnull))
    pipe.close()
    worker.join()
    keep_server()
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # what the commands say
    for line in sys.stdin:
        id = os.fork()
        if id == 0:
            status = 1
            try:
                answers.write(f"{json.dumps(attacked(*json.loads(line)))}\n")
                answers.flush()
                status = 0
            except BaseException:  # noqa: BLE001  -- nothing may return into the loop of the parent
                traceback.print_exc()
            os._exit(status)
        if os.waitstatus_to_exitcode(os.waitpid(id, 0)[1]):
            break


def attempts(
    how: str, folder: Path, arguments: list[str], every: int, old: dict[str, bytes], new: dict[str, bytes]
) -> list[tuple[str, str]]:
    """Let operations fail, one at each run, until a run has fewer."""
    found: list[tuple[str, str]] = []
    for number in count(1, every):
        shutil.rmtree(folder)
        shutil.copytree(folder.parent / "kept", folder, symlinks=True)
        os.chdir(folder)
        reached = folder.parent / "reached"
        reached.unlink(missing_ok=True)
        status, said = attempt(number, how, folder, arguments, folder.parent / "errors")
        if not reached.exists():
            break
        found.append((f"operation {number} fails ({how})", judge(status, said, tree(folder), old, new)))
    return found


def judge(status: int, said: str, now: dict[str, bytes], old: dict[str, bytes], new: dict[str, bytes]) -> str:
    if now not in (old, new):
        return "a mixture of the earlier and the new state"
    lines = [line for line in said.splitlines() if line and not PROGRESS.match(line)]
    if status != 2:
        return (
            "" if now == new and not lines else f"status {status}, said {lines}, state {'old' if now == old else 'new'}"
        )
    if len(lines) != 1 or not lines[0].startswith("replicate: ") or "unexpected" in lines[0]:
        return f"said {lines}"
    return "" if "No space left on device" in lines[0] and ".replicate/new" not in lines[0] else f"said {lines}"


if __name__ == "__main__":
    main()

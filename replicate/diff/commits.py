"""Which commits a comparison is between: the one that last changed the accepted state, and the one at hand.

Variables of the environment decide where they are set, as in a workflow that checks out a merge; git does elsewhere.
"""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

#: Environment variables that name the commits compared.
COMMITS = {"base": "REPLICATE_BASE_COMMIT", "head": "REPLICATE_HEAD_COMMIT"}

_SHORT = 12
_SECONDS = 10.0


def commits_compared(accepted: Path) -> list[tuple[str, str]]:
    """Return names and commits, as far as they are known; of what is not under version control there are none.

    Parameters
    ----------
    accepted
        The folder of the accepted state.
    """
    given = {name: os.environ.get(variable, "")[:_SHORT] for name, variable in COMMITS.items()}
    if not any(given.values()):
        given = {"base": _git(accepted, "log", "-1", "--format=%H", "--", "."), "head": _head(accepted)}
    return [(name, commit) for name, commit in given.items() if commit]


def _head(folder: Path) -> str:
    """Return the commit at hand, and whether files that it holds were changed since."""
    commit = _git(folder, "rev-parse", "HEAD")
    changed = commit and _git(folder, "status", "--porcelain", "--untracked-files=no", ":/")
    return f"{commit} with changes" if changed else commit


def _git(folder: Path, *command: str) -> str:
    """Return the first word that git says of a folder; empty without git, or outside of a repository."""
    program = shutil.which("git")
    if program is None or not folder.is_dir():
        return ""
    try:
        done = subprocess.run(  # noqa: S603  -- options of ours, and no shell
            [program, "-c", "core.fsmonitor=false", "-C", str(folder), *command],
            capture_output=True,
            text=True,
            timeout=_SECONDS,
            check=False,
            env=os.environ | {"GIT_OPTIONAL_LOCKS": "0"},
        )
    except (OSError, subprocess.TimeoutExpired, UnicodeDecodeError):
        return ""
    said = done.stdout.split()
    return said[0][:_SHORT] if done.returncode == 0 and said else ""

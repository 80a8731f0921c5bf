"""Calls of pandoc, which is in a sandbox and has a time limit: twenty unmatched brackets keep it busy for hours."""

from __future__ import annotations

import logging
import os
import re
import subprocess
from collections.abc import Sequence
from pathlib import Path

from replicate.errors import ReplicateError

TIME_LIMIT = 60.0  # seconds; the longest page takes two on a slow machine
_SILENT = logging.NullHandler()


class PandocError(ReplicateError):
    """Pandoc did not convert a text; the message is its own, on several lines."""


class NoPandocError(ReplicateError):
    """There is no pandoc that runs; no text is at fault."""


class SlowTextError(PandocError):
    """Pandoc was stopped because it took too long."""


def convert(text: str | Sequence[Path], target: str, source: str, *options: str, limit: float | None = None) -> str:
    """Return a text in another format.

    Parameters
    ----------
    text
        The text, or files that hold it.
    target, source
        Formats as pandoc names them, with extensions.
    options
        Of pandoc, besides ``--sandbox``.
    limit
        Time limit in seconds; that of all calls if ``None``.

    Raises
    ------
    PandocError
        If pandoc refuses the text, or takes longer.
    """
    files = [] if isinstance(text, str) else [str(file) for file in text]
    done = run(
        ["--sandbox", f"--from={source}", f"--to={target}", *options, *files],
        text.encode() if isinstance(text, str) else b"",
        limit=limit,
    )
    return done.decode("utf-8").replace("\r\n", "\n")


def run(
    options: Sequence[str],
    content: bytes,
    folder: Path | None = None,
    variables: dict[str, str] | None = None,
    limit: float | None = None,
) -> bytes:
    """Run pandoc on standard input and return its standard output.

    Parameters
    ----------
    options
        All options and files.
    content
        Standard input.
    folder
        The folder in which it runs.
    variables
        Of the environment, besides the present ones.
    limit
        Time limit in seconds; that of all calls if ``None``.

    Raises
    ------
    PandocError
        If it fails or takes longer.
    NoPandocError
        If it cannot be started.
    """
    limit = TIME_LIMIT if limit is None else limit
    try:
        done = subprocess.run(  # noqa: S603  -- options of ours, and no shell
            [_program(), *options],
            input=content,
            capture_output=True,
            check=False,
            cwd=folder,
            env={**os.environ, **(variables or {})},
            timeout=limit,
        )
    except subprocess.TimeoutExpired as error:
        msg = f"it takes more than {limit:g} seconds, for example for many brackets that are not closed"
        raise SlowTextError(msg) from error
    except OSError as error:
        msg = f"pandoc cannot be started: {error.filename or _program()}: {error.strerror or error}"
        raise NoPandocError(msg) from error
    if done.returncode:
        raise PandocError(done.stderr.decode("utf-8", errors="replace"))
    return done.stdout


def _program() -> str:
    """Return the path of pandoc, as `pypandoc` finds it but without the traceback that it prints."""
    import pypandoc

    logging.getLogger("pypandoc").addHandler(_SILENT)  # or it adds one that writes to standard error
    try:
        return str(pypandoc.get_pandoc_path())
    except OSError as error:
        own = os.environ.get("PYPANDOC_PANDOC")
        msg = (
            f"PYPANDOC_PANDOC names {own}, which is not a pandoc that runs: unset it, or give the path of one"
            if own
            else "no pandoc was found: install pypandoc_binary, which holds one, again"
        )
        raise NoPandocError(msg) from error


def refusal(message: str) -> str:
    """Return what pandoc's reader of formulas met, without the long list of what it would have taken.

    Examples
    --------
    >>> refusal("[WARNING] Could not convert TeX math a_, rendering as TeX: unexpected eof expecting letter or digit")
    'unexpected eof'
    """
    words = " ".join(message.split()).rpartition("rendering as TeX:")[2]
    found = re.search(r"unexpected .*?(?= expecting |\s*Failing because|$)", words)
    return found[0] if found else "it is not LaTeX that pandoc knows"

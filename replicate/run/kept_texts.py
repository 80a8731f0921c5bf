"""Texts that take long to compute and belong to no paper, kept between runs beside the results.

An entry is a text file of three lines, as those of `replicate.run.cache`: what it is, what it depends on, and the text
as JSON. Nothing in it is ever run, and one that is not whole, or whose code has changed since, is made again.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from replicate.run.cache import NEVER, SUFFIX, write_whole
from replicate.run.dependencies import Looked, first_difference

FORM = "replicate text"
FOLDER = "texts"


@dataclass
class KeptTexts:
    """A folder of texts.

    Parameters
    ----------
    folder
        Of the results; ``None`` keeps nothing.
    rooms
        Folders and modules of the framework whose code makes the texts.
    distributions
        Installed packages that it uses.
    report
        Told of every text that is made: its name, and why it was not taken from an earlier run.
    """

    folder: Path | None
    rooms: Sequence[str]
    distributions: Sequence[str]
    report: Callable[[str, str], object] = lambda _name, _why: None
    _looked: Looked = field(default_factory=Looked)

    def __call__(self, name: str, make: Callable[[], str]) -> str:
        """Return the text of this name, which says all that it depends on besides the code."""
        if self.folder is None:
            self.report(name, "nothing is kept")
            return make()
        now = self._looked.rooms(self.rooms, self.distributions)
        path = self.folder / FOLDER / f"{hashlib.sha256(name.encode()).hexdigest()[:24]}{SUFFIX}"
        text, why = _read(path, name, now)
        if text is None:
            self.report(name, why)
            text = make()
            rest = f"{json.dumps(now)}\n{json.dumps(text)}\n".encode()
            head = json.dumps({"form": FORM, "name": name, "digest": hashlib.sha256(rest).hexdigest()})
            with contextlib.suppress(OSError):  # a full disk costs the next run time, nothing else
                path.parent.mkdir(parents=True, exist_ok=True)
                write_whole(path, f"{head}\n".encode() + rest)
        return text


def _read(path: Path, name: str, now: dict[str, dict[str, str]]) -> tuple[str | None, str]:
    """Return the text of an entry, or why it is of no use."""
    try:
        first, rest = path.read_bytes().split(b"\n", 1)
        head = json.loads(first)
        if head != {"form": FORM, "name": name, "digest": hashlib.sha256(rest).hexdigest()}:
            return None, "its entry in the cache is damaged"
        recorded, text = (json.loads(line) for line in rest.splitlines())
        difference = first_difference(recorded, now)
    except FileNotFoundError:
        return None, NEVER
    except (OSError, ValueError, TypeError, AttributeError, RecursionError):
        return None, "its entry in the cache is damaged"
    if difference or not isinstance(text, str):
        return None, difference or "its entry in the cache is damaged"
    return text, ""

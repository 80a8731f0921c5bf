"""Texts that take long to compute and belong to no paper, kept between runs beside the results.

One whose entry is not whole, or whose code has changed since, is made again.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from replicate.run.dependencies import Looked, first_difference
from replicate.run.entries import DAMAGED, SUFFIX, UselessError, read_entry, write_entry

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

    def __call__(self, name: str, make: Callable[[], str], of: str = "") -> str:
        """Return the text of this name, as `replicate.display.keeping.Keep` says."""
        if self.folder is None:
            self.report(name, "nothing is kept")
            return make()
        now = {
            "text": {"its source": hashlib.sha256(of.encode()).hexdigest()},
            **self._looked.rooms(self.rooms, self.distributions),
        }
        path = self.folder / FOLDER / f"{hashlib.sha256(name.encode()).hexdigest()[:24]}{SUFFIX}"
        text, why = _read(path, name, now)
        if text is None:
            self.report(name, why)
            text = make()
            with contextlib.suppress(OSError):  # a full disk costs the next run time, nothing else
                write_entry(path, _identity(name), now, json.dumps(text))
        return text


def _read(path: Path, name: str, now: dict[str, dict[str, str]]) -> tuple[str | None, str]:
    """Return the text of an entry, or why it is of no use."""
    try:
        recorded, content = read_entry(path, _identity(name))
        difference, text = first_difference(recorded, now), json.loads(content)
    except UselessError as error:
        return None, str(error)
    except (ValueError, TypeError, AttributeError, RecursionError):
        return None, DAMAGED
    if difference or not isinstance(text, str):
        return None, difference or DAMAGED
    return text, ""


def _identity(name: str) -> dict[str, object]:
    return {"form": FORM, "name": name}

"""What each unit of work cost the last time, so that the longest is begun first and all workers end together.

Kept in the user's own cache folder, not with the results: times differ from run to run, results do not. Nothing depends
on it but the order of work; a file that cannot be read or written costs nothing but order.
"""

from __future__ import annotations

import contextlib
import json
import math
import os
import sys
import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path

from replicate.run.units import Unit

FILE = "costs.json"
_MOST_UNITS = 20_000


def user_folder() -> Path | None:
    """Return the folder for what the program keeps for a user, ``None`` if the user has no home or one without a root.

    That is the place each system has for it: ``$XDG_CACHE_HOME`` or ``~/.cache``, ``~/Library/Caches`` on macOS,
    ``%LOCALAPPDATA%`` on Windows.
    """
    try:
        if sys.platform == "win32":
            base = Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
        elif sys.platform == "darwin":
            base = Path.home() / "Library" / "Caches"
        else:
            given = os.environ.get("XDG_CACHE_HOME", "")
            base = Path(given) if given.startswith("/") else Path.home() / ".cache"
    except RuntimeError:  # no home
        return None
    return base / "replicate" if base.is_absolute() else None


class Costs:
    """Seconds per unit.

    Parameters
    ----------
    folder
        ``None`` remembers nothing.
    """

    def __init__(self, folder: Path | None) -> None:
        self._path = None if folder is None else folder / FILE
        self._seconds = self._read()
        self._new: dict[str, float] = {}

    def _read(self) -> dict[str, float]:
        if self._path is None:
            return {}
        try:
            known = json.loads(self._path.read_text(encoding="utf-8"))
        except (OSError, ValueError, RecursionError):
            return {}
        if not isinstance(known, dict):
            return {}
        return {name: float(cost) for name, cost in known.items() if isinstance(cost, float)}

    def longest_first(self, units: Iterable[Unit]) -> list[Unit]:
        """Return units in the order in which to begin them; those never seen come first, in the given order."""
        return sorted(units, key=lambda unit: -self._seconds.get(str(unit), math.inf))

    def add(self, unit: Unit, seconds: float) -> None:
        """Note what a unit has cost."""
        self._new[str(unit)] = round(seconds, 3)

    def save(self) -> None:
        """Write what is new; a run that ends at the same time may win."""
        if self._path is None or not self._new:
            return
        together: Mapping[str, float] = {**self._read(), **self._new}
        kept = dict(list(together.items())[-_MOST_UNITS:])
        with contextlib.suppress(OSError):
            self._path.parent.mkdir(parents=True, exist_ok=True)
            handle, name = tempfile.mkstemp(dir=self._path.parent, prefix=".aside-")
            with os.fdopen(handle, "w", encoding="utf-8") as file:
                json.dump(kept, file, indent=0, sort_keys=True)
            Path(name).replace(self._path)

"""The file of a sweep: which plants, which controllers, which metrics.

::

    plants = ["e^{-s}/(s+1)", "e^{-0.5s}/(s+1)^3"]      # texts, or a table as below
    metrics = ["overshoot", "settling_time", "iae", "ms"]
    pairing = "grid"                                    # or "pairwise"

    [controllers]                                       # all combinations
    k = { from = 0.1, to = 2, points = 100 }
    ki = [0.2, 0.5, 1.0]
"""

from __future__ import annotations

import hashlib
import json
import re
import sys
from collections.abc import Iterator
from dataclasses import astuple, dataclass
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from replicate.errors import SweepFileError
from replicate.loops.errors import LoopError
from replicate.loops.sweep.axes import CONTROLLER_COLUMNS, PLANT_COLUMNS, controller_axis, plant_axis
from replicate.loops.sweep.metric_names import checked_metrics
from replicate.loops.sweep.sweep_result import GRID, PAIRWISE
from replicate.plain_text import parse_toml, read_text
from replicate.sweeps.sides import Range, Refuse, Side, side_of

PLANT = PLANT_COLUMNS[0]
ORDER = "measurement_filter_order"
METRICS = ("overshoot", "settling_time", "iae", "ms")
PAIRINGS = (GRID, PAIRWISE)
BLOCK = 10_000
MOST_IN_BLOCK = 1_000_000  # its loops are in memory together
MOST_BLOCKS = 1_000_000  # files in one folder, with six digits in their names
_KEYS = ("plants", "controllers", "metrics", "pairing", "until", "band", "block")


@dataclass(frozen=True)
class Block:
    """A rectangle of a grid, or a stretch of pairs: members ``first`` up to, not including, ``last`` of each side."""

    number: int
    plants: tuple[int, int]
    controllers: tuple[int, int]

    def __str__(self) -> str:
        return f"block {self.number}"


@dataclass(frozen=True)
class SweepFile:
    """A sweep, read and checked.

    Attributes
    ----------
    name
        The file's name without its ending.
    plants, controllers
        The two sides.
    metrics, pairing, until, band
        As of `replicate.loops.sweep`.
    block
        The most loops that are computed and written at once.
    """

    name: str
    plants: Side
    controllers: Side
    metrics: tuple[str, ...]
    pairing: str = GRID
    until: float | None = None
    band: float = 0.02
    block: int = BLOCK

    @property
    def loops(self) -> int:
        """The number of loops."""
        if self.pairing == GRID:
            return len(self.plants) * len(self.controllers)
        return max(len(self.plants), len(self.controllers))

    def blocks(self) -> Iterator[Block]:
        """Yield the blocks in order; each is a rectangle, so that plants and controllers are made once for each."""
        plants, controllers = len(self.plants), len(self.controllers)
        if self.pairing == PAIRWISE:
            for number, first in enumerate(range(0, self.loops, self.block)):
                last = min(first + self.block, self.loops)
                yield Block(number, (first, last), (first, last))
            return
        high, wide = self._rectangle
        number = 0
        for top in range(0, plants, high):
            for left in range(0, controllers, wide):
                yield Block(
                    number, (top, min(top + high, plants)), (left, min(left + wide, controllers))
                )  # fmt: skip
                number += 1

    @property
    def _rectangle(self) -> tuple[int, int]:
        """How many plants and controllers a block of a grid has."""
        controllers = len(self.controllers)
        return max(1, self.block // controllers), min(controllers, self.block)

    @property
    def block_count(self) -> int:
        """The number of blocks."""
        if self.pairing == PAIRWISE:
            return -(-self.loops // self.block)
        high, wide = self._rectangle
        return -(-len(self.plants) // high) * -(-len(self.controllers) // wide)

    @property
    def digest(self) -> str:
        """Identify the sweep: what it computes and how it is cut into blocks."""
        sides = [
            side.texts
            or {
                name: astuple(values) if isinstance(values, Range) else values.tolist()
                for name, values in (side.columns or {}).items()
            }
            for side in (self.plants, self.controllers)
        ]
        what = [sides, self.metrics, self.pairing, self.until, self.band, self.block]
        return hashlib.sha256(json.dumps(what).encode()).hexdigest()


def read_sweep_file(path: Path) -> SweepFile:
    """Read the file of a sweep.

    Raises
    ------
    SweepFileError
        If it cannot be read or is malformed; the message names file, line and what is allowed.
    """
    text = read_text(path, str(path), SweepFileError)
    data = parse_toml(text, str(path), SweepFileError)

    def refuse(key: str, why: str) -> NoReturn:
        lines = enumerate(text.splitlines(), 1)
        found = (number for number, line in lines if re.match(rf"\s*\[?{re.escape(key)}\b", line))
        msg = f"{path}:{next(found, 1)}: {why}"
        raise SweepFileError(msg)

    for key in data:
        if key not in _KEYS:
            refuse(key, f"'{key}' is unknown; allowed: {', '.join(_KEYS)}")
    for key in ("plants", "controllers"):
        if key not in data:
            refuse(key, f"'{key}' is missing")
    _check_settings(data, refuse)
    metrics = data.get("metrics", METRICS)
    try:
        checked = checked_metrics(metrics if isinstance(metrics, str) else tuple(metrics))
    except (LoopError, TypeError) as error:
        why = str(error) if isinstance(error, LoopError) else f"metrics is {metrics!r}; expected: a list of names"
        refuse("metrics", why)
    made = SweepFile(
        path.stem,
        side_of("plant", data["plants"], PLANT, refuse),
        side_of("controller", data["controllers"], CONTROLLER_COLUMNS, refuse),
        checked,
        data.get("pairing", GRID),
        data.get("until"),
        data.get("band", 0.02),
        data.get("block", BLOCK),
    )
    _check_sides(made, refuse)
    return made


def _check_settings(data: dict[str, Any], refuse: Refuse) -> None:
    if data.get("pairing", GRID) not in PAIRINGS:
        refuse("pairing", f"pairing is {data['pairing']!r}; allowed: {', '.join(PAIRINGS)}")
    for key in ("until", "band"):
        value = data.get(key, 1.0)
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0 < value <= sys.float_info.max:
            refuse(key, f"{key} is {value!r}; expected: a number above 0")
    block = data.get("block", BLOCK)
    if isinstance(block, bool) or not isinstance(block, int) or not 1 <= block <= MOST_IN_BLOCK:
        refuse("block", f"block is {block!r}; expected: a whole number of loops, 1 to {MOST_IN_BLOCK:,}")


def _check_sides(sweep: SweepFile, refuse: Refuse) -> None:
    sizes = {len(sweep.plants), len(sweep.controllers)}
    if sweep.pairing == PAIRWISE and len(sizes) > 1:
        counts = f"{len(sweep.plants)} plants and {len(sweep.controllers)} controllers"
        refuse("pairing", f"pairs need as many plants as controllers, not {counts}")
    if sweep.block_count > MOST_BLOCKS:
        count = f"{sweep.loops:,} loops in blocks of at most {sweep.block:,} are {sweep.block_count:,} files"
        refuse("block", f"{count}; at most {MOST_BLOCKS:,}: name a larger 'block'")
    # A plant and a controller of each text, and the corners of each table, so that a slip is found at once.
    for side, axis in ((sweep.plants, plant_axis), (sweep.controllers, controller_axis)):
        try:
            axis(as_axis(_corners(side)))
        except LoopError as error:
            key = f"{side.name}s"
            refuse(key, str(error))


def _corners(side: Side) -> dict[str, list[Any]]:
    if side.columns is None:
        return side.members(0, len(side))
    ends = {name: _telling(name, values) for name, values in side.columns.items()}
    corners = Side(side.name, columns=ends)
    return corners.members(0, len(corners))


def _telling(name: str, values: NDArray[np.float64] | Range) -> NDArray[np.float64]:
    """Return values of a column of which one is wrong if any is.

    What is allowed of a number is an interval, so that its ends tell; an order is one of two, and each is looked at, of
    a range the second, too.
    """
    if isinstance(values, Range):
        return values[np.unique([0, min(1, len(values) - 1), len(values) - 1])]
    return np.unique(values) if name == ORDER else values[[values.argmin(), values.argmax()]]


def as_axis(members: dict[str, list[Any]]) -> Any:
    """Return members as `replicate.loops.sweep` takes them: a list of texts, or a data frame."""
    texts = members.get("plant") or members.get("controller")
    if texts is not None:
        return texts
    import pandas as pd

    return pd.DataFrame(members)

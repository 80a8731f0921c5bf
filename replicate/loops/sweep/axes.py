"""The plants and the controllers of a sweep, from whatever they come in: objects, texts, rows of numbers, data frames.

An axis of numbers keeps them as one array and makes an object only when its turn comes, so that a million controllers
take the memory of a million rows.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from replicate.loops import checks
from replicate.loops.controller import PID
from replicate.loops.errors import LoopError
from replicate.loops.notation import parse_controller, parse_plant
from replicate.loops.plant import Plant

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
T = TypeVar("T", Plant, PID)

NUMBERS = (float, int, np.float64)
OBJECTS_OR_TEXTS = "OTU"  # kinds of arrays whose elements are members

PLANT_COLUMNS = (("gain", "time_constant", "dead_time"), ("num", "den", "dead_time"), ("plant",))
CONTROLLER_COLUMNS = tuple(field.name for field in fields(PID))
PLANT_ROWS = (
    "a Plant (Plant.from_control makes one of a python-control system), a text, a row (gain, time constant, "
    "dead time), or a list, an array or a data frame of these"
)
CONTROLLER_ROWS = (
    "a PI or PID, a text, a row (k, ki), (k, ki, kd) or (k, ki, kd, b), or a list, an array or a data frame of these"
)


@dataclass(frozen=True)
class Axis(Generic[T]):
    """One side of a sweep: its members, made when asked for, and their labels.

    Attributes
    ----------
    name
        ``plant`` or ``controller``.
    labels
        One of each member: the index of a data frame, else 0, 1, ...
    make
        Makes a member from its place.
    single
        Whether one object was given, not a list of one.
    numbers
        The members as rows of numbers where they were given so, shape (n, numbers).
    valid
        Says of rows of numbers which are certainly members; the others are made to see.
    """

    name: str
    labels: Sequence[Any]
    make: Callable[[int], T]
    single: bool = False
    numbers: Array | None = None
    valid: Callable[[Array], Flags] | None = None

    def __len__(self) -> int:
        return len(self.labels)

    def __getitem__(self, place: int) -> T:
        try:
            return self.make(place)
        except LoopError as error:
            where = "" if self.single else f"{self.name}s[{checks.shown(self.labels[place])}]: "
            msg = f"{where}{error}"
            raise LoopError(msg) from None

    def checked(self) -> Axis[T]:
        """Return the axis after all its members could be made; LoopError names the first that could not."""
        if not len(self):
            msg = f"the sweep has no {self.name}s: give at least one"
            raise LoopError(msg)
        doubtful: Iterable[int] = range(len(self))
        if self.numbers is not None and self.valid is not None:
            doubtful = np.nonzero(~self.valid(self.numbers))[0].tolist()
        for place in doubtful:
            self[place]
        return self


def plant_axis(given: Any) -> Axis[Plant]:
    """Return the plants of a sweep.

    Raises
    ------
    LoopError
        If there are none, or one is no plant.
    """
    return _axis("plant", given, Plant, _plant, _plant_of_row, PLANT_ROWS, PLANT_COLUMNS[0], _is_foptd).checked()


def controller_axis(given: Any) -> Axis[PID]:
    """Return the controllers of a sweep; LoopError if there are none, or one is no controller."""
    return _axis(
        "controller", given, PID, _controller, _controller_of_row, CONTROLLER_ROWS, ("k", "ki", "kd", "b"), _is_pid
    ).checked()  # fmt: skip


def _axis(
    name: str,
    given: Any,
    kind: type[T],
    member: Callable[[Any], T],
    of_row: Callable[[dict[str, Any]], T],
    rows: str,
    numbers: tuple[str, ...],
    valid: Callable[[Array], Flags],
) -> Axis[T]:
    if isinstance(given, kind | str):
        return Axis(name, (0,), lambda _: member(given), single=True)
    if hasattr(given, "columns") and hasattr(given, "itertuples"):
        columns, values = [str(c) for c in given.columns], [given[c].to_numpy() for c in given.columns]
        plain = columns == list(numbers[: len(columns)]) and len(columns) > 1
        return Axis(
            name, list(given.index), lambda i: of_row(dict(zip(columns, (v[i] for v in values), strict=True))),
            numbers=_numbers(given.to_numpy(), len(numbers)) if plain else None, valid=valid,
        )  # fmt: skip
    if isinstance(given, Mapping):
        msg = f"the {name}s of a sweep must be {rows}, not a {type(given).__name__}"
        raise LoopError(msg)
    labels = list(given.index) if hasattr(given, "index") and hasattr(given, "to_numpy") else None
    if isinstance(given, np.ma.MaskedArray):
        given = np.ma.filled(given.astype(float if given.dtype.kind in "fiu" else object), np.nan)  # is no number
    if isinstance(given, np.ndarray):
        if given.dtype.kind not in OBJECTS_OR_TEXTS and given.ndim != 2:
            msg = f"an array of {name}s must have one row for each, shape (n, numbers), not {given.shape}"
            raise LoopError(msg)
        members: Any = given if given.ndim == 2 else given.ravel()
    elif isinstance(given, Iterable):  # not all that can be indexed: a python-control system is one thing
        members = list(given)
    else:
        msg = f"the {name}s of a sweep must be {rows}, not {checks.shown(given)}"
        raise LoopError(msg)
    return Axis(
        name, range(len(members)) if labels is None else labels, lambda i: member(members[i]),
        numbers=_numbers(members, len(numbers)), valid=valid,
    )  # fmt: skip


def _numbers(members: Any, most: int) -> Array | None:
    """Return rows of plain numbers as one array, or None if they are anything else."""
    if not isinstance(members, np.ndarray):
        if not all(isinstance(row, tuple | list) and all(type(x) in NUMBERS for x in row) for row in members):
            return None
        try:
            members = np.array(members)
        except ValueError:  # rows of different lengths
            return None
    if members.dtype.kind not in "fiu" or members.ndim != 2 or not 2 <= members.shape[1] <= most:
        return None
    return np.asarray(members, dtype=float)


def _is_pid(rows: Array) -> Flags:
    return np.asarray(np.isfinite(rows).all(axis=1))


def _is_foptd(rows: Array) -> Flags:
    if rows.shape[1] != len(PLANT_COLUMNS[0]):
        return np.zeros(len(rows), dtype=bool)
    return np.asarray(np.isfinite(rows).all(axis=1) & (rows[:, 0] != 0.0) & (rows[:, 1] != 0.0) & (rows[:, 2] >= 0.0))


def _plant(given: Any) -> Plant:
    if isinstance(given, Plant):
        return given
    if isinstance(given, str):
        return parse_plant(given)
    if np.ndim(given) == 1 and len(given) == 3:
        return Plant.foptd(*given)
    msg = f"a plant must be a Plant, a text, or a row (gain, time constant, dead time), not {checks.shown(given)}"
    raise LoopError(msg)


def _plant_of_row(row: dict[str, Any]) -> Plant:
    names = set(row)
    # dead_time alone may be missing, and nothing may be misspelt: the plant would silently be another one
    if not any(set(columns) - {"dead_time"} <= names <= set(columns) for columns in PLANT_COLUMNS):
        allowed = " or ".join(", ".join(columns) for columns in PLANT_COLUMNS)
        msg = f"a table of plants has the columns {allowed}, not {', '.join(row)}"
        raise LoopError(msg)
    if "plant" in names:
        return _plant(row["plant"])
    if "gain" in names:
        return Plant.foptd(row["gain"], row["time_constant"], row.get("dead_time", 0.0))
    return Plant(row["num"], row["den"], row.get("dead_time", 0.0))


def _controller(given: Any) -> PID:
    if isinstance(given, PID):
        return given
    if isinstance(given, str):
        return parse_controller(given)
    if np.ndim(given) == 1 and 2 <= len(given) <= 4:
        return PID(*given)
    msg = f"a controller must be a PI or PID, a text, or a row (k, ki[, kd[, b]]), not {checks.shown(given)}"
    raise LoopError(msg)


def _controller_of_row(row: dict[str, Any]) -> PID:
    if list(row) == ["controller"]:
        return _controller(row["controller"])
    unknown = [name for name in row if name not in CONTROLLER_COLUMNS]
    if unknown or "k" not in row:
        wrong = f"has no column {', '.join(unknown)}" if unknown else "needs a column k"
        msg = f"a table of controllers {wrong}: allowed are {', '.join(CONTROLLER_COLUMNS)}, or controller alone"
        raise LoopError(msg)
    return PID(**row)

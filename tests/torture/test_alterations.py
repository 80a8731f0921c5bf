"""The accepted state altered in one place at a time: the comparison says so.

What a table states is altered cell by cell, what a figure shows curve by curve and axis by axis, by an amount that a
reader of the paper would see.
"""

from __future__ import annotations

import copy
import json
import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from attack import Attack

from replicate.diff.accepted import TABLE_COLUMNS
from replicate.diff.accepted_files import read_cells, read_curves, read_record
from replicate.diff.cells import compare_cells
from replicate.figures import Record, compare

ACCEPTED = Path(__file__).parent.parent.parent / "figures"
FIGURES = sorted(path for path in ACCEPTED.glob("*/*.json") if path.with_suffix(".png").exists())

#: What is seen: a part of the length of an axis. Contours that labels interrupt are compared within 2 %.
SEEN = 0.03

Panel = dict[str, Any]
Alteration = Callable[[Panel], object]


@cache
def cells(path: Path) -> dict[tuple[str, ...], dict[str, str]]:
    return read_cells(path, TABLE_COLUMNS)


@cache
def record(path: Path) -> Record:
    return replace(read_record(path), curves=read_curves(path.with_suffix(".csv")))


def visible(figure: Record) -> Iterator[tuple[str, str]]:
    """Name the curves that come into view; of those too dense to keep, a digest is compared and not the points."""
    dense = {(panel["panel"], curve) for panel in figure.panels for curve in panel.get("dense", ())}
    limits = {panel["panel"]: np.array([panel["xlim"], panel["ylim"]]).T for panel in figure.panels}
    for (panel, curve), points in figure.curves.items():
        low, high = limits[panel].min(axis=0), limits[panel].max(axis=0)
        if (panel, curve) not in dense and ((points >= low) & (points <= high)).all(axis=1).any():
            yield panel, curve


def tables() -> Iterator[tuple[Path, tuple[str, ...]]]:
    for path in sorted(ACCEPTED.glob("*/*.csv")):
        if path.read_text(encoding="utf-8").startswith(",".join(TABLE_COLUMNS)):
            yield from ((path, key) for key in cells(path))


def test_a_value_of_a_table(attack: Attack) -> None:
    def altered(case: tuple[Path, tuple[str, ...]]) -> str:
        path, key = case
        before = cells(path)
        cell = dict(before[key])
        try:
            number = float(cell["computed"])
            number = number if math.isfinite(number) else 1.0
            cell["computed"] = f"{number + 1e-5 * max(abs(number), 0.1):.12g}"  # zeros may be 1e-15, too
        except ValueError:  # a word, or nothing
            cell["computed"] = "altered"
        changes, _ = compare_cells(before, {**before, key: cell})
        return "" if len(changes) == 1 else "silent"

    attack("computed values of tables altered by 1e-5", list(tables()), altered, short=60)


def test_a_verdict_of_a_table(attack: Attack) -> None:
    def altered(case: tuple[Path, tuple[str, ...]]) -> str:
        path, key = case
        before = cells(path)
        other = "unexplained" if before[key]["verdict"] != "unexplained" else "misprint"
        changes, _ = compare_cells(before, {**before, key: {**before[key], "verdict": other}})
        return "" if len(changes) == 1 else "silent"

    attack("verdicts of tables altered", list(tables()), altered, short=60)


def test_a_curve(attack: Attack) -> None:
    cases = [(path, key) for path in FIGURES for key in visible(record(path))]

    def moved(case: tuple[Path, tuple[str, str]]) -> str:
        path, (panel, curve) = case
        before = record(path)
        about = next(one for one in before.panels if one["panel"] == panel)
        points = before.curves[panel, curve].copy()
        points[:, 1] = _moved(points[:, 1], about["ylim"], about["yscale"])
        changes = compare(before, replace(before, curves={**before.curves, (panel, curve): points})).changes
        return "" if changes else "silent"

    attack(f"curves moved by {SEEN:.0%} of the axis", cases, moved, short=60)


def _moved(values: Any, limits: tuple[float, float], scale: str) -> Any:
    if scale == "log":
        return values * (max(limits) / min(limits)) ** SEEN
    return values + SEEN * abs(limits[1] - limits[0])


def _wider(limits: list[float], scale: str) -> list[float]:
    low, high = limits
    return [low, high * (high / low) ** SEEN] if scale == "log" else [low, high + SEEN * (high - low)]


def _axis(name: str) -> dict[str, Alteration]:
    def limits(panel: Panel) -> None:
        panel[f"{name}lim"] = _wider(panel[f"{name}lim"], panel[f"{name}scale"])

    def label(panel: Panel) -> None:
        panel[f"{name}label"] += " altered"

    return {f"limits of the {name} axis": limits, f"label of the {name} axis": label}


def _title(panel: Panel) -> None:
    panel["title"] += " altered"


def _legend(panel: Panel) -> None:
    panel["legend"][-1:] = ["another curve"]


def _colour(panel: Panel) -> None:
    mark = _drawn(panel, "edge")
    mark["edge"] = "#00ff00ff" if mark["edge"] != "#00ff00ff" else "#ff0000ff"


def _width(panel: Panel) -> None:
    mark = _drawn(panel, "width")
    mark["width"] += 2.0


def _drawn(panel: Panel, key: str) -> dict[str, Any]:
    """Return a mark of a curve, or of anything else that is drawn."""
    marks = [mark for part in panel["parts"] for mark in part["marks"] if key in mark]
    found: dict[str, Any] = marks[-1]
    return found


ALTERATIONS: dict[str, Alteration] = {
    **_axis("x"),
    **_axis("y"),
    "title of a panel": _title,
    "last entry of a legend": _legend,
    "colour of a part": _colour,
    "width of a line": _width,
}


def test_what_else_a_figure_shows(attack: Attack) -> None:
    for what, alter in ALTERATIONS.items():

        def altered(case: tuple[Path, int], alter: Alteration = alter) -> str:
            path, place = case
            before = record(path)
            panels = [copy.deepcopy(dict(panel)) for panel in before.panels]
            alter(panels[place])
            return "" if compare(before, replace(before, panels=panels)).changes else "silent"

        cases = [
            (path, place)
            for path in FIGURES
            for place, panel in enumerate(read_record(path).panels)
            if what != "last entry of a legend" or panel["legend"]
        ]
        attack(f"figures altered: {what}", cases, altered, short=6)


def test_nothing_altered_is_nothing_said(attack: Attack) -> None:
    def again(path: Path) -> str:
        before = record(path)
        changes = compare(before, Record.from_json(before.to_json())).changes
        return "; ".join(changes)

    attack("figures not altered at all", FIGURES, again, short=6)
    assert not [path for path in FIGURES if not json.loads(path.read_text(encoding="utf-8"))]

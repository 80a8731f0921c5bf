"""The heads of exercises: number, title, points and with what they are to be solved; and the choice of some of them."""

from __future__ import annotations

import re
from typing import Any

from replicate.errors import ReplicateError, TemplateError, listed
from replicate.exhibits import Paper
from replicate.exhibits.exercises import Exercises
from replicate.handout.reading import EXERCISE
from replicate.handout.sheet import Sheet
from replicate.handout.tree import Blocks, Element, classes, elements, string, text_of, transform
from replicate.plain_text import read_text

_LOOP = re.compile(r"\{%-?\s*for\b")
_ATTRIBUTES = ("tool", "vary", "fixed", "plot")
_LEVEL = 2  # below the section that they stand in, whatever the text writes


def with_heads(blocks: Blocks, source: str, exercises: Exercises, sheet: Sheet) -> Blocks:
    """Write into the heading of each exercise its number, its points and its tool.

    What a program needs to know of an exercise becomes attributes of its Div: ``number``, ``title``, ``vary`` (the
    name under which its numbers vary), ``plot`` (the figure of the solution that is to be drawn), ``fixed`` (why
    nothing varies) and ``points``.

    Raises
    ------
    TemplateError
        If an exercise has no heading, one with an unknown attribute, or varies under a name that there is not.
    ReplicateError
        If one is selected that there is not, or the points are not as many as the exercises.
    """
    found = [element for element in elements(blocks) if "exercise" in classes(element)]
    selected = chosen(sheet, len(found), source)
    for number, element in enumerate(found, start=1):
        heading = element["c"][1][0] if element["c"][1] else None
        if heading is None or heading["t"] != "Header":
            msg = f"{source}: exercise {number} does not begin with a heading"
            raise TemplateError(msg)
        given = dict(heading["c"][1][2])
        if unknown := [key for key in given if key not in _ATTRIBUTES]:
            msg = f"{source}: exercise {number} has {unknown[0]}=..., allowed: {', '.join(_ATTRIBUTES)}"
            raise TemplateError(msg)
        name = given.get("vary", "")
        if name and name not in exercises.variations:
            known = listed(exercises.variations)
            msg = f'{source}: exercise {number} has vary="{name}", no exercise varies under this name; allowed: {known}'
            raise TemplateError(msg)
        points = sheet.points_of(selected.index(number), len(selected)) if number in selected else None
        about = {"number": str(number), "title": " ".join(text_of(heading["c"][2]).split())}
        about |= {"vary": name} if name else {}
        about |= {"fixed": given["fixed"]} if "fixed" in given else {}
        about |= {"plot": given["plot"]} if "plot" in given else {}
        about |= {"points": f"{points:g}"} if points is not None else {}
        element["c"][0][2] = [list(pair) for pair in about.items()]
        heading["c"] = [_LEVEL, ["", [], []], _head(heading["c"][2], number, given.get("tool", ""), points, sheet)]
    return blocks


def chosen(sheet: Sheet, count: int, source: str) -> list[int]:
    """Return the numbers of the exercises of a sheet, if the text has so many.

    Raises
    ------
    ReplicateError
        If one is selected that there is not, or the points are not as many as the exercises.
    """
    found = list(sheet.select or range(1, count + 1))
    missing = [number for number in found if number > count]
    if missing:
        msg = f"--select: {source} has no exercise {missing[0]}; allowed: 1 to {count}"
        raise ReplicateError(msg)
    for place in range(len(found)):
        sheet.points_of(place, len(found))
    return found


def check_sheet(paper: Paper, sheet: Sheet) -> None:
    """Refuse a selection or points that do not go with the text, before anything is computed.

    Raises
    ------
    ReplicateError
        As `chosen`. A text that makes its exercises in a loop is left to the build.
    TemplateError
        If the text cannot be read; the message has the line.
    """
    source = f"{paper.id}/handout.md"
    text = read_text(paper.folder() / "handout.md", source, TemplateError)
    if not _LOOP.search(text):
        chosen(sheet, len(EXERCISE.findall(text)) + len(sheet.own), source)


def _head(title: list[Element], number: int, tool: str, points: float | None, sheet: Sheet) -> list[Any]:
    words = sheet.language
    head: list[Any] = [
        {"t": "Span", "c": [["", ["number"], []], [string(f"{words['exercise']} {number}")]]},
        {"t": "Space"},
        *title,
    ]
    worth = "" if points is None else f"{points:g} {words['point'] if points == 1 else words['points']}"
    remark = ", ".join(part for part in (tool, worth) if part)
    if remark:
        head += [{"t": "Space"}, {"t": "Span", "c": [["", ["tool"], []], [string(remark)]]}]
    return head


def selected(blocks: Blocks, sheet: Sheet) -> Blocks:
    """Return a text with the selected exercises only; their programs have run, those of the others too."""
    if not sheet.select:
        return blocks
    kept: Blocks = transform(blocks, lambda element: [] if _is_other(element, sheet) else None)
    return kept


def _is_other(element: Element, sheet: Sheet) -> bool:
    return "exercise" in classes(element) and int(dict(element["c"][0][2])["number"]) not in sheet.select

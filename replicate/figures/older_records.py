"""Compare a record with one of an earlier revision: only what both can say, so that an upgrade alone says nothing.

The first revision of version 2 gave texts with path effects the colour of the effect. It said nothing of the effects
of tick labels and legend entries, of the colours and widths of any effect, of the alignment of a legend, or of the
projection of axes in space, and it kept blank texts, which nobody sees. Compared with it, a later record says no more.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from replicate.figures.panel_pairs import matched_panels
from replicate.figures.record import Record

Described = Mapping[str, Any]

#: What is said of a part that reads a text, by the name of the part.
_SAID = {"title": "title"} | {f"label of the {axis} axis": f"{axis}label" for axis in "xyz"}

#: What earlier revisions did not say of a panel.
_LATER = {"depth"}

_SETTING = re.compile(r", (?=\w+=)")


def known_to_both(accepted: Record, new: Record) -> tuple[Record, Record]:
    """Return two records without what one of them says and the other, of an earlier revision, cannot say."""
    if accepted.revision == new.revision:
        return accepted, new
    older, newer = sorted((accepted, new), key=lambda record: record.revision)
    less = {
        str(fresh["panel"]): _reduced(fresh, old)
        for old, fresh in matched_panels(older.panels, newer.panels)
        if old is not None and fresh is not None
    }
    panels = [less.get(str(panel["panel"]), panel) for panel in newer.panels]
    newer = replace(newer, figure=_reduced(newer.figure, older.figure), panels=panels)
    older = replace(older, figure=_without_blanks(older.figure), panels=[_without_blanks(one) for one in older.panels])
    return (older, newer) if accepted.revision < new.revision else (newer, older)


def _reduced(newer: Described, older: Described) -> Described:
    """Return a panel, or the figure as a whole, whose parts say no more than those of an older record."""
    if "parts" not in newer:
        return newer
    known = {str(part["name"]): part for part in older.get("parts", ())}
    parts = [_as_then(part, known[part["name"]]) if part["name"] in known else part for part in newer["parts"]]
    said = {name: value for name, value in newer.items() if name not in _LATER or name in older}
    return {**said, "parts": parts}


def _as_then(newer: Described, older: Described) -> Described:
    now, then = newer.get("properties", {}), older.get("properties", {})
    properties = {name: value for name, value in now.items() if name != "alignment" or name in then}
    if newer.get("class") != older.get("class"):  # the title of a legend had the properties of the legend
        properties = then
    marks = newer["marks"]
    if "effects" in now or "effects" in then:
        marks = _in_colours_of(marks, older["marks"])
        if _more_of_the_same(then.get("effects", []), now.get("effects", [])) or _is_group(newer):
            properties = {name: value for name, value in properties.items() if name != "effects"}
            properties |= {name: value for name, value in then.items() if name == "effects"}
    return {**newer, "properties": properties, "marks": marks}


def _is_group(part: Described) -> bool:
    """Whether texts belong to a part that is none itself."""
    texts = any(mark["draws"] == "text" for mark in part["marks"])
    return texts and not str(part.get("class", "")).startswith(("Text", "Annotation"))


def _more_of_the_same(older: Sequence[str], newer: Sequence[str]) -> bool:
    """Whether path effects are of the same kinds, with all settings that the older record has of them."""
    if len(older) != len(newer):
        return False
    settings = [[(kind, set(_SETTING.split(rest))) for kind, _, rest in map(_split, side)] for side in (older, newer)]
    return all(one[0] == other[0] and one[1] - {""} <= other[1] for one, other in zip(*settings, strict=True))


def _split(effect: str) -> tuple[str, str, str]:
    return str(effect).partition(" ")


def _in_colours_of(marks: Sequence[Described], older: Sequence[Described]) -> list[Described]:
    """Return marks, those that are texts in the colours that an older record gave them."""
    colours: Iterator[Any] = iter([mark.get("edge") for mark in older if mark["draws"] == "text"])
    return [{**mark, "edge": next(colours, mark.get("edge"))} if mark["draws"] == "text" else mark for mark in marks]


def _without_blanks(panel: Described) -> Described:
    """Return a panel, or the figure as a whole, without texts of which nothing can be seen."""
    found = dict(panel)
    if "texts" in panel:
        found["texts"] = [text for text in panel["texts"] if str(text["text"]).strip()]
    if "parts" in panel:
        parts = [{**part, "marks": [*_marks_without_blanks(part["marks"])]} for part in panel["parts"]]
        whole = zip(panel["parts"], parts, strict=True)
        found["parts"] = [now for was, now in whole if not _is_blank(was, now, panel)]
    return found


def _is_blank(was: Described, now: Described, panel: Described) -> bool:
    if was["marks"] and not now["marks"]:
        return True
    said = panel.get(_SAID.get(was["name"], ""), "" if str(was["name"]).startswith("text ''") else "something")
    return all(mark["draws"] == "text" for mark in was["marks"]) and not str(said).strip()


def _marks_without_blanks(marks: Sequence[Described]) -> Iterator[Described]:
    for mark in marks:
        texts = mark.get("texts")
        if mark["draws"] != "text" or not texts or all(str(text).strip() for text in texts):
            yield mark
            continue
        kept = [i for i, text in enumerate(texts) if str(text).strip()]
        if kept:
            lists = {name: mark[name] for name in ("texts", "at") if len(mark.get(name, ())) == len(texts)}
            yield {**mark, **{name: [values[i] for i in kept] for name, values in lists.items()}}

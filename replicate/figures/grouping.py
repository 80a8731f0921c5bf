"""Say once what happened to many things that nobody named: bars of a histogram, steps of a staircase."""

from __future__ import annotations

import re
from collections.abc import Sequence

from replicate.figures.differences import Difference

#: What a curve without a label is called: nobody sees it, and one more curve shifts it.
NUMBERED = re.compile(r"(line|lines|shape|area|points|contours) \d+(?: \(\d+\))?|None")

_NAMED_TOGETHER = 3
_DETAIL = re.compile(r" from | is now | are now |\d")


def together(names: Sequence[str]) -> str:
    """Return names as a sentence has them, the first two where they are many.

    Examples
    --------
    >>> together(["a"]), together(["a", "b", "c"]), together(list("abcdef"))
    ('a', 'a, b and c', 'a, b and 4 more')
    """
    if len(names) <= _NAMED_TOGETHER:
        return " and ".join(filter(None, (", ".join(names[:-1]), names[-1])))
    return f"{', '.join(names[:2])} and {len(names) - 2} more"


def are_many(count: int) -> bool:
    """Whether things are too many to speak of each."""
    return count > _NAMED_TOGETHER


def without_details(sentence: str) -> str:
    """Return what sentences have in common that say the same of different things, in other numbers and colours.

    Examples
    --------
    >>> without_details("line of {} is 1.2 pt wide now (was 1)")
    'line of {} is '
    >>> without_details("colour of {} changed from red to blue")
    'colour of {} changed'
    """
    return _DETAIL.split(sentence, maxsplit=1)[0]


def grouped(changes: Sequence[Difference], suffix: str = "") -> list[Difference]:
    """Put together what happened to many curves of one kind that have numbers for names.

    Parameters
    ----------
    changes
        Of the curves of one panel.
    suffix
        Says which panel it is, if there are several.
    """
    groups: dict[tuple[str, ...], list[Difference]] = {}
    for change in changes:
        name = change.where.rpartition(" / ")[2]
        numbered = NUMBERED.fullmatch(name)
        key = (change.kind, str(numbered[1]), "elsewhere" if change.before else "") if numbered else (change.text,)
        groups.setdefault(key, []).append(change)
    found: list[Difference] = []
    for group in groups.values():
        found += [_one(group, suffix)] if are_many(len(group)) else group
    return found


def _one(group: Sequence[Difference], suffix: str) -> Difference:
    first = group[0]
    names = together([f"curve '{change.where.rpartition(' / ')[2]}'" for change in group])
    if first.kind == "curve" and not first.before:
        worst = max(group, key=lambda change: change.size or 0.0)
        text = f"{names} differ, most of all this one: {worst.text}"
        return Difference("curve", text, worst.where, size=worst.size)
    verbs = {"new": "are new", "removed": "are missing"}
    text = f"{names} {verbs.get(first.kind, 'now lie where others lay')}{suffix}"
    return Difference(first.kind, text, first.where)

"""Which part of a figure is which in another state, where its name has changed: names that nobody sees, and texts.

A name may hold a number, because nobody gave a better one, or the words of a text. Neither makes it another part.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

Part = Mapping[str, Any]

_SUB_FIGURE = " of sub-figure "
_NUMBERED = re.compile(r"(\D+) \d+(?: \(\d+\))?")
_AGAIN = re.compile(r" \(\d+\)\Z")
_TEXT = "text '"


def names_of_sub_figures(old: Mapping[str, Part], after: Sequence[Part]) -> dict[str, str]:
    """Return what records of earlier releases call the backgrounds and titles of sub-figures, which they numbered."""
    if any(_SUB_FIGURE in name for name in old):
        return {}
    inner = [part for part in after if _SUB_FIGURE in str(part["name"])]
    grounds = [str(part["name"]) for part in inner if "texts" not in part["marks"][0]]
    said = {str(part["name"]): part["marks"][0]["texts"][0] for part in inner if "texts" in part["marks"][0]}
    titles = {name: f"text '{words}'" for name, words in said.items()}
    return titles | {name: f"shape {count}" for count, name in enumerate(grounds, start=1)}


def names_of_texts(before: Sequence[Part], after: Sequence[Part]) -> dict[str, str]:
    """Return the accepted names, by new names, of texts that read otherwise now, with their boxes and arrows.

    Texts of the same number in the same order, as many of which read otherwise as words are gone and new.

    Examples
    --------
    >>> was, now = ([{"name": f"text '{words}'", "told": True} for words in texts] for texts in ("abc", "abd"))
    >>> names_of_texts(was, now)["text 'd'"]
    "text 'c'"
    """
    old, new = (
        [str(part["name"]) for part in parts if part.get("told") and str(part["name"]).startswith(_TEXT)]
        for parts in (before, after)
    )
    words = [[_AGAIN.sub("", name) for name in names] for names in (old, new)]
    gone, fresh = Counter(words[0]) - Counter(words[1]), Counter(words[1]) - Counter(words[0])
    moved = sum(was != now for was, now in zip(*words, strict=False))
    if len(old) != len(new) or not moved == gone.total() == fresh.total():
        return {}
    pairs = [(was, now) for was, now in zip(old, new, strict=True) if was != now]
    return {f"{what}{now}": f"{what}{was}" for was, now in pairs for what in ("", "box of ", "arrow of ")}


def names_of_numbered(
    old: Mapping[str, Part], new: Mapping[str, Part], same: Callable[[Part, Part], bool]
) -> dict[str, str]:
    """Return the accepted names, by new names, of parts that only have another number now.

    Parameters
    ----------
    same
        Whether two parts look alike and lie in the same place.
    """
    restless = [
        [name for name in one if _stem(one[name]) and not (name in other and same(old[name], new[name]))]
        for one, other in ((old, new), (new, old))
    ]
    was: dict[str, str] = {}
    for name in restless[1]:
        for origin in restless[0]:
            alike = origin not in was.values() and _stem(old[origin]) == _stem(new[name])
            if alike and same(old[origin], new[name]):
                was[name] = origin
                break
    return was | dict(_others(restless, was, old))


def _others(
    restless: Sequence[Sequence[str]], was: Mapping[str, str], old: Mapping[str, Part]
) -> Iterator[tuple[str, str]]:
    """Yield names for the parts whose own names are others' now."""
    free = [origin for origin in restless[0] if origin not in was.values() and origin in was]
    for name in restless[1]:
        if name in was or name not in was.values():
            continue
        origin = next((one for one in free if _stem(old[one]) == _stem(old[name])), f"another {name}")
        free = [one for one in free if one != origin]
        yield name, origin


def _stem(part: Part) -> str:
    """Return the name of a part without its number; empty if it has none, or its name is said elsewhere."""
    match = _NUMBERED.fullmatch(str(part["name"]))
    return match[1] if match and not part.get("told") else ""

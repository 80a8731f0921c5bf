"""Which panel of a figure is which in another state: by title, else by what it shows, where it stands, and its number.

The number of a panel without a title says only when its axes were made, which nobody sees.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from replicate.figures.sameness import Axes, same

_SHOWN = ("title", "xlabel", "ylabel", "xscale", "yscale", "xlim", "ylim", "legend", "texts", "aspect", "hidden")
#: What has to agree (what is shown, place, name) for two panels to be one, in the order in which that is tried.
_RANKS = (
    (True, True, False),
    (True, False, True),
    (False, True, True),
    (True, False, False),
    (False, True, False),
    (False, False, True),
)

Match = tuple[Axes, Axes] | tuple[Axes, None] | tuple[None, Axes]


def matched_panels(before: Sequence[Axes], after: Sequence[Axes]) -> list[Match]:
    """Match panels; where as many are left on both sides, they keep their order.

    Examples
    --------
    >>> left, right = ({"panel": f"panel {n}", "title": "", "position": [at, 0, 1, 1]} for n, at in ((1, 0), (2, 1)))
    >>> only = [right | {"panel": "panel 1"}]
    >>> [(old["panel"], new and new["panel"]) for old, new in matched_panels([left, right], only)]
    [('panel 1', None), ('panel 2', 'panel 1')]
    """
    found = _same_at_once(before, after)
    old = [i for i in range(len(before)) if i not in found]
    new = [j for j in range(len(after)) if j not in found.values()]
    agreeing = {(i, j): _agreement(before[i], after[j]) for i in old for j in new}
    for rank in _RANKS:
        for (i, j), agreement in agreeing.items():
            free = i not in found and j not in found.values()
            if free and all(agrees or not needed for agrees, needed in zip(agreement, rank, strict=True)):
                found[i] = j
    old, new = [i for i in old if i not in found], [j for j in new if j not in found.values()]
    found |= dict(zip(old, new, strict=True)) if len(old) == len(new) else {}
    return list(_matches(before, after, found))


def _same_at_once(before: Sequence[Axes], after: Sequence[Axes]) -> dict[int, int]:
    """Return the panels that have the same title, and of those without one the same number, contents and place."""
    places = {str(axes["panel"]): j for j, axes in enumerate(after)}
    found = {}
    for i, axes in enumerate(before):
        j = places.get(str(axes["panel"]))
        if j is not None and (_is_titled(axes) or all(_agreement(axes, after[j]))):
            found[i] = j
    return found


def _matches(before: Sequence[Axes], after: Sequence[Axes], found: dict[int, int]) -> Iterator[Match]:
    for i, axes in enumerate(before):
        yield (axes, after[found[i]]) if i in found else (axes, None)
    for j in sorted(set(range(len(after))) - set(found.values())):
        yield None, after[j]


def _is_titled(axes: Axes) -> bool:
    return str(axes["panel"]).startswith(str(axes.get("title") or " "))


def _agreement(old: Axes, new: Axes) -> tuple[bool, bool, bool]:
    """Return whether two panels show the same things, stand in the same place, and have the same name."""
    shown = all(same(old, new, name) for name in _SHOWN)
    placed = "position" in old and "position" in new and same(old, new, "position")
    return shown, placed, old["panel"] == new["panel"]

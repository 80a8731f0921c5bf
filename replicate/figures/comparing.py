"""Compare two records of a figure: axes, curves, and every part that is drawn."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from replicate.errors import FigureRecordError
from replicate.figures.axes import compare_axes
from replicate.figures.curves import CurveComparison, compare_curves
from replicate.figures.differences import Difference, same_number
from replicate.figures.mark_pairs import Frame
from replicate.figures.older_records import known_to_both
from replicate.figures.pair import Pair
from replicate.figures.panel_pairs import matched_panels
from replicate.figures.part_names import names_of_texts
from replicate.figures.partwise import come_and_gone_by_name, compare_parts
from replicate.figures.record import Record
from replicate.figures.sameness import Axes, same
from replicate.figures.scaling import in_units
from replicate.figures.stacking_changes import stacking_changes

# Where the layout follows the size of texts, places on the axes move with it.
_FITTED = 20.0


@dataclass(frozen=True)
class Comparison:
    """What differs between two records of a figure.

    Attributes
    ----------
    differences
        Each with its words, what it is about, and which layer noticed it.
    pairs
        Every curve that both records have.
    """

    differences: Sequence[Difference] = ()
    pairs: Sequence[Pair] = field(default_factory=list)

    @property
    def changes(self) -> list[str]:
        """What differs, in words, one line each; empty if nothing that can be seen does."""
        return [" ".join(difference.text.split()) for difference in self.differences]

    @property
    def unchanged(self) -> int:
        """Number of curves that are where they were."""
        return sum(not pair.moved for pair in self.pairs)


def compare_records(accepted: Record, new: Record) -> Comparison:
    """Compare two records; `replicate.figures.compare` says more."""
    try:
        return _compare(accepted, new)
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        # The record was checked when it was read; this is damage deep inside a part.
        why = f"cannot be compared, it is damaged: {type(error).__name__}: {' '.join(str(error).split())}"
        raise FigureRecordError(why) from error


def _compare(accepted: Record, new: Record) -> Comparison:
    accepted, new = known_to_both(accepted, new)
    curves = compare_curves((accepted.curves, accepted.panels), (new.curves, new.panels))
    found = [*compare_axes(accepted.panels, new.panels), *curves.changes]
    if accepted.version > 1 and new.version > 1:  # the first version knew no parts
        found += _figure(accepted.figure, new.figure)
        found += stacking_changes(accepted.figure, new.figure, "figure", _names_of_panels(accepted, new))
        found += _parts(accepted, new, curves)
        found += _untold(accepted, new, curves, found)
    return Comparison(_once(found), curves.pairs)


def _figure(one: Mapping[str, Any], other: Mapping[str, Any]) -> list[Difference]:
    sizes = [side.get("size", []) for side in (one, other)]
    parts = one.get("parts", []), other.get("parts", [])
    found = []
    if bool(one.get("fitted")) != bool(other.get("fitted")):
        found.append(Difference("axes", "whether the layout follows the size of texts has changed", "figure / fitted"))
    if len(sizes[0]) != len(sizes[1]) or not all(
        same_number(repr(a), repr(b)) for a, b in zip(sizes[0], sizes[1], strict=True)
    ):
        shown = [" × ".join(f"{side:g}" for side in size) for size in (sizes[1], sizes[0])]
        found.append(Difference("axes", f"the figure is now {shown[0]} in (was {shown[1]})", "figure / size"))
    return found + compare_parts(*parts, names_of_texts(*parts), "figure", frame=Frame(whole="figure"))


def _parts(accepted: Record, new: Record, curves: CurveComparison) -> list[Difference]:
    several = len(accepted.panels) > 1 or len(new.panels) > 1
    fitted = bool(accepted.figure.get("fitted") or new.figure.get("fitted"))
    moved = [(str(pair.axes["panel"]), pair.name) for pair in curves.pairs if pair.moved]
    found = []
    panels = _names_of_panels(accepted, new)
    for old, fresh in matched_panels(accepted.panels, new.panels):
        if old is None or fresh is None:
            continue
        panel = str(old["panel"])
        names = _names(curves, old, fresh)
        own = frozenset(name for owner, name in accepted.curves if owner == panel)
        prefix = f"'{panel}': " if several else ""
        ticks = [axis for axis in "xyz" if any(not same(old, fresh, f"{axis}{what}") for what in ("lim", "scale"))]
        found += compare_parts(
            old.get("parts", []),
            _known_parts(curves, old, fresh),
            names,
            panel,
            prefix,
            curves=own,
            frame=_frame(old, fresh, _FITTED if fitted else 1.0),
            other_ticks=ticks,
            moved=frozenset(name for owner, name in moved if owner == panel),
        )
        found += stacking_changes(old, fresh, panel, names | panels, own)
    return found


def _untold(
    accepted: Record, new: Record, curves: CurveComparison, found: Sequence[Difference]
) -> Iterator[Difference]:
    """Yield what is drawn no more, or only now, where what is said by name did not change and so said nothing."""
    said = "\n".join(" ".join(difference.text.split()) for difference in found)
    several = len(accepted.panels) > 1 or len(new.panels) > 1
    for old, fresh in matched_panels(accepted.panels, new.panels):
        if old is None or fresh is None or "parts" not in old or "parts" not in fresh:
            continue
        panel = str(old["panel"])
        parts = old["parts"], _known_parts(curves, old, fresh)
        names = _names(curves, old, fresh)
        gone = {name for owner, name in accepted.curves if owner == panel}
        come = {names.get(name, name) for owner, name in new.curves if owner == fresh["panel"]}
        for name, words in come_and_gone_by_name(*parts, names, said):
            if name not in gone ^ come:  # of these curves it is said already
                yield Difference("look", f"'{panel}': {words}" if several else words, f"{panel} / {name}")


def _names_of_panels(accepted: Record, new: Record) -> dict[str, str]:
    """Return what the accepted record calls the panels of the new one, as parts of the figure."""
    pairs = matched_panels(accepted.panels, new.panels)
    return {f"panel '{now['panel']}'": f"panel '{was['panel']}'" for was, now in pairs if was and now}


def _names(curves: CurveComparison, old: Axes, fresh: Axes) -> dict[str, str]:
    """Return the accepted names, by new names, of the curves and the texts of a panel that have another one now."""
    own = {name: was for (owner, name), was in curves.renamed.items() if owner == old["panel"]}
    return own | names_of_texts(old.get("parts", []), fresh.get("parts", []))


def _known_parts(curves: CurveComparison, old: Axes, fresh: Axes) -> list[Mapping[str, Any]]:
    """Return the parts of a panel without the curves of which it is said that they are new."""
    return [part for part in fresh.get("parts", []) if (old["panel"], part["name"]) not in curves.fresh]


def _frame(old: Axes, new: Axes, slack: float) -> Frame:
    """Return where the new limits lie on the accepted axes."""
    kept = [same(old, new, name) for name in ("xscale", "yscale", "projection", "units", "polar")]
    if not all(kept) or "polar" in old or old.get("units") == "box":
        return Frame(slack)
    if same(old, new, "xlim") and same(old, new, "ylim"):
        return Frame(slack)
    low, high = in_units(np.column_stack([new["xlim"], new["ylim"]]), old)
    return Frame(slack, (float(low[0]), float(low[1])), (float(high[0] - low[0]), float(high[1] - low[1])))


def _once(found: Sequence[Difference]) -> list[Difference]:
    """Return differences in order, those that say the same once."""
    return list({difference.text: difference for difference in found}.values())

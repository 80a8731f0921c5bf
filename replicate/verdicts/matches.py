"""How every printed value of a table compares with what one reading gives for it."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import replace

from replicate.exhibits import Table
from replicate.exhibits.conventions import settle
from replicate.exhibits.matching import Match, MatchKind, match
from replicate.exhibits.printed import Key, PrintedValue
from replicate.exhibits.results import Ranges
from replicate.verdicts.rows import Computed

_AGREEMENT: tuple[MatchKind, ...] = ("equal", "consistent", "near", "differs", "none")


def reading_matches(
    table: Table,
    reading: str,
    printed: Mapping[Key, PrintedValue],
    given: Mapping[Key, float | str | None],
    ranges: Ranges | None = None,
) -> dict[Key, Computed]:
    """Compare one reading with the print.

    Parameters
    ----------
    reading
        Its id.
    given
        The numbers and words that it gives, by (row, column).
    ranges
        For a reading with printed inputs: its ranges and the joint point of every case.

    Returns
    -------
    dict
        By (row, column), for every printed value. Of the cells that one printed value stands for, the one that agrees
        least speaks for all. A cell that holds by the convention of other columns only is ``near``; one that does not
        hold for the printed inputs themselves, but at the joint point of its case, is ``consistent``.
    """
    alone = {key: _least(table, key, value, given) for key, value in printed.items()}
    settled = settle(table, {key: one for key, (one, _) in alone.items()}, exact=ranges is None)
    found = {}
    for key, (one, convention) in settled.items():
        number = alone[key][1]
        computed = Computed(reading, None, one, number) if isinstance(number, str) else Computed(reading, number, one)
        computed = replace(computed, convention=convention, printed=printed[key])
        if ranges is not None and key in ranges.lower:
            low, high = ranges.lower[key], ranges.upper[key]
            if math.isfinite(low) and math.isfinite(high):
                computed = replace(computed, lower=low, upper=high)
            if one.kind != "equal" and _holds(match(printed[key], ranges.joint[key]), convention):
                computed = replace(computed, match=replace(one, kind="consistent"))
            if computed.match.kind in {"near", "differs"}:
                computed = replace(computed, proof=ranges.proofs.get(key, ""))
        found[key] = computed
    return found


def _least(
    table: Table, key: Key, value: PrintedValue, given: Mapping[Key, float | str | None]
) -> tuple[Match, float | str | None]:
    """Return the match of the cell that agrees least among those that a printed value stands for, and what it holds."""
    found = []
    for cell in (key, *table.spans.get(key, ())):
        held = given.get(cell)
        one = match(value, None, word=held) if isinstance(held, str) else match(value, held)
        found.append((one, held))
    return max(found, key=lambda pair: _AGREEMENT.index(pair[0].kind))


def share_points(
    table: Table, printed: Mapping[Key, PrintedValue], computed: dict[str, dict[Key, Computed]], points: Collection[str]
) -> None:
    """Let the cells of a case be consistent at one point of its printed inputs, whatever readings they come from.

    Of the readings that take inputs from the print, the one that holds in most cells of a case gives the point. A cell
    that is consistent under another one is so no more if the first computes it and does not hold there.

    Parameters
    ----------
    computed
        By reading and (row, column); changed in place.
    points
        The readings with printed inputs, in the exhibit's order.
    """
    cases: dict[str, list[Key]] = {}
    for key in printed:
        cases.setdefault(table.case(*key), []).append(key)
    for keys in cases.values():
        held = {id: sum(computed[id][key].match.kind in {"equal", "consistent"} for key in keys) for id in points}
        first = max(held, key=lambda id: held[id], default="")
        for id in points:
            for key in keys:
                one, other = computed[id][key], computed.get(first, {}).get(key)
                if id == first or one.match.kind != "consistent" or other is None or other.number is None:
                    continue
                if other.match.kind not in {"equal", "consistent"}:
                    alone = match(printed[key], one.number)
                    kind: MatchKind = "near" if alone.kind == "equal" else alone.kind
                    computed[id][key] = replace(one, match=replace(alone, kind=kind))


def _holds(one: Match, convention: str) -> bool:
    return one.kind == "equal" and one.how in {convention, "either"}


def other_convention(computed: Computed) -> bool:
    """Whether a value would hold if its column were shortened by the other convention."""
    return computed.match.kind == "near" and bool(computed.match.how)

"""What follows from an error, where it can be computed: rankings and bounds that the right number upsets."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from replicate.exhibits import Consequence, Table
from replicate.exhibits.comparisons import upsets
from replicate.exhibits.printed import Key, PrintedValue
from replicate.verdicts.rows import CONSEQUENCES, ERRORS, VerdictRow


def with_consequences(table: Table, verdicts: list[VerdictRow]) -> list[VerdictRow]:
    """Return the verdicts on a table with the consequences that follow from its rankings and bounds.

    Each error is put right alone, all other numbers as printed; what it upsets is its consequence, unless the ledger
    declares a worse one.
    """
    if not table.comparisons:
        return verdicts
    printed = {
        (row.row, row.column): float(row.value.value) for row in verdicts if row.value and row.value.states_number
    }
    result = []
    for row in verdicts:
        right = _right(row)
        if right is None or row.verdict not in ERRORS:
            result.append(row)
            continue
        upset = list(_upset(table, printed, (row.row, row.column), right))
        declared: list[Consequence] = [row.consequence] if row.consequence else []
        none: Consequence = "none"
        worst = min([*declared, *(found for found, _ in upset)], key=CONSEQUENCES.index, default=none)
        said = "; ".join(says for found, says in upset if found == worst and worst != row.consequence)
        explanation = (
            f"{row.explanation} With the right value this does not follow from the table: {said}." if said else ""
        )
        result.append(replace(row, consequence=worst, explanation=explanation.strip() or row.explanation))
    return result


def _right(row: VerdictRow) -> float | None:
    """Return the right number of a cell: the corrected one, or what the deciding reading gives.

    A number by another definition is not the right one: what it would upset says nothing of the print.
    """
    if row.cause == "definition":
        return None
    if row.corrected and row.value:
        return float(PrintedValue(row.corrected, notation=row.value.notation).value)
    return next((one.number for one in row.values if one.reading == row.reading), None)


def _upset(table: Table, printed: dict[Key, float], key: Key, right: float) -> Iterator[tuple[Consequence, str]]:
    for comparison in table.comparisons:
        if key in comparison.cells and key in printed and upsets(comparison, printed, {key: right}):
            yield comparison.consequence, comparison.says

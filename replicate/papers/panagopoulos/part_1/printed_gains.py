"""The printed controllers of paper I as loops that readers may try out."""

from __future__ import annotations

from collections.abc import Mapping

from replicate.loops import PI
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.plants import PLANTS


def trials(table: str, plants: Mapping[str, str], weights: Mapping[str, float]) -> dict[str, tuple[str, str]]:
    """Return plant and printed controller by row of a table.

    Parameters
    ----------
    plants
        The plant by row; a row whose plant is given by a function is left out.
    weights
        The set-point weight by row, 1 where it has none.
    """
    printed = paper.printed_numbers(table)
    found = {}
    for row, name in plants.items():
        plant = PLANTS[name]
        if not plant.is_rational:
            continue
        k = printed[row, "k"]
        ki = printed[row, "ki"] if (row, "ki") in printed else k / printed[row, "Ti"]
        found[row] = plant.notation(), PI(k, ki, weights.get(row, 1.0)).notation()
    return found


def printed_weights(table: str) -> dict[str, float]:
    """Return the set-point weights that a table prints, by row."""
    return {row: number for (row, column), number in paper.printed_numbers(table).items() if column == "b"}

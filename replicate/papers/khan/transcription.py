"""The printed numbers of a table, for exhibits that count how many of them a hypothesis meets."""

from __future__ import annotations

from importlib.resources import files

import pandas as pd


def printed_cells(exhibit: str) -> dict[tuple[str, str], float]:
    """Return the printed numbers of a table by row and column key."""
    with (files(__package__) / "printed" / f"{exhibit}.csv").open(encoding="utf-8") as stream:
        frame = pd.read_csv(stream, index_col=0)
    return {(str(row), str(column)): float(frame.loc[row, column]) for row in frame.index for column in frame.columns}

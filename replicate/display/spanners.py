"""Heads over groups of columns: four columns "$M_P$, $ph = 1$", "$t_s$, $ph = 1$" ... stand under one "$ph = 1$"."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import groupby

_COMMA = re.compile(r",\s+(?=(?:[^$]*\$[^$]*\$)*[^$]*$)")  # outside of formulas


@dataclass(frozen=True)
class Span:
    """Columns that share a part of their labels.

    Attributes
    ----------
    label
        What they share, empty for a column that stands alone.
    columns
        Place and remaining label of each.
    """

    label: str
    columns: list[tuple[int, str]]


def spans(labels: Sequence[str]) -> list[Span]:
    """Return columns in groups that share what their labels say after, or before, a comma.

    Parameters
    ----------
    labels
        The labels of all columns, in their order.

    Returns
    -------
    list of Span
        In the order of the columns; a group has two neighbours at least. Of the two ways to group, the one that
        covers more columns.

    Examples
    --------
    >>> for span in spans(["$a$, $n = 1$", "$b$, $n = 1$", "sum"]):
    ...     print(repr(span.label), span.columns)
    '$n = 1$' [(0, '$a$'), (1, '$b$')]
    '' [(2, 'sum')]
    >>> [span.label for span in spans(["$n=1$, $N=2$", "$n=1$, $N=5$", "$f(x, y)$"])]
    ['$n=1$', '']
    """
    after, before = (_grouped(labels, split) for split in (_after, _before))
    return max((after, before), key=lambda found: sum(len(span.columns) for span in found if span.label))


def _after(label: str) -> tuple[str, str]:
    parts = _COMMA.split(label)
    return (parts[-1], ", ".join(parts[:-1])) if len(parts) > 1 else ("", label)


def _before(label: str) -> tuple[str, str]:
    parts = _COMMA.split(label)
    return (parts[0], ", ".join(parts[1:])) if len(parts) > 1 else ("", label)


def _grouped(labels: Sequence[str], split: Callable[[str], tuple[str, str]]) -> list[Span]:
    found = []
    for shared, run in groupby(enumerate(labels), key=lambda entry: split(entry[1])[0]):
        columns = list(run)
        if shared and len(columns) > 1:
            found.append(Span(shared, [(place, split(label)[1]) for place, label in columns]))
        else:
            found += [Span("", [column]) for column in columns]
    return found

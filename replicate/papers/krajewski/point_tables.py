"""The tables that check the numbers printed under Figures 8 to 12."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from replicate.papers.krajewski import paper
from replicate.papers.krajewski.points import METRICS, margins_at, metrics_at, named_points, trials

if TYPE_CHECKING:
    from collections.abc import Callable

    import pandas as pd

    from replicate.papers.krajewski.points import NamedPoint

COORDINATES = ("a", "b")
MARGINS = ("m_phi", "g", "omega_A")
LABELS = {
    "m_phi": "$m_\\varphi$",
    "g": "$g$",
    "omega_A": "$\\omega_A$",
    "overshoot": "overshoot",
    "rise_time": "rise time",
    "settling_time": "settling time",
    "delay_time": "time to 1/2",
}
UNITS = {"m_phi": "degrees"}

CAPTION = (
    "Coordinates are recomputed from what defines the point, margins from the coordinates as printed, so that "
    "each printed number is checked against the others. Coordinates that the authors chose freely agree by "
    "construction."
)
CAPTION_OF_METRICS = (
    "Overshoot is a fraction; rise time is from 10 to 90 %, settling time to 2 %, in units of $T$, from the "
    "step, dead time included."
)

NOTE = (
    "$a$ and $b$ follow from the definition in the text; a coordinate the authors chose is taken as it "
    "is. $m_\\varphi$, $g$, $\\omega_A$ and the response are those of the loop with $a$ and $b$ as "
    "printed in the text, where $0.91\\bar6$ is 11/12 and $2.\\bar2$ is 20/9."
)


def point_table(exhibit: str, title: str, *, responses: bool = True, caption: str = "") -> None:
    """Add the table of a figure's points with its readings.

    Parameters
    ----------
    exhibit
        The figure.
    responses
        Whether the table has the metrics of the step responses.
    caption
        What is particular to this table, before the general remarks.
    """
    points = named_points(exhibit)
    columns = (*COORDINATES, *MARGINS, *(METRICS if responses else ()))
    table = paper.table(
        f"{exhibit}-values",
        title,
        rows=tuple(points),
        columns=columns,
        caption=" ".join(filter(None, (caption, CAPTION, CAPTION_OF_METRICS if responses else ""))),
        labels={key: LABELS[key] for key in columns if key in LABELS},
        units=UNITS,
    )
    table.trials = partial(trials, exhibit)

    def frame(loop_at: Callable[[NamedPoint], tuple[float, float]]) -> pd.DataFrame:
        rows = {}
        for row, named in points.items():
            at = loop_at(named)
            found = dict(zip(COORDINATES, named.exact(), strict=True)) | margins_at(*at)
            rows[row] = found | (metrics_at(*at) if responses else {})
        return table.frame(rows)

    table.reading("as-written", "Definition of the point; margins at the printed point", NOTE)(
        lambda: frame(lambda named: (named.a, named.b))
    )
    if any(named.exact() != (named.a, named.b) for named in points.values()):
        table.reading(
            "exact-point",
            "Everything at the exact point",
            "The margins and the response are also those of the point that the text defines, not of its "
            "printed coordinates.",
        )(lambda: frame(lambda named: named.exact()))
    if any(named.caption_b != named.b for named in points.values()):
        table.reading(
            "caption-digits",
            "Margins at the caption's digits",
            "$b$ with the digits of the figure's caption, where the overline that marks a repeating digit is missing.",
        )(lambda: frame(lambda named: (named.a, named.caption_b)))

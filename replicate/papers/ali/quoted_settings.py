"""The competing settings of both examples, which the paper quotes from other papers."""

from __future__ import annotations

from functools import partial

import pandas as pd

from replicate.papers.ali import paper
from replicate.papers.ali.examples import EXAMPLE_1, EXAMPLE_2, LABELS
from replicate.papers.ali.iste import Kind, best
from replicate.papers.ali.structures import ideal_on_output, printed_settings, trial

KINDS: dict[str, Kind] = {"visioli-setpoint": "setpoint", "visioli-load": "load"}

quoted_settings = paper.table(
    "quoted-settings",
    "Competing settings, quoted from other papers",
    rows=("padma-sree", *KINDS),
    columns=("Kp", "Ti", "Td"),
    caption="Inputs of the two examples. The rules that gave them are not in this paper, nor is the controller "
    "structure that they were made for. Visioli's are fitted to settings that minimise the ISTE, and that minimum can "
    "be computed for each structure.",
    shared_labels=LABELS,
)


@quoted_settings.reading("as-written", "No rule is given")
def nothing() -> pd.DataFrame:
    """Compute nothing: the paper has no rule for these settings."""
    return quoted_settings.blank()


def _optimal(form: str) -> pd.DataFrame:
    frame = nothing()
    for row, kind in KINDS.items():
        settings = best(form, kind)
        frame.loc[row] = [settings.Kp, settings.Ti, settings.Td]
    return frame


for _form, _title in (
    ("parallel", "Smallest ISTE, parallel form without filter"),
    ("series", "Smallest ISTE, form (2)"),
):
    quoted_settings.reading(
        f"iste-{_form}",
        _title,
        "The setting with the smallest $\\int t^2 e^2\\,dt$ for the plant of Example 2, after a unit step of the set "
        "point or of the load, to three digits.",
    )(partial(_optimal, _form))


def _trials() -> dict[str, tuple[str, str]]:
    """Return each setting with the plant of its example, in the form that it was most probably made for."""
    thetas = {row: EXAMPLE_2 if row in KINDS else EXAMPLE_1 for row in quoted_settings.rows}
    return {
        row: trial(float(theta), ideal_on_output(printed_settings(quoted_settings.id, row)))
        for row, theta in thetas.items()
    }


quoted_settings.trials = _trials

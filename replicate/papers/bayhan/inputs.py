"""The processes of the examples and of the experiment, and the parameters chosen for them: inputs, as printed."""

from __future__ import annotations

from functools import partial

from replicate.papers.bayhan import paper

LABELS = {"K": "$K$", "L": "$L$", "tau": "$\\tau$", "a": "$a$", "tau_cl": "$\\tau_{cl}$"}

example_4_1 = paper.table(
    "example-4-1",
    "The process of Example 4.1 and the free parameters",
    kind="example",
    rows=("tau", "L", "K", "a", "tau_cl"),
    columns=("value",),
    caption="Inputs of Table 2.",
    labels=LABELS,
)
example_4_2 = paper.table(
    "example-4-2",
    "The process of Example 4.2 and the free parameter",
    kind="example",
    rows=("tau", "L", "K", "a"),
    columns=("value",),
    caption="Inputs of Table 3. No $\\tau_{cl}$ is given.",
    shared_labels=LABELS,
)
pt326 = paper.table(
    "pt326",
    "The identified model of the PT326 set and the free parameters",
    kind="example",
    rows=("K", "L", "tau", "a", "tau_cl"),
    columns=("value",),
    caption="Inputs of Figures 4 and 5: $G(s) = K e^{-Ls}/(\\tau s + 1)$.",
    labels=LABELS,
)

for _table in (example_4_1, example_4_2, pt326):
    _table.reading("as-written", "Inputs")(partial(type(_table).blank, _table))

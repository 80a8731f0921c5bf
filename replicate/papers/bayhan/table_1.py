"""Table 1 and (21), (22): the eleven tuning rules, evaluated for the two examples."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.bayhan import paper
from replicate.papers.bayhan.processes import EXAMPLE_41, EXAMPLE_42, RULES, competing_rules, controllers, trials

if TYPE_CHECKING:
    import pandas as pd

COLUMNS = ("Kp_41", "Ti_41", "Kp_42", "Ti_42")


def _labels() -> dict[str, str]:
    """Row labels that show each rule as the paper prints it."""
    labels = {"PA": "Pole assignment (PA): (21), (22)"}
    for id, rule in competing_rules().items():
        labels[id] = f"{rule.name} ({id}): $K_p = {rule.tex['Kp']}$, $T_i = {rule.tex['Ti']}$"
    for column in COLUMNS:
        quantity, example = column.split("_")
        labels[column] = f"${quantity[0]}_{quantity[1]}$, Example {example[0]}.{example[1]}"
    return labels


def _mended(variant: str) -> str:
    """List in one sentence each what a variant changes."""
    rules = competing_rules(variant).values()
    return " ".join(f"{rule.id}: $T_i = {rule.tex['Ti']}$; {rule.why}." for rule in rules if rule.why)


table_1 = paper.table(
    "table-1",
    "The tuning rules, evaluated for both examples",
    printed=False,
    rows=RULES,
    columns=COLUMNS,
    caption="The formulas as the paper prints them, and what they give for Example 4.1 ($K = \\tau = L = "
    "1$) and Example 4.2 ($K = 1$, $\\tau = 0.1$, $L = 0.5$). A negative $T_i$ means that the rule has "
    "left the range it was fitted for ($L/\\tau = 5$). The paper gives no $\\tau_{cl}$ for Example 4.2; "
    "that of Example 4.1 is used.",
    labels=_labels(),
)
table_1.trials = lambda: {
    (rule, example): loop
    for example, process in (("Example 4.1", EXAMPLE_41), ("Example 4.2", EXAMPLE_42))
    for rule, loop in trials(process, RULES).items()
}


def _evaluate(variant: str) -> pd.DataFrame:
    import pandas as pd

    columns: dict[str, list[float]] = {}
    for suffix, process in (("41", EXAMPLE_41), ("42", EXAMPLE_42)):
        found = controllers(process, variant=variant)
        columns[f"Kp_{suffix}"] = [found[rule].k for rule in RULES]
        columns[f"Ti_{suffix}"] = [found[rule].k / found[rule].ki for rule in RULES]
    return pd.DataFrame(columns, index=list(RULES))


@table_1.reading("as-written", "As printed")
def as_written() -> pd.DataFrame:
    """Evaluate the rules as printed."""
    return _evaluate("printed")


@table_1.reading("corrected", "Printing errors mended", note=_mended("corrected"))
def corrected() -> pd.DataFrame:
    """Evaluate the rules with the printing errors mended."""
    return _evaluate("corrected")


@table_1.reading("authors", "As the authors evidently computed", note=_mended("authors"))
def authors() -> pd.DataFrame:
    """Evaluate the rules in the form that gives the printed digits."""
    return _evaluate("authors")

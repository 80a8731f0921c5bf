"""Illustration I: the sleep that ten patients gained with each of two drugs, and the difference of the two."""

import csv
import statistics
from collections.abc import Callable

import pandas as pd

from student1908 import paper

PATIENTS = tuple(str(number) for number in range(1, 11))
DRUGS = ("dextro", "laevo")

table = paper.table(
    "illustration-1",
    "Additional hours of sleep",
    rows=(*PATIENTS, "mean", "sd"),
    columns=(*DRUGS, "difference"),
    labels={
        "dextro": "1 (dextro-)",
        "laevo": "2 (laevo-)",
        "difference": "difference (2 − 1)",
        "mean": "mean",
        "sd": "standard deviation",
    },
)


def hours() -> dict[str, list[float]]:
    """Return the measured hours of both drugs and their differences, in the order of the patients.

    The measurements are the paper's own, so they are taken from its printed table and stand nowhere else. Differences
    of numbers with one decimal have one decimal: what lies beyond is the binary rounding of the subtraction.
    """
    with paper.data("printed/illustration-1.csv").open(encoding="utf-8") as file:
        rows = {row["row"]: row for row in csv.DictReader(file)}
    columns = {drug: [float(rows[patient][drug]) for patient in PATIENTS] for drug in DRUGS}
    pairs = zip(columns["dextro"], columns["laevo"], strict=True)
    return {**columns, "difference": [round(second - first, 1) for first, second in pairs]}


@table.reading("as-written", "standard deviation divided by $n$")
def as_written() -> pd.DataFrame:
    """Student's section I: the squared standard deviation is the mean of the squared deviations."""
    return _computed(statistics.pstdev)


@table.reading(
    "n-1",
    "standard deviation divided by $n - 1$",
    note="The estimate that the $t$ test of today's programs uses.",
)
def n_minus_1() -> pd.DataFrame:
    """Divided by the degrees of freedom."""
    return _computed(statistics.stdev)


def _computed(deviation: Callable[[list[float]], float]) -> pd.DataFrame:
    gained = hours()
    frame = pd.DataFrame(index=[*PATIENTS, "mean", "sd"], columns=list(gained), dtype=float)
    frame.loc[list(PATIENTS), "difference"] = gained["difference"]
    for column, values in gained.items():
        frame.loc["mean", column] = statistics.fmean(values)
        frame.loc["sd", column] = deviation(values)
    return frame

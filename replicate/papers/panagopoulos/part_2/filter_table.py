"""The readings of Table 1 of the supplement."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from replicate.exhibits.exclusion import Box
from replicate.loops import PID, Loop, Plant
from replicate.loops.bounds.gain_boxes import GainBox
from replicate.loops.bounds.intervals import exactly
from replicate.loops.sweep.pairs import pair_metrics
from replicate.papers.panagopoulos import certain, paper
from replicate.papers.panagopoulos.part_2 import filters
from replicate.papers.panagopoulos.part_2.filters import CUT, HEADED
from replicate.papers.panagopoulos.part_2.processes import G4

if TYPE_CHECKING:
    import pandas as pd

GAINS = ("K", "Ti", "Td")

LABELS = {
    "argFy": r"$\arg F_y(i\omega_0)$, degrees",
    "K": "$K$",
    "Ti": "$T_i$",
    "Td": "$T_d$",
    "w0": r"$\omega_0$",
    "IAE": "IAE",
    "Mn": "$M_n$",
    **{key: f"$n={n}$, $N={size}$" for key, (n, size) in HEADED.items()},
    "none": "no filter",
}

table = paper.table(
    filters.TABLE,
    "PID design with measurement filters",
    rows=filters.ROWS,
    columns=filters.COLUMNS,
    caption=r"$G = 1/(s+1)^4$, $M_s = 1.4$, designed for $F_yG$ with filters of order $n$. IAE is that of the "
    r"output $y$ after a unit load step. Without filter $M_n$ is infinite, printed as $\infty$.",
    labels=LABELS,
    cases="columns",
)
# A controller is a column here: its link stands in the row of the gains. The page draws no filter in the measurement.
table.trials = lambda: {
    ("K", LABELS[filters.UNFILTERED]): (
        G4.notation(),
        replace(filters.printed_pid(filters.UNFILTERED), c=0.0).notation(),
    )
}


def _frame(columns: dict[str, dict[str, float]]) -> pd.DataFrame:
    import pandas as pd

    return pd.DataFrame(columns, index=list(filters.ROWS))[list(filters.COLUMNS)].astype(float)


@table.reading(
    "as-written",
    "The text",
    r"$T_f = 1/(nN\omega_0)$ with $N$ as the column is headed and $\omega_0$ of the design without filter; the "
    r"constraints of "
    "(5); $M_n$ the supremum over all frequencies; the angle in degrees.",
)
def as_written() -> pd.DataFrame:
    """Return the table as the text describes it."""
    return _frame({c: filters.numbers(*filters.by_the_text(c)) for c in filters.COLUMNS})


@table.reading(
    "conventions",
    "Five hidden conventions",
    r"The angle in gon (400 to the circle); $N = 1$ in the columns headed 2; for $n = 2$ the $\omega_0$ of the "
    r"column before, "
    "as printed, instead of the one without filter; with a filter, curvature below minus the mean distance that "
    "the printed "
    rf"designs keep from zero, instead of zero; $M_n$ only up to {CUT:g} rad/s.",
    tried={
        "unit of the angle": 2,
        "$N$ in the columns headed 2": 2,
        "$\\omega_0$ of the filter": 3,
        "distance from zero curvature": 2,
        "range of $M_n$": 2,
    },
)
def conventions() -> pd.DataFrame:
    """Return the table under the conventions that its numbers show."""
    return _frame({c: filters.numbers(*filters.reconstructed(c), gon=True, cut=CUT) for c in filters.COLUMNS})


def _loops(column: str, box: Box) -> tuple[Plant, GainBox]:
    k, ti, td = (certain.side(box, name) for name in GAINS)
    if column == filters.UNFILTERED:
        return G4, GainBox.of_times(k, ti, td)
    used = filters.as_used(column)
    assert used  # noqa: S101  -- every headed column has one
    w0 = certain.side(box, f"w0@{filters.source_of_w0(column)}")
    lag = exactly(1.0) / (exactly(float(used.order * used.N)) * w0)
    return G4, GainBox.of_times(k, ti, td, lag, used.order)


def _printed_controller(column: str, given: Mapping[str, float]) -> PID:
    w0 = next((number for name, number in given.items() if name.startswith("w0")), None)
    pid = PID.ideal(*(given[name] for name in GAINS))
    used = filters.as_used(column, w0)
    return used.on(pid) if used else pid


def _of_many_gains(points: Sequence[tuple[str, Mapping[str, float]]]) -> list[dict[str, float] | None]:
    """Return what follows from many printed gains."""
    controllers = [_printed_controller(*point) for point in points]
    found = pair_metrics([(G4, controller) for controller in controllers], ("ms_frequency", "load_iae"))
    return [_properties(pid, *one) if one else None for pid, one in zip(controllers, found, strict=True)]


def _properties(controller: PID, w0: float, iae: float) -> dict[str, float]:
    return {"w0": w0, "IAE": iae, "Mn": filters.noise_gain(controller, CUT)}


@table.reading(
    "printed-gains",
    "From the printed gains, with the filters they belong to",
    r"$\omega_0$, IAE and $M_n$ of the printed $K$, $T_i$, $T_d$ with the filters of the reconstruction, whose "
    r"$\omega_0$ is printed as well.",
    inputs=GAINS,
    inputs_of={c: (*GAINS, f"w0@{filters.source_of_w0(c)}") for c in filters.HEADED},
    rules_out=certain.rules(_loops, "w0", "IAE"),
    many=_of_many_gains,
)
def printed_gains(column: str, given: Mapping[str, float]) -> dict[str, float]:
    """Return what follows from the printed gains."""
    controller = _printed_controller(column, given)
    loop = Loop(G4, controller)
    return _properties(controller, loop.sensitivity_peak().frequency, loop.load_step().iae())


evidence = paper.table(
    "IIs-filters",
    "Which filter the printed columns belong to",
    printed=False,
    rows=filters.COLUMNS,
    columns=("Ms_text", "Ms_used", "curvature", "w0_implied", "w0_source"),
    caption="With the printed gains: $M_s$ with the filter of the text and with the filter of the "
    "reconstruction (1.4 is "
    r"asked for), the largest curvature with the latter, and the $\omega_0$ in $T_f$ that gives exactly $M_s = "
    r"1.4$ beside "
    r"the printed $\omega_0$ that the reconstruction takes.",
    shared_labels=LABELS,
    labels={
        "Ms_text": "$M_s$, text",
        "Ms_used": "$M_s$, reconstruction",
        "curvature": r"largest $\kappa$",
        "w0_implied": r"$\omega_0$ for $M_s = 1.4$",
        "w0_source": r"$\omega_0$ taken",
    },
)


@evidence.reading("as-written", "From the printed gains")
def which_filter() -> pd.DataFrame:
    """Return the evidence for N = 1 and the overwritten w0."""
    from scipy.optimize import brentq

    from replicate.loops import design_pi, search_range
    from replicate.papers.panagopoulos.part_2.printed_gains import printed_number
    from replicate.papers.panagopoulos.part_2.processes import G4
    from replicate.papers.panagopoulos.part_2.shape import largest_over

    def peak(filter_: filters.Filter | None, column: str) -> float:
        pid = filters.printed_pid(column)
        return float(Loop(G4, filter_.on(pid) if filter_ else pid).sensitivity_peak())

    rows = {}
    for column in filters.COLUMNS:
        used = filters.as_used(column)
        plant = used.times(G4) if used else G4
        start = design_pi(plant, ms=filters.MS)
        span = search_range(plant, start.k, start.ki)
        implied = source = float("nan")
        text = None
        if used:
            text = filters.Filter(used.order, HEADED[column][1], printed_number(filters.TABLE, "w0", "none"))
            source = used.w0

            def excess(w0: float, used: filters.Filter = used, column: str = column) -> float:
                return peak(filters.Filter(used.order, used.N, w0), column) - filters.MS

            implied = float(brentq(excess, 0.7 * source, 1.5 * source, xtol=1e-12))
        rows[column] = {
            "Ms_text": peak(text, column),
            "Ms_used": peak(used, column),
            "curvature": largest_over("curvature", plant, filters.printed_pid(column), span),
            "w0_implied": implied,
            "w0_source": source,
        }
    return evidence.frame(rows)

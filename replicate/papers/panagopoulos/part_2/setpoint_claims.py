"""The checkable sentences of the supplement on set-point weight and filter."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

from replicate.exhibits import Finding
from replicate.exhibits.evidence import number, share
from replicate.loops import PID, Loop
from replicate.papers.panagopoulos.part_2.claims import ROUNDING, claims
from replicate.papers.panagopoulos.part_2.designs import optimal
from replicate.papers.panagopoulos.part_2.load_experiment import loop_of
from replicate.papers.panagopoulos.part_2.processes import PLANTS, ROWS, split
from replicate.papers.panagopoulos.part_2.setpoint import (
    Resonance,
    filter_as_printed,
    filter_corrected,
    full_weight_filter_corrected,
    setpoint_gain,
    weight_from_peak,
    weight_limit,
    with_setpoint,
)
from replicate.papers.panagopoulos.part_2.setpoint_formulas import weight_peak


@claims.claim(
    "eq-15-ensures-14", "(15) ensures (14) at all frequencies.", where="IIs, (14), (15)", consequence="comparison"
)
def eq_15() -> Finding:
    peaks = {row: weight_peak(optimal(row), weight_limit(optimal(row))) for row in ROWS}
    above = sum(value > 1.0 + 1e-9 for value in peaks.values())
    return Finding(
        "fails" if above else "holds",
        max(peaks.values()),
        f"With $b$ at the limit (15) the left side of (14) exceeds one in {above} of {len(ROWS)} designs, up to "
        f"{number(max(peaks.values()), 4)}. (15) compares corner frequencies; (14) itself is $b \\leq "
        "\\sqrt{1-2T_d/T_i}$ and cannot be met at all if $T_i < 2T_d$.",
    )


@claims.claim(
    "eq-16-gives-one",
    "$T_{sp}$ of (16) gives $|F_{sp}G_{sp}| = 1$ at $\\omega_{mp}$.",
    where="IIs, (16)",
)
def eq_16() -> Finding:
    gains, right = [], []
    for row in ROWS:
        c = optimal(row)
        peak = Resonance.of(loop_of(split(row)[0], c))
        if weight_from_peak(c, peak) == 0.0:
            gains.append(setpoint_gain(c, peak, 0.0, filter_as_printed(c, peak)))
            right.append(setpoint_gain(c, peak, 0.0, filter_corrected(c, peak)))
    worst = max(gains, key=lambda value: abs(value - 1.0))
    mended = sum(abs(g - 1.0) < ROUNDING for g in right)
    return Finding(
        "holds" if abs(worst - 1.0) < ROUNDING else "undecided" if mended == len(right) else "fails",
        worst,
        f"As our copy has it, divided by $\\omega_{{mp}}^2$, it gives {number(min(gains), 3)} to "
        f"{number(max(gains), 3)}; "
        f"divided by $\\omega_{{mp}}$ it gives one in {mended} of {len(right)} cases. One exponent, in the paper or "
        "in the "
        "copy at hand; the filters of paper II's table and that of paper V follow from the right form.",
    )


@claims.claim(
    "filter-b-one",
    "With $b = 1$ and the filter the set-point response rises more slowly but settles as fast.",
    where="IIs, section 3",
)
def filter_b_one() -> Finding:
    slower, ratio = [], {}
    for row in ROWS:
        name = split(row)[0]
        c = optimal(row)
        time = full_weight_filter_corrected(c, Resonance.of(loop_of(name, c)))
        if time == 0.0:
            continue
        plain, with_filter = (
            Loop(PLANTS[name], PID(c.k, c.ki, c.kd, b=1.0, setpoint_filter=value)).step() for value in (0.0, time)
        )
        slower.append(with_filter.rise_time() > plain.rise_time())
        ratio[row] = with_filter.settling_time() / plain.settling_time()
    same = sum(abs(value - 1.0) < 0.1 for value in ratio.values())
    return Finding(
        "holds-partly" if all(slower) else "fails",
        max(ratio.values()),
        f"The rise time grows in {sum(slower)} of {len(slower)} cases. The settling time (2 %) stays within a tenth in "
        f"{same} of them; it changes by factors between {number(min(ratio.values()), 3)} and "
        f"{number(max(ratio.values()), 3)}.",
    )


@claims.claim("weight-helps", "The chosen set-point weight makes the overshoot acceptable.", where="IIs, section 3")
def weight_helps() -> Finding:
    found = {}
    for row in ROWS:
        c = with_setpoint(row, optimal(row))
        found[row] = 100.0 * Loop(PLANTS[split(row)[0]], c).step().overshoot()
    verdict, kept, total = share(value < 20.0 for value in found.values())
    return Finding(
        verdict,
        max(found.values()),
        f"With the corrected formulas the overshoot stays below 20 % in {kept} of {total} designs; the largest is "
        f"{number(max(found.values()), 3)} percent ({max(found, key=lambda row: found[row])}).",
    )

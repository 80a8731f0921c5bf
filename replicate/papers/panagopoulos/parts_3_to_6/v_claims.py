"""The checkable sentences of paper V, on its two models."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

from replicate.exhibits import Finding
from replicate.exhibits.evidence import number
from replicate.loops import PID, Loop
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.parts_3_to_6 import v_drying, v_starch
from replicate.papers.panagopoulos.parts_3_to_6.industrial import (
    DRYING,
    DRYING_MS,
    DRYING_PI,
    DRYING_SETTINGS,
    FILTER,
    STARCH,
    STARCH_MS,
    STARCH_PI,
    STARCH_SETTINGS,
    N,
    drying_design,
    drying_pid,
    on_both_limits,
    setpoint_filters,
    starch_design,
    starch_pid,
)

claims = paper.claims("V-claims", "Claims made in the text of paper V")


@claims.claim("starch-ms", "The PID controller of the starch boiler has $M_s = 1.6$.", where="section 3", printed="1.6")
def starch_ms() -> Finding:
    found = v_starch.evaluation()
    off = abs(found["Ms"] - STARCH_MS)
    return Finding(
        "holds" if off < 0.05 else "fails",
        found["Ms"],
        f"{number(found['Ms'])} with an ideal derivative, {number(found['Ms_filtered'])} with the mill's "
        f"filter $N = 8$. The previous PI controller had {number(found['Ms_PI'])}.",
    )


@claims.claim(
    "starch-optimal",
    "The starch boiler's PID controller was designed with the method of paper II.",
    where="section 3",
)
def starch_optimal() -> Finding:
    gain, ti, _ = STARCH_SETTINGS
    full, free = starch_design(("curvature", "phase")), starch_design(("phase",))
    on_limits = on_both_limits(gain)
    share = gain / ti / free.ki
    return Finding(
        "holds-partly",
        share,
        "The settings lie where the sensitivity circle and the phase constraint both limit: for $K$ = "
        f"{gain:g} that point has $T_i$ = {number(on_limits['Ti'])} and $T_d$ = {number(on_limits['Td'])}. But "
        f"they violate the curvature constraint (with it the optimum is $K$ = {number(full.k)}, $T_i$ = "
        f"{number(full.integral_time)}, $T_d$ = {number(full.derivative_time)}), and without it $k_i$ can "
        f"still grow: the printed one is {share:.0%} of the optimum at $K$ = {number(free.k)}. The search "
        "seems to have stopped early.",
    )


@claims.claim(
    "starch-load", "On the starch boiler PID rejects load disturbances better than PI.", where="section 3, Figure 4"
)
def starch_load() -> Finding:
    found = v_starch.evaluation()
    ratio = found["IAE_PID"] / found["IAE_PI"]
    return Finding(
        "holds" if ratio < 1.0 else "fails",
        ratio,
        f"On the model a load step has an IAE of {number(found['IAE_PID'])} with PID ($N = 8$) and "
        f"{number(found['IAE_PI'])} with PI; the integrated error falls from {number(found['IE_PI'])} to "
        f"{number(found['IE_PID'])}. (The two measured mean-square errors cannot be recomputed; they depend on "
        "the disturbances of the day.)",
    )


@claims.claim(
    "starch-setpoint", "On the starch boiler PID follows set-point changes better than PI.", where="section 3, Figure 4"
)
def starch_setpoint() -> Finding:
    old, new = (Loop(STARCH, controller).step() for controller in (STARCH_PI, starch_pid()))
    settled = [step.settling_time(0.02) for step in (new, old)]
    return Finding(
        "undecided",
        new.ise() / old.ise(),
        "The paper judges by mean-square errors measured at the mill, over set-point changes and disturbances "
        "together. On "
        "the model, with $b = 1$ and no set-point "
        f"filter, the ISE of a step is {number(new.ise())} with PID and {number(old.ise())} with PI. But PID "
        f"overshoots by {new.overshoot():.0%} instead of {old.overshoot():.0%}, and settles in "
        f"{number(settled[0], 3)} s instead of {number(settled[1], 3)} s. (The supplement to paper II says that the "
        "overshoots at this mill were unacceptable until a set-point filter was used.)",
    )


@claims.claim("starch-start", "The PID design gave a faster start-up of the starch boiler.", where="section 3")
def starch_start() -> Finding:
    reached = {
        name: float(Loop(STARCH, controller).step().first_reach(1.0))
        for name, controller in (("PI", STARCH_PI), ("PID", starch_pid()))
    }
    return Finding(
        "holds" if reached["PID"] < reached["PI"] else "fails",
        reached["PID"] / reached["PI"],
        f"On the model a set-point step is first reached after {number(reached['PID'], 3)} s with PID and after "
        f"{number(reached['PI'], 3)} s with PI; what follows is the overshoot.",
    )


@claims.claim("starch-noise", "Derivative action increases the noise in the control signal.", where="section 3")
def starch_noise() -> Finding:
    gain, _, _ = STARCH_SETTINGS
    ratio = gain * (1.0 + N) / STARCH_PI.k
    return Finding(
        "holds" if ratio > 1.0 else "fails",
        ratio,
        f"At high frequency the PID controller amplifies noise by $K(1+N)$ = {number(gain * (1.0 + N))}, the "
        f"PI controller by {number(STARCH_PI.k)}.",
    )


@claims.claim(
    "drying-optimal", "The drying section's PID controller is the optimum for $M_s = 1.4$.", where="section 4"
)
def drying_optimal() -> Finding:
    gain, ti, _ = DRYING_SETTINGS
    best = drying_design()
    share = gain / ti / best.ki
    ms = v_drying.evaluation()["Ms"]
    touching = ", ".join(number(part.frequency) for part in best.active)
    return Finding(
        "holds" if abs(share - 1.0) < 0.005 else "fails",
        share,
        f"The optimum is $K$ = {number(best.k)}, $T_i$ = {number(best.integral_time)}, $T_d$ = "
        f"{number(best.derivative_time)}; the printed $k_i$ differs from it by {share - 1.0:.3%}. The circle "
        f"is touched at two frequencies, {touching}; no other constraint is active. The printed settings have "
        f"$M_s$ = {number(ms)}.",
    )


@claims.claim("drying-ms", "The design has $M_s = 1.4$, good robustness.", where="section 4", printed="1.4")
def drying_ms() -> Finding:
    found = v_drying.evaluation()
    off = abs(found["Ms"] - DRYING_MS)
    filtered = Loop(DRYING, PID.ideal(*DRYING_SETTINGS, derivative_filter=DRYING_SETTINGS[2] / N))
    return Finding(
        "holds" if off < 0.05 else "fails",
        found["Ms"],
        f"{number(found['Ms'])} with an ideal derivative; a derivative filter $N = 8$ like the starch boiler's "
        f"would raise it to {number(filtered.sensitivity_peak().value)}. The previous PI controller had "
        f"{number(found['Ms_PI'])}.",
    )


@claims.claim(
    "filter", "The set-point filter follows from the supplement to paper II.", where="section 4", printed="5.32"
)
def setpoint_filter() -> Finding:
    found = setpoint_filters()
    best = drying_design()
    unrounded = setpoint_filters((best.k, best.ki, best.kd)).coarse_grid
    fits = max(abs(value - FILTER) for value in (found.coarse_grid, unrounded)) <= 0.005
    return Finding(
        "holds-partly" if fits else "fails",
        found.coarse_grid,
        f"The formula as our copy has it gives {number(found.printed_formula)}. With its slips mended, whether of the "
        "paper "
        f"or of the copy, it gives "
        f"{number(found.corrected)} s, {abs(FILTER / found.corrected - 1.0):.1%} from the printed {FILTER:g} s; "
        f"and {number(found.coarse_grid)} s from the printed settings or {number(unrounded)} s from the unrounded "
        "ones if the peak of $|T|$ is read off 50 frequencies, `logspace(-2, 2)`. That fits the right formula on a "
        "grid too "
        "coarse for it.",
    )


@claims.claim("overshoot", "The set-point filter gives an acceptable overshoot.", where="section 4, Figure 7")
def overshoot() -> Finding:
    found = v_drying.evaluation()
    return Finding(
        "undecided",
        found["overshoot_PID"],
        "What is acceptable is not said. On the model the filter reduces the overshoot from "
        f"{found['overshoot_unfiltered']:.1%} to "
        f"{found['overshoot_PID']:.1%}; PI has {found['overshoot_PI']:.1%}. A first-order filter that keeps "
        f"$|G_{{sp}}|$ at or below one everywhere would need {number(setpoint_filters().never_above_one)} s: "
        "the loop has two integrators.",
    )


@claims.claim("faster", "The PID controller settles faster than the PI controller.", where="section 4, Figure 7")
def faster() -> Finding:
    found = v_drying.evaluation()
    pi, pid = found["ts_PI_model"], found["ts_PID_model"]
    poles = [Loop(DRYING, c).rightmost_pole().real for c in (DRYING_PI, drying_pid())]
    return Finding(
        "holds" if pid < pi else "fails",
        pid - pi,
        f"On the model {number(pid)} s against {number(pi)} s. The order agrees with the paper, the times do "
        f"not: both loops have a slow mode ({number(poles[1], 3)} and {number(poles[0], 3)}) next to the zero "
        f"at {number(-1 / 30, 3)}. The paper's times are read from measurements.",
    )


@claims.claim(
    "slower-first", "At the beginning the PID controller is slower, because of the filter.", where="section 4, Figure 7"
)
def slower_first() -> Finding:
    half = [Loop(DRYING, c).step().delay_time(0.5) for c in (DRYING_PI, drying_pid(), drying_pid(0.0))]
    return Finding(
        "holds" if half[1] > half[0] > half[2] else "fails",
        half[1],
        f"Half of the change is reached after {number(half[1])} s, with PI after {number(half[0])} s, and with "
        f"PID without the filter after {number(half[2])} s.",
    )


@claims.claim(
    "drying-load", "PID rejects disturbances of the steam pressure better than PI.", where="section 4, Figures 8 and 9"
)
def drying_load() -> Finding:
    found = v_drying.evaluation()
    ratio = found["ISE_load_PID"] / found["ISE_load_PI"]
    return Finding(
        "holds" if ratio < 1.0 else "fails",
        ratio,
        f"On the model the ISE of a load step is {number(found['ISE_load_PID'])} with PID and "
        f"{number(found['ISE_load_PI'])} with PI, a ratio of {number(ratio, 2)}; the IAE is "
        f"{number(found['IAE_PID'])} against {number(found['IAE_PI'])}.",
    )

"""What paper IV says about its results, held against its own numbers."""

from __future__ import annotations

from replicate.exhibits import Finding
from replicate.exhibits.evidence import number
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.parts_3_to_6.iv_steam_generator import RATIOS
from replicate.papers.panagopoulos.parts_3_to_6.reference_model import step

claims = paper.claims("IV-claims", "Claims of paper IV that its own numbers decide")


def _recommended_settling() -> float:
    return paper.printed_numbers("IV-text")["settling_recommended", "value"]


@claims.claim("all-met", "All of the specifications are met within the range of what is possible.", where="abstract")
def all_met() -> Finding:
    """Compare the achieved numbers of Table 2 with the recommended ones."""
    printed = paper.printed_numbers("IV-table-2")
    times = {column: value for (row, column), value in printed.items() if row == "settling_time"}
    late = [column for column, value in times.items() if value > _recommended_settling()]
    low = printed["delay_margin", "low_step"], printed["delay_margin_recommended", "low_step"]
    return Finding(
        "undecided" if late or low[0] < low[1] else "holds",
        len(late),
        f"By Table 2, {len(late)} of {len(times)} settling times exceed the recommended "
        f"{_recommended_settling():g} s (the longest is {max(times.values()):g} s), and the delay margin at low load, "
        f"{low[0]:g} s, is below the recommended {low[1]:g} s. Whether more was possible cannot be judged without the "
        "plant.",
    )


@claims.claim("most-met", "The controller meets most of the specifications well.", where="sections 4 and 5")
def most_met() -> Finding:
    """Count what Table 2 meets."""
    printed = paper.printed_numbers("IV-table-2")
    met = [value <= _recommended_settling() for (row, _), value in printed.items() if row == "settling_time"]
    met += [
        value >= printed["delay_margin_recommended", column]
        for (row, column), value in printed.items()
        if row == "delay_margin"
    ]
    return Finding(
        "undecided",
        sum(met),
        f"Of the {len(met)} numbers of Table 2 that have a recommendation beside them, {sum(met)} meet it. The "
        "benchmark's other specifications, the limits of the level among them, are not in the paper.",
    )


@claims.claim("little-long", "The settling times at high load are a little long.", where="section 4, Table 2")
def little_long() -> Finding:
    """Compare the settling times at high load with the recommended one."""
    printed = paper.printed_numbers("IV-table-2")
    limit = _recommended_settling()
    times = [printed["settling_time", column] for column in ("high_step", "high_ramp")]
    return Finding(
        "undecided",
        max(times) / limit,
        f"How much is a little is not said. They are {times[0]:g} s and {times[1]:g} s, "
        f"{number(max(times) / limit, 2)} and "
        f"{number(min(times) / limit, 2)} times the recommended {limit:g} s.",
    )


@claims.claim(
    "no-degradation",
    "Actuator saturation and sensor fault are handled with almost no degradation of performance.",
    where="section 5",
)
def no_degradation() -> Finding:
    """Compare the columns of Table 2 with and without sensor fault."""
    printed = paper.printed_numbers("IV-table-2")
    pairs = {
        kind: (printed["settling_time", f"low_{kind}"], printed["settling_time", f"fault_{kind}"])
        for kind in ("step", "ramp")
    }
    worst = max(fault / normal for normal, fault in pairs.values())
    return Finding(
        "undecided" if worst > 1.1 else "holds",
        worst,
        f"The loop stays stable, and the delay margin grows from {printed['delay_margin', 'low_step']:g} to "
        f"{printed['delay_margin', 'fault_step']:g} s. But in Table 2 the sensor fault raises the settling time at low "
        f"load from {pairs['step'][0]:g} to {pairs['step'][1]:g} s for the step and from {pairs['ramp'][0]:g} to "
        f"{pairs['ramp'][1]:g} s for the ramp, and with saturation it is {printed['settling_time', 'sat_up']:g} and "
        f"{printed['settling_time', 'sat_down']:g} s. (The caption says that the results with sensor fault belong to a "
        "simpler model than the others, so the table cannot show what the fault alone does.)",
    )


@claims.claim(
    "fault-invisible",
    "At low load the step responses with and without sensor fault do not differ significantly.",
    where="Figure 6",
)
def fault_invisible() -> Finding:
    """Compare the two settling times that belong to the responses of Figure 6."""
    printed = paper.printed_numbers("IV-table-2")
    normal, fault = printed["settling_time", "low_step"], printed["settling_time", "fault_step"]
    start = paper.printed_numbers("IV-text")["t_fault", "value"]
    return Finding(
        "undecided" if fault > 2.0 * normal else "holds",
        fault / normal,
        f"The fault occurs at {start:g} s, and the text sees no difference for another 20 s. The settling times in "
        f"Table 2, {normal:g} s and {fault:g} s, suggest one later (though they were found on two different models).",
    )


@claims.claim("quarter", "$T_d \\approx T_i/4$.", where="section 3", printed="0.25")
def quarter() -> Finding:
    """Compare the printed derivative and integral times."""
    printed = paper.printed_numbers("IV-table-1")
    shares = {load: printed["Td", load] / printed["Ti", load] for load in ("high_load", "low_load")}
    return Finding(
        "undecided",
        shares["high_load"],
        f"“About” names no limit. $T_d/T_i$ is {number(shares['high_load'], 3)} at high and "
        f"{number(shares['low_load'], 3)} at low load. With "
        "$T_d$ below $T_i/4$ the controller's zeros are real.",
    )


@claims.claim("ti-80-25", "Feedback of $N_{gl}$ lets $T_i$ fall from 80 s to 25 s at low load.", where="section 2")
def ti_80_25() -> Finding:
    """Compare the text with Table 1."""
    printed = paper.printed_numbers("IV-table-1")
    pair = printed["Ti", "fault_low_load"], printed["Ti", "low_load"]
    return Finding(
        "holds" if pair == (80.0, 25.0) else "fails",
        pair[0],
        f"Table 1 says the same: {pair[0]:g} s when the sensor fails at low load (and $K_2 = 0$), {pair[1]:g} s "
        "otherwise. Whether the loop allows it cannot be checked.",
    )


@claims.claim("settles-to-zero", "The reference model is of second order and settles to zero.", where="section 2")
def settles_to_zero() -> Finding:
    """Evaluate the step response late."""
    late = max(float(step(ratio, 400.0 * max(1.0, ratio))) for ratio in RATIOS)
    return Finding(
        "holds" if late < 1e-12 else "fails",
        round(late, 12),
        "The factor $s$ in its numerator makes the final value of the step response zero. The area under it is always "
        "$2\\tau_e$: the integral of the level's deviation that is hidden from the controller.",
    )

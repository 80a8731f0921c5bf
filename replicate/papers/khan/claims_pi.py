"""The checkable sentences of section III: PI control."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.special import lambertw

from replicate.exhibits import ClaimVerdict, Finding
from replicate.exhibits.extrema import largest
from replicate.exhibits.matching import meets
from replicate.loops import PI, Loop
from replicate.papers.khan import paper
from replicate.papers.khan.bryant import gain_for_damping
from replicate.papers.khan.claims import claims
from replicate.papers.khan.fits import rise_time_fit
from replicate.papers.khan.processes import NAMES, PRINTED, RESTORED, gains, loop, plant, settling_after_load
from replicate.papers.khan.robustness import smallest
from replicate.papers.khan.sweep import stability_limit, sweep
from replicate.papers.khan.tables import RULES_1, RULES_2


@claims.claim(
    "steady-error", "PI control leaves no steady-state error for step references and loads.", where="Section III-A"
)
def no_steady_error() -> Finding:
    closed = loop("Proposed", 1.0, 1.0)
    value = max(abs(float(closed.step()(closed.horizon())) - 1.0), abs(float(closed.load_step()(closed.horizon()))))
    return Finding(
        "holds" if value < 1e-9 else "fails",
        value,
        f"Largest remaining deviation of rule (7) at $ph = 1$: {value:.0e}.",
    )


@claims.claim("bryant-damping", "Bryant's constants 0.368, 0.403 and 1.571 belong to damping 1.0, 0.6 and 0.0.",
              where="Section III-B", printed="0.6")  # fmt: skip
def bryant_damping() -> Finding:
    def damping(kh: float) -> float:
        pole = complex(lambertw(-kh, 0))
        return -pole.real / abs(pole)

    ends = round(float(np.exp(-1.0)), 3) == 0.368 and round(stability_limit(0.0), 3) == 1.571
    true = damping(0.403)
    gain = gain_for_damping(0.6)
    return Finding(
        "holds-partly" if ends and abs(true - 0.6) > 0.05 else "holds" if ends else "fails",
        true,
        f"0.368 is $1/e$, where the damping ratio leaves 1 (double pole), and 1.571 is $\\pi/2$, the stability limit. "
        f"But $Kh = 0.403$ has a dominant damping ratio of {true:.3f}; 0.6 needs $Kh = {gain:.4f}$.",
    )


@claims.claim("haalman", "Haalman's $2/3$ minimises the mean square error for a set-point step.", where="Section III-B",
              )  # fmt: skip
def haalman() -> Finding:
    # ISE of (K/s) e^{-s}: cos K / (2 K (1 - sin K)) is the delayed integrator's; its minimum is at K = cos K
    best = brentq(lambda k: k - np.cos(k), 0.5, 1.0)

    def ise(k: float) -> float:
        return Loop(plant(0.0, 1.0), PI(k)).step().ise()

    loss = ise(2.0 / 3.0) / ise(best) - 1.0
    return Finding(
        "holds" if abs(best - 2.0 / 3.0) < 0.005 else "fails",
        best,
        f"The integral of the squared error of the cancelled loop is smallest at $Kh = \\cos Kh = {best:.6f}$; $2/3$ "
        f"gives {100 * loss:.2f} % more.",
    )


@claims.claim(
    "small-overshoot", "The overshoot of rule (7) is almost always below 1 %.", where="Section III-C", printed="1"
)
def small_overshoot() -> Finding:
    def overshoot(ph: float) -> float:
        return 100.0 * loop("Proposed", 1.0, ph, RESTORED).step().overshoot()

    at, highest = largest(overshoot, np.geomspace(0.01, 20.0, 61))
    return Finding("holds" if highest < 1.0 else "fails", highest,
                   f"For $0.01 \\le ph \\le 20$ the largest overshoot is {highest:.4f} %, at $ph = {at:.3f}$: "
                   "always, not almost always.")  # fmt: skip


@claims.claim(
    "gain-margin",
    "For $0.01 \\le ph \\le 20$ the gain margin of rule (7) is above 2.5.",
    where="Section III-C",
    printed="2.5",
)
def gain_margin() -> Finding:
    at, lowest = smallest(lambda closed: closed.margins().gain, RESTORED)
    printed = smallest(lambda closed: closed.margins().gain, PRINTED)[1]
    return Finding(
        "holds" if lowest > 2.5 else "fails",
        lowest,
        f"The smallest is {lowest:.4f}, at $ph = {at:.4g}$ (with (7a) as printed: {printed:.4f}).",
    )


@claims.claim("phase-margin", "For $0.01 \\le ph \\le 20$ its phase margin is above 60 degrees.", where="Section III-C",
              printed="60")  # fmt: skip
def phase_margin() -> Finding:
    lowest = smallest(lambda closed: closed.margins().phase, RESTORED)[1]
    return Finding("holds" if lowest > 60.0 else "fails", lowest, f"The smallest is {lowest:.2f} degrees.")


@claims.claim("sensitivity", "For $0.01 \\le ph \\le 20$ the sensitivity peak of rule (7) is between 1.3 and 2.0.",
              where="Section III-C")  # fmt: skip
def sensitivity() -> Finding:
    low = smallest(lambda closed: float(closed.sensitivity_peak()), RESTORED)[1]
    high = -smallest(lambda closed: -float(closed.sensitivity_peak()), RESTORED)[1]
    return Finding("holds" if low > 1.3 and high < 2.0 else "fails", high, f"It lies between {low:.4f} and {high:.4f}.")


@claims.claim("margin-from-Ms", "The gain margin is greater than $M_s/(M_s - 1)$.", where="Section III-A")
def margin_from_sensitivity() -> Finding:
    def excess(closed: Loop) -> float:
        ms = float(closed.sensitivity_peak())
        return closed.margins().gain - ms / (ms - 1.0)

    at, least = smallest(excess, RESTORED)
    return Finding(
        "holds" if least > 0.0 else "fails",
        least,
        f"For rule (7), $0.01 \\le ph \\le 20$, the gain margin exceeds it by at least {least:.3f}, "
        f"at $ph = {at:.4g}$.",
    )


@claims.claim("eleven-rules", "None of eleven usual rules guarantees both margins for such a range of $ph$.",
              where="Section III-C")  # fmt: skip
def other_rules() -> Finding:
    worst = [loop("Bryant", 1.0, h).margins() for h in (0.01, 1.0, 20.0)]
    gain, phase = min(m.gain for m in worst), min(m.phase for m in worst)
    return Finding(
        "undecided",
        gain,
        "The eleven rules are those of another paper and not in this one. Such margins are nothing special, though: "
        f"Bryant's rule, in this paper's own tables, has a gain margin of {gain:.3f} and a phase margin of "
        f"{phase:.1f} degrees for every $ph$.",
    )


@claims.claim(
    "itae-integral",
    "The integral gains of (7) correspond very closely to the ITAE rule for $0.3 \\le ph \\le 1$.",
    where="Section III-C",
)
def itae_integral() -> Finding:
    ph = np.linspace(0.3, 1.0, 71)
    pairs = [(gains("Proposed", 1.0, float(x)), gains("ITAE", 1.0, float(x))) for x in ph]
    ki = [ours[1] / itae[1] for ours, itae in pairs]
    li = [ours[1] / ours[0] / (itae[1] / itae[0]) for ours, itae in pairs]
    return Finding(
        "holds" if _close(ki) else "holds-partly" if _close(li) else "fails",
        min(ki),
        f"$K_I$ of (7) is {min(ki):.3f} to {max(ki):.3f} of the ITAE value. What agrees is $L_I = K_I/K_P$: "
        f"{min(li):.3f} to {max(li):.3f}.",
    )


def _close(ratios: list[float]) -> bool:
    """Whether gains agree within five per cent."""
    return min(ratios) > 0.95 and max(ratios) < 1.05


@claims.claim("proportional-lower", "The proportional gains of (7) are usually lower than those of ITAE, more "
                                    "so for small $ph$.",
              where="Section III-C")  # fmt: skip
def proportional_lower() -> Finding:
    ph = np.linspace(0.3, 1.0, 71)
    ratio = np.array([gains("Proposed", 1.0, float(x))[0] / gains("ITAE", 1.0, float(x))[0] for x in ph])
    below = gains("Proposed", 1.0, 0.1, RESTORED)[0] / gains("ITAE", 1.0, 0.1)[0]
    verdict: ClaimVerdict = "holds" if ratio.max() < 1.0 and np.all(np.diff(ratio) > 0.0) else "fails"
    return Finding(
        verdict,
        float(ratio[0]),
        f"The ratio rises from {ratio[0]:.3f} at $ph = 0.3$ to {ratio[-1]:.3f} at $ph = 1$. Below that range it does "
        f"not keep falling: it is {below:.3f} at $ph = 0.1$.",
    )


@dataclass(frozen=True)
class Ranking:
    """How fast rule (7) settles among the rules of a table: its places and the evidence in words."""

    setpoint: int
    load: int
    settling_time: float
    evidence: str


def _ranking(rules: tuple[str, ...], h: float) -> Ranking:
    loops = {rule: loop(rule, 1.0, h, RESTORED) for rule in rules}
    ts = {rule: closed.step().settling_time() for rule, closed in loops.items()}
    td = {rule: settling_after_load(closed, None) for rule, closed in loops.items()}
    places, texts = [], []
    for name, times in (("set-point", ts), ("load", td)):
        order = sorted(times, key=times.__getitem__)
        places.append(order.index("Proposed") + 1)
        first, own = f"{NAMES.get(order[0], order[0])} in {times[order[0]]:.4g} s", f"{times['Proposed']:.4g} s"
        texts.append(
            f"After the {name} step rule (7) is the fastest of {len(order)}, in {own}"
            if places[-1] == 1
            else f"After the {name} step rule (7) is number {places[-1]} of {len(order)}, in {own}; first is {first}"
        )
    return Ranking(places[0], places[1], ts["Proposed"], ". ".join(texts) + ".")


@claims.claim("superior-ph10", "At $ph = 10$ rule (7) settles faster than the other rules, for set-point and load.",
              where="Section III-C")  # fmt: skip
def superior_large() -> Finding:
    found = _ranking(RULES_1, 10.0)
    both = found.setpoint == found.load == 1
    return Finding("holds" if both else "fails", found.settling_time, found.evidence)


@claims.claim("outstanding-ph1", "At $ph = 1$ rule (7) still gives outstanding performance.", where="Section III-C")
def outstanding_medium() -> Finding:
    found = _ranking(RULES_2, 1.0)
    both = found.setpoint == found.load == 1
    verdict: ClaimVerdict = "holds" if both else "holds-partly" if found.setpoint <= 2 else "fails"
    return Finding(verdict, found.settling_time, found.evidence)


@claims.claim("slower-ph0.1", "At $ph = 0.1$ rule (7) still settles well on the set-point, and is slower on the load.",
              where="Section III-C")  # fmt: skip
def small_dead_time() -> Finding:
    found = _ranking(RULES_2, 0.1)
    holds = found.setpoint == 1 and found.load > 1
    return Finding("holds" if holds else "fails", found.settling_time, found.evidence)


@claims.claim(
    "td-text", "At $ph = 10$ the load settling time of rule (7) is $t_d = 37.4$.", where="Section III-C", printed="37.4"
)
def td_of_the_text() -> Finding:
    value = settling_after_load(loop("Proposed", 1.0, 10.0), 100.0)
    table = paper.printed_cells("table-1")["Proposed", "td"]
    right = meets(table, value)
    one_digit = sum(a != b for a, b in zip("37.4", table, strict=True)) == 1
    return Finding(
        "holds" if meets("37.4", value) else "undecided" if right and one_digit else "fails",
        value,
        f"It is {value:.3f}: Table I prints {table}, which is {'right' if right else 'wrong as well'}. "
        f"{'One digit of the text is wrong, in the paper or in the copy at hand.' if right and one_digit else ''}",
    )


@claims.claim("five-percent", "With $K = 0.28$ the overshoot is about 5 % and the rise time is estimated, too.",
              where="Example 3.1", printed="5")  # fmt: skip
def five_percent() -> Finding:
    exact = sweep(0.0, np.array([0.28 * 1.82]))
    value = float(exact.overshoot[0])
    fit, rise = float(rise_time_fit(0.0, 0.28 * 1.82)), float(exact.rise_time[0])
    return Finding(
        "holds-partly" if meets("5", value) else "fails",  # partly at best: p = 0 is outside the range of (3)
        value,
        f"The overshoot is {value:.2f} %. But the rise-time fit (3) is given for $ph \\ge 0.5$ only, and the cancelled "
        f"loop has $p = 0$: there (3) would give {fit * 1.82:.3g} s, and the rise time is {rise * 1.82:.3g} s.",
    )

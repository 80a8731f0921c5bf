"""The checkable sentences of section II: proportional control. Those of section III are in `claims_pi`."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import numpy as np
import pandas as pd

from replicate.exhibits import ClaimVerdict, Finding
from replicate.exhibits.extrema import largest
from replicate.loops import PI, Loop
from replicate.papers.khan import paper
from replicate.papers.khan.break_point import double_pole, visible
from replicate.papers.khan.fit_quality import first_peak_quality, overshoot_quality, rise_time_quality
from replicate.papers.khan.processes import plant
from replicate.papers.khan.sweep import first_peak, stability_limit, sweep

claims = paper.claims()


@claims.claim("steady-state", "Under proportional control the output settles at $K/(K+p)$.", where="Section II-A")
def steady_state() -> Finding:
    def deviation(p: float, k: float) -> float:
        closed = Loop(plant(p, 1.0), PI(k))
        end = closed.horizon()
        return abs(float(closed.step(until=end)(end)) - k / (k + p))

    worst = max(deviation(p, k) for p, k in ((1.0, 1.0), (2.0, 1.5), (0.5, 0.8), (0.0, 1.0)))
    return Finding(
        "holds" if worst < 1e-9 else "fails",
        worst,
        f"Largest deviation of four responses, $p = 0$ among them, at the end of their transients: {worst:.0e}.",
    )


@claims.claim("almost-linear", "For large $Kh$ the overshoot is almost linear in $Kh$.", where="Section II-B")
def almost_linear() -> Finding:
    def bend(ph: float) -> float:
        gains = np.linspace(0.4, 0.95, 56) * stability_limit(ph)
        peaks = first_peak(ph, gains)
        line = np.polynomial.Polynomial.fit(gains, peaks, 1)

        def deviation(kh: float) -> float:
            return abs(float(first_peak(ph, np.array([kh]))[0]) - float(line(kh)))

        return largest(deviation, gains, np.abs(peaks - line(gains)))[1]

    bends = {ph: bend(ph) for ph in (0.0, 0.5, 1.0, 2.0, 5.0, 10.0)}
    worst = max(bends, key=bends.__getitem__)
    return Finding(
        "holds" if bends[worst] < 1.0 else "fails",
        bends[worst],
        f"From 0.4 to 0.95 of the stability limit the first peak deviates from a straight line by at most "
        f"{bends[worst]:.2f} points (at $ph = {worst:g}$). In closed form: at $ph = 0$ and $Kh \\ge 1$ it is exactly "
        "$100\\,Kh - 50$.",
    )


@claims.claim(
    "small-ph", "For small $ph$ the overshoot rises more steeply, and from a larger $Kh$.", where="Section II-B"
)
def small_ph() -> Finding:
    values = (0.0, 0.5, 1.0, 2.0, 5.0, 10.0)
    gains = {ph: np.array([0.80, 0.81]) * stability_limit(ph) for ph in values}
    slopes = [float(np.diff(first_peak(ph, kh))[0] / np.diff(kh)[0]) for ph, kh in gains.items()]
    starts = [visible(ph, 0.01) for ph in values]
    falling = all(np.diff(slopes) < 0.0) and all(np.diff(starts) < 0.0)
    return Finding(
        "holds" if falling else "fails",
        slopes[0],
        f"At 0.8 of the stability limit the slope falls from {slopes[0]:.1f} points per unit of $Kh$ at $ph = 0$ to "
        f"{slopes[-1]:.1f} at $ph = 10$; an overshoot of 0.01 % is reached at $Kh = {starts[0]:.3f}$ and "
        f"${starts[-1]:.5f}$.",
    )


@claims.claim("breakpoint", "Overshoot begins at $K_b = 1/(h e^{1+ph})$, where the poles leave the real axis.",
              where="Section II-B")  # fmt: skip
def break_point() -> Finding:
    error = max(abs(double_pole(ph) * np.exp(1.0 + ph) - 1.0) for ph in (0.0, 0.5, 1.0, 2.0, 5.0))
    first = visible(0.0, 0.01)
    verdict: ClaimVerdict = "fails" if error > 1e-9 else "holds" if first < 1.01 * np.exp(-1.0) else "holds-partly"
    return Finding(
        verdict,
        first,
        f"The double pole is where the formula says (largest relative error {error:.0e}). Overshoot starts there in "
        f"principle, but at $ph = 0$ it reaches 0.01 % only at $Kh = {first:.4f}$, against $K_b h = "
        f"{np.exp(-1.0):.4f}$.",
    )


@claims.claim("delay-independent", "The loop is stable independent of delay if and only if $0 < |K| < p$.",
              where="Section II-C")  # fmt: skip
def delay_independent() -> Finding:
    dead_times = (0.1, 1.0, 10.0, 50.0)

    def stable(k: float) -> bool:
        return all(Loop(plant(1.0, h), PI(k)).is_stable() for h in dead_times)

    inside, upper, lower = all(stable(k) for k in (-0.99, -0.5, 0.5, 0.99)), stable(1.0), stable(-1.0)
    margin = stability_limit(200.0) / 200.0
    return Finding(
        "fails" if not inside or margin < 1.0 else "holds-partly" if upper or lower else "holds",
        margin,
        f"Inside the range it is stable, and the limit of $K/p$ tends to 1 from above (it is {margin:.5f} at "
        f"$ph = 200$). But “only if” is not exact: $K = p$ {_is(upper)} stable with dead times of 0.1 to 50, $K = -p$ "
        f"{_is(lower)} (a pole at $s = 0$), and $K = 0$ leaves the stable plant alone. The exact set is "
        "$-p < K \\le p$.",
    )


def _is(stable: bool) -> str:
    return "is" if stable else "is not"


@claims.claim(
    "limit-2-2", "For $p = h = 1$ stability requires $K < 2.26182634$.", where="Example 2.2", printed="2.26182634"
)
def limit() -> Finding:
    value = stability_limit(1.0)
    below, above = (Loop(plant(1.0, 1.0), PI(value * f)).is_stable() for f in (1.0 - 1e-6, 1.0 + 1e-6))
    verdict: ClaimVerdict = "holds" if below and not above else "fails"
    return Finding(verdict, value, f"The limit is {value:.10f}; the last printed digit is one too high.")


@claims.claim("monotone-overshoot", "For fixed $ph$ the overshoot grows monotonically with $Kh$.", where="Example 2.3")
def monotone_overshoot() -> Finding:
    worst = min(
        float(np.min(np.diff(sweep(ph, np.linspace(0.05, 0.99, 90) * stability_limit(ph)).overshoot)))
        for ph in (0.0, 0.5, 1.0, 3.0, 10.0)
    )
    verdict: ClaimVerdict = "holds" if worst >= -1e-9 else "fails"
    return Finding(
        verdict,
        worst,
        f"The smallest step between neighbouring gains, 90 for each of five values of $ph$, is {worst:g} points: it "
        "never falls.",
    )


@claims.claim("monotone-rise", "For fixed $p$ and $h$ the rise time falls as $K$ grows.", where="Sections II-B, III-B")
def monotone_rise() -> Finding:
    worst = max(
        float(np.max(np.diff(sweep(ph, np.linspace(0.05, 0.99, 90) * stability_limit(ph)).rise_time)))
        for ph in (0.0, 0.5, 1.0, 3.0, 10.0)
    )
    verdict: ClaimVerdict = "holds" if worst <= 1e-9 else "fails"
    return Finding(
        verdict,
        worst,
        f"From one of 90 gains to the next, for five values of $ph$, it falls by at least {-worst:.1e} dead times.",
    )


@claims.claim("r2-overshoot", "The overshoot fit (2) has $r^2 = 0.99$ in each of its ranges.", where="Section II-C",
              printed="0.99")  # fmt: skip
def r2_overshoot() -> Finding:
    def cases(frame: pd.DataFrame) -> pd.DataFrame:
        return frame[frame.index.str.startswith("Case")]

    everywhere, first = cases(overshoot_quality()), cases(first_peak_quality())
    lowest = float(everywhere["r2"].min())
    far, near = (str(frame["worst"].abs().idxmax()) for frame in (everywhere, first))
    of_any_peak, of_the_first = abs(_cell(everywhere, far, "worst")), abs(_cell(first, near, "worst"))
    return Finding(
        "holds" if lowest >= 0.99 else "fails",
        lowest,
        f"The lowest $r^2$ of the four cases is {lowest:.5f}. The largest error is {of_any_peak:.1f} points, in {far} "
        f"next to the stability limit, where a later peak is the highest; against the first peak it is "
        f"{of_the_first:.1f} points, in {near} at $ph = {_cell(first, near, 'worst_ph'):.2f}$.",
    )


def _cell(frame: pd.DataFrame, row: str, column: str) -> float:
    return float(frame[column].to_dict()[row])


@claims.claim("r2-rise-time", "The rise-time fit (3) has $r^2 = 0.99$ for $0.5 \\le ph \\le 10$.", where="Section II-C",
              printed="0.99")  # fmt: skip
def r2_rise_time() -> Finding:
    frame = rise_time_quality()
    pooled, single = float(frame["r2"].iloc[0]), frame["r2"].iloc[1:]
    low = single[single < 0.99]
    at = str(single.idxmin())
    return Finding(
        "holds" if low.empty and pooled >= 0.99 else "holds-partly" if pooled >= 0.99 else "fails",
        pooled,
        f"Pooled over all $ph$ it is {pooled:.5f}. For single values it is below 0.99 at "
        f"{', '.join(f'${row}$' for row in low.index)}; lowest at ${at}$, {float(single.min()):.3f}, with an error of "
        f"{abs(_cell(frame, at, 'worst')):.0f} % at small gains.",
    )

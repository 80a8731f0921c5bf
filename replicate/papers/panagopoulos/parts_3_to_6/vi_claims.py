"""The checkable sentences of paper VI on the filters and on the example."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import numpy as np

from replicate.exhibits import Finding
from replicate.exhibits.evidence import listed, number
from replicate.loops import PI, Loop, Plant
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.parts_3_to_6.active_damping import (
    EXAMPLE,
    EXAMPLE_EQ_3,
    K_B,
    PI_GAIN,
    PI_INTEGRAL_TIME,
    ZETA_B,
    allpass,
    bandpass,
    damping_ratio,
)

claims = paper.claims("VI-claims", "Claims made in the text of paper VI")

W = np.geomspace(1e-3, 1e3, 4001)
ROUNDING = 1e-10
DAMPINGS = (0.2, 0.4, 0.6, 0.8)  # Figure 4


def _pi_loop(k_b: float) -> Loop:
    return Loop(EXAMPLE.damped(k_b), PI.from_integral_time(PI_GAIN, PI_INTEGRAL_TIME))


@claims.claim("allpass", "$F_a$ changes only the phase, at all frequencies.", where="“The New Approach”, Figure 4")
def all_pass() -> Finding:
    num, den = allpass(EXAMPLE.omega_a, 0.5)
    off = float(np.max(np.abs(np.abs(np.polyval(num, 1j * W) / np.polyval(den, 1j * W)) - 1.0)))
    return Finding(
        "holds" if off < ROUNDING else "fails", round(off, 12), "$|F_a|$ is one for every frequency and damping."
    )


@claims.claim("bandpass", "$F_b$ has no phase at its centre frequency.", where="“The New Approach”, Figure 4")
def band_pass() -> Finding:
    num, den = bandpass(EXAMPLE.omega_p, ZETA_B, 1.0)
    w = EXAMPLE.omega_p * np.array([0.9, 1.0, 1.1])
    phase = np.degrees(np.angle(np.polyval(num, 1j * w) / np.polyval(den, 1j * w)))
    return Finding(
        "holds" if abs(phase[1]) < 1e-9 else "fails",
        round(float(phase[1]), 9) + 0.0,
        f"There it is exactly zero; 10 % away from it, it is {number(phase[0], 3)} and {number(phase[2], 3)} degrees.",
    )


@claims.claim(
    "zeta-a-rate",
    "$\\zeta_a$ determines how fast the phase of $F_a$ falls.",
    where="“The Allpass Filter Design”, Figure 4",
)
def zeta_a_rate() -> Finding:
    slopes = {}
    for zeta in DAMPINGS:
        w = 1.0 + np.array([-1e-6, 1e-6])
        num, den = allpass(1.0, zeta)
        below, above = np.polyval(num, 1j * w) / np.polyval(den, 1j * w)
        slopes[f"$\\zeta_a = {zeta:g}$"] = -float(np.degrees(np.angle(above / below)) / 2e-6 * np.log(10.0))
    values = list(slopes.values())
    return Finding(
        "holds" if values == sorted(values, reverse=True) and values[-1] > 0.0 else "fails",
        values[0],
        f"At its centre the phase falls by {listed(slopes)} degrees per decade, in inverse proportion to $\\zeta_a$.",
    )


@claims.claim("zeta-b-width", "A small $\\zeta_b$ gives a narrow band.", where="“The Bandpass Filter Design”, Figure 4")
def zeta_b_width() -> Finding:
    widths = {}
    for zeta in DAMPINGS:
        # |F_b|^2 is half its top where w^2 -+ 2 zeta w - 1 = 0
        edges = [float(np.max(np.roots([1.0, sign * 2.0 * zeta, -1.0]).real)) for sign in (-1.0, 1.0)]
        num, den = bandpass(1.0, zeta, 1.0)
        s = 1j * np.array([1.0, *edges])
        size = np.abs(np.polyval(num, s) / np.polyval(den, s))
        half_power = np.allclose(size[1:] * np.sqrt(2.0), size[0], rtol=ROUNDING)
        widths[f"$\\zeta_b = {zeta:g}$"] = edges[0] - edges[1] if half_power else np.nan
    values = list(widths.values())
    return Finding(
        "holds" if values == sorted(values) else "fails",
        values[0],
        f"The band in which $|F_b|^2$ is above half its top has the width {listed(widths, 2)}, in units of "
        "$\\omega_b$: it is $2\\zeta_b$.",
    )


@claims.claim(
    "phase",
    "The choice of $\\omega_a$ makes the phase of $PF$ at $\\omega_p$ equal to $-360°$.",
    where="(4)",
    printed="-360",
)
def phase() -> Finding:
    w = np.geomspace(1e-4, EXAMPLE.omega_p, 20_001)
    num, den = allpass(EXAMPLE.omega_a, 0.5)
    values = EXAMPLE.plant(1j * w) * np.polyval(num, 1j * w) / np.polyval(den, 1j * w)
    angle = float(np.degrees(np.unwrap(np.angle(values)))[-1])
    return Finding(
        "holds" if abs(angle + 360.0) < 1e-8 else "fails",
        round(angle, 9),
        f"Followed from zero frequency, $\\arg P + \\arg F_a$ arrives at {number(angle, 9)}° for $\\omega_a$ = "
        f"{number(EXAMPLE.omega_a, 6)}. The inner loop is $P/(1+PF)$, so this is the phase that weakens the "
        "output most.",
    )


@claims.claim(
    "half", "The filter reduces the gain at the resonance at the most to half of $P_{max}$.", where="(8)", printed="0.5"
)
def half() -> Finding:
    s = 1j * EXAMPLE.omega_p
    gains = {k_b: float(abs(EXAMPLE.damped(k_b)(s))) / EXAMPLE.p_max for k_b in (1.0, K_B)}
    return Finding(
        "holds" if abs(gains[1.0] - 0.5) < ROUNDING else "fails",
        gains[1.0],
        f"With (6) the gain at $\\omega_p$ is {number(gains[1.0])} of $P_{{max}}$: (8) is an equality there, "
        f"because $PF = 1$ is real. With the refined (9) it is $1/(1+k_b)$ = {number(gains[K_B])} in the "
        "example, below the “bound”, which assumes $k_b = 1$.",
    )


@claims.claim("fb-at-resonance", "$|F_b(i\\omega_p)| = K_b/2\\zeta_b = 1/P_{max}$.", where="above (8)")
def fb_at_resonance() -> Finding:
    gain = EXAMPLE.band_gain(1.0)
    value = gain / (2.0 * ZETA_B)
    return Finding(
        "undecided" if abs(value / EXAMPLE.omega_p * EXAMPLE.p_max - 1.0) < ROUNDING else "fails",
        value,
        f"$\\omega_p$ is missing, in the paper or in the copy at hand: $K_b/2\\zeta_b$ = {number(value)}, "
        "$1/P_{max}$ = "
        f"{number(1.0 / EXAMPLE.p_max)}, and $K_b/(2\\zeta_b\\omega_p)$ = {number(value / EXAMPLE.omega_p)}. "
        "(6) has it, and (8) does not need it.",
    )


@claims.claim(
    "structure", "The flexible shaft has the structure (3).", where="“Design of the Active Control System”, “Example”"
)
def structure() -> Finding:
    pi = PI.from_integral_time(PI_GAIN, PI_INTEGRAL_TIME)
    loop = Loop(EXAMPLE_EQ_3.plant, pi)
    return Finding(
        "holds-partly",
        EXAMPLE.gain / EXAMPLE_EQ_3.gain,
        f"Up to its gain: (3) has the numerator $\\omega_p^2$ = {number(EXAMPLE_EQ_3.gain)}, the example $\\kappa$ = "
        f"{number(EXAMPLE.gain)}. All printed numbers belong to $\\kappa$. With $\\omega_p^2$, $P_{{max}}$ "
        f"would be {number(EXAMPLE_EQ_3.p_max)}, and the PI loop without active control would be "
        f"{'stable' if loop.is_stable() else 'unstable'}. $PF$ does not depend on the numerator.",
    )


@claims.claim("notch", "A notch filter gives the mode no additional damping when a load excites it.", where="Figure 1")
def notch() -> Finding:
    mode = [1.0, 2.0 * EXAMPLE.zeta_p * EXAMPLE.omega_p, EXAMPLE.omega_p**2]
    broad = [1.0, 2.0 * EXAMPLE.omega_p, EXAMPLE.omega_p**2]
    plant = Plant(np.polymul(EXAMPLE.plant.num, mode), np.polymul(EXAMPLE.plant.den, broad))
    pi = PI.from_integral_time(PI_GAIN, PI_INTEGRAL_TIME)
    zeta = damping_ratio(Loop(plant, pi).poles(6))
    damped = damping_ratio(_pi_loop(K_B).poles(6))
    return Finding(
        "holds" if abs(zeta / EXAMPLE.zeta_p - 1.0) < 1e-6 else "fails",
        zeta,
        "With a notch that cancels the mode and the example's PI controller, the closed loop keeps a mode of damping "
        f"{number(zeta)}, the process's own; with active control the smallest damping is {number(damped)}.",
    )


@claims.claim("zeta-a", "The performance is quite insensitive to $\\zeta_a$.", where="“The Allpass Filter Design”")
def zeta_a() -> Finding:
    found = {zeta: damping_ratio(EXAMPLE.damped(K_B, zeta_a=zeta).poles()) for zeta in (0.2, 0.3, 0.5, 0.8, 1.2)}
    inner = [found[zeta] for zeta in (0.3, 0.5, 0.8)]
    return Finding(
        "holds" if max(inner) < 1.2 * min(inner) else "fails",
        max(inner) / min(inner),
        "In the example the smallest damping ratio of the inner loop is "
        f"{', '.join(f'{number(value, 3)} (for {zeta:g})' for zeta, value in found.items())}; the chosen 0.5 is the "
        "best of them.",
    )


@claims.claim("zeta-b", "Relatively large values of $\\zeta_b$ perform best.", where="“The Bandpass Filter Design”")
def zeta_b() -> Finding:
    found = {zeta: damping_ratio(EXAMPLE.damped(K_B, zeta_b=zeta).poles()) for zeta in (0.1, 0.3, 0.6, 0.9, 1.5)}
    return Finding(
        "holds" if found[0.9] > 0.95 * max(found.values()) else "fails",
        found[0.9],
        "In the example the smallest damping ratio of the inner loop is "
        f"{', '.join(f'{number(value, 3)} (for {zeta:g})' for zeta, value in found.items())}: flat from about 0.6 on.",
    )


@claims.claim("improves-pulse", "Active control improves the response to a pulse.", where="“Example”, Figure 7")
def improves_pulse() -> Finding:
    before, after = (damping_ratio(EXAMPLE.damped(k).poles()) for k in (0.0, K_B))
    return Finding(
        "holds" if after > before else "fails",
        after,
        f"The smallest damping ratio rises from {number(before, 3)} to {number(after, 3)}. The inner loop is "
        f"stable up to $k_b$ = {number(EXAMPLE.largest_stable_gain())}.",
    )


@claims.claim(
    "improves-loop",
    "With active control the closed loop with the PI controller is well damped.",
    where="“Example”, Figure 8",
)
def improves_loop() -> Finding:
    loops = [_pi_loop(k) for k in (0.0, K_B)]
    zeta = [damping_ratio(loop.poles(6)) for loop in loops]
    ms = [loop.sensitivity_peak().value for loop in loops]
    return Finding(
        "holds" if ms[1] < 1.4 and zeta[1] > 10.0 * zeta[0] else "holds-partly",
        ms[1],
        f"$M_s$ falls from {number(ms[0])} to {number(ms[1])}, and the smallest damping ratio rises from "
        f"{number(zeta[0], 2)} to {number(zeta[1], 3)}. Both loops are stable.",
    )

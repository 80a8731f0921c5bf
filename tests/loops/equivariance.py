"""Random loops, and the same loops counted in other units: what must then be equal, and by how much it is not.

With time counted in units 1/a of the old one, G(s) becomes G(s/a) and L becomes a L; with the gain of the plant in
units 1/c, G becomes c G and the controller's gains are divided by c. Nothing that has no unit may change.

Run as a program to try many: ``python tests/loops/equivariance.py 1000``.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from replicate.loops import PID, Loop, LoopError, Plant, design_pi

Array = NDArray[np.float64]

TIMES = np.array([0.3, 0.9, 1.7, 3.1, 6.3, 11.9])  # in units of the horizon / 12


@dataclass(frozen=True)
class Case:
    """A loop whose numbers are of the order of one, and the units in which it is tried."""

    num: Array
    den: Array
    dead_time: float
    gains: tuple[float, float, float]
    derivative_filter: float
    measurement_filter: float
    b: float
    time: float
    gain: float

    def loop(self, time: float = 1.0, gain: float = 1.0) -> Loop:
        """Return the loop with its time multiplied by ``time`` and the plant's gain by ``gain``."""
        k, ki, kd = self.gains
        return Loop(
            self.plant(time, gain),
            PID(
                k / gain, ki / gain / time, kd / gain * time, b=self.b,
                derivative_filter=self.derivative_filter * time, measurement_filter=self.measurement_filter * time,
            ),
        )  # fmt: skip

    def plant(self, time: float = 1.0, gain: float = 1.0) -> Plant:
        """Return the plant alone."""
        powers = time ** np.arange(self.den.size - 1, -1, -1.0)
        return Plant(self.num * gain * powers[-self.num.size :], self.den * powers, self.dead_time * time)


def cases(count: int, seed: int = 16) -> Iterator[Case]:
    """Yield stable loops of orders 0 to 5, with and without dead time, integrators, resonances and filters."""
    random = np.random.default_rng(seed)
    found = 0
    while found < count:
        order = int(random.integers(0, 6))
        poles: list[complex] = []
        while len(poles) < order:
            size = 10.0 ** random.uniform(-1.0, 1.0)
            if random.random() < 0.25 and len(poles) + 2 <= order:
                angle = random.uniform(0.55, 0.95) * np.pi
                poles += [size * np.exp(1j * angle), size * np.exp(-1j * angle)]
            else:
                poles.append(0.0 if random.random() < 0.12 and 0.0 not in poles else -size)
        den = np.real(np.poly(poles)) if poles else np.ones(1)
        zeros = [-(10.0 ** random.uniform(-1.0, 1.0)) * random.choice([1.0, 1.0, -1.0]) for _ in range(order // 3)]
        num = np.atleast_1d(np.real(np.poly(zeros))) if zeros else np.ones(1)
        num = num / (num[-1] if den[-1] == 0.0 else num[-1] / den[-1])
        dead_time = 0.0 if random.random() < 0.2 else 10.0 ** random.uniform(-1.5, 1.0)
        if order == 0 and not dead_time:
            continue
        pace = sum(1.0 / abs(p) for p in poles if p) + dead_time
        if not pace:
            continue
        k = random.uniform(0.05, 0.8)
        ki = k * random.uniform(0.1, 1.0) / pace
        kd = k * pace * random.uniform(0.02, 0.1) if random.random() < 0.4 else 0.0
        case = Case(
            num, den, dead_time, (k, ki, kd), 0.05 * pace if kd else 0.0,
            0.03 * pace if random.random() < 0.3 else 0.0, random.uniform(0.0, 1.0),
            10.0 ** random.uniform(-12.0, 12.0), 10.0 ** random.uniform(-9.0, 9.0),
        )  # fmt: skip
        if case.loop().is_stable() and case.loop().sensitivity_peak() < 20.0:
            found += 1
            yield case


def differences(case: Case) -> dict[str, float]:
    """Return by how much each quantity differs between the two forms of a loop, relative to its size."""
    plain, other = case.loop(), case.loop(case.time, case.gain)
    time, gain = case.time, case.gain
    horizon = plain.horizon()
    t = TIMES * horizon / 12.0
    one, two = plain.respond(load=0.5), other.respond(load=0.5 / gain)
    y, z = one.output, two.output
    size_u = float(np.max(np.abs(one.control(t))))
    found = {
        "horizon": abs(other.horizon() / time / horizon - 1.0),
        "output": float(np.max(np.abs(y(t) - z(t * time)))),
        "control": float(np.max(np.abs(one.control(t) - two.control(t * time) * gain))) / size_u,
        "settling time": abs(z.settling_time() / time / y.settling_time() - 1.0),
        "iae": abs(z.iae() / time / y.iae() - 1.0),
        "peak": abs(float(z.peak()) - float(y.peak())),
        "Ms": abs(other.sensitivity_peak() / plain.sensitivity_peak() - 1.0),
        "Mp": abs(other.complementary_peak() / plain.complementary_peak() - 1.0),
        "pole": abs(other.rightmost_pole() * time / plain.rightmost_pole() - 1.0),
    }
    first, second = plain.margins(), other.margins()
    for name, scale in (("gain", 1.0), ("phase", 1.0), ("delay", time), ("gain_crossover", 1.0 / time)):
        a, b = getattr(first, name), getattr(second, name) / scale
        found[name] = 0.0 if a == b or (np.isnan(a) and np.isnan(b)) else abs(b / a - 1.0)
    return found


def design_differences(case: Case) -> dict[str, float]:
    """Return by how much the PI designs of the two forms of a plant differ."""
    plain, other = design_pi(case.plant(), ms=1.6), design_pi(case.plant(case.time, case.gain), ms=1.6)
    if plain.status != other.status:
        return {"status": 1.0}
    if plain.status != "optimal":
        return {}
    return {
        "k": abs(other.k * case.gain - plain.k) / (abs(plain.k) + plain.ki / plain.frequency),
        "ki": abs(other.ki * case.gain * case.time / plain.ki - 1.0),
    }


def main(count: int) -> int:
    """Try many loops and print what differs; return how many do."""
    worst: dict[str, float] = {}
    failed = 0
    for number, case in enumerate(cases(count)):
        try:
            found = differences(case)
            if number % 10 == 0:
                found |= design_differences(case)
        except LoopError as error:
            sys.stdout.write(f"loop {number}: {error}\n    {case}\n")
            failed += 1
            continue
        worst = {name: max(worst.get(name, 0.0), found.get(name, 0.0)) for name in worst | found}
        wrong = {name: value for name, value in found.items() if not value < 1e-10}
        if wrong:
            failed += 1
            sys.stdout.write(f"loop {number}: {wrong}\n    {case}\n")
    sys.stdout.write(f"{count} loops, {failed} differ; largest relative differences:\n")
    for name, value in worst.items():
        sys.stdout.write(f"    {name:16} {value:.1e}\n")
    return failed


if __name__ == "__main__":
    sys.exit(1 if main(int(sys.argv[1])) else 0)

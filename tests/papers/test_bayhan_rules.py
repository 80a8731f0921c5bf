"""Bayhan, Soylemez, Bostan: the rules of Table 1 against a second transcription."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest

from replicate.papers.bayhan.processes import competing_rules

# ---------------------------------------------------------------------------------------------------- Table 1

# Transcribed a second time: kp = c/K r^p; ti = tau/d r^q, or tau/(d + q r); r = L/tau.
POWER = {
    "ISE": (1.305, -0.959, 0.492, 0.739),
    "IAE": (0.984, -0.986, 0.608, 0.707),
    "ITSE": (1.279, -0.945, 0.535, -0.586),
    "ITAE": (0.859, -0.977, 0.674, 0.68),
}
LINEAR = {
    "IAESPC": (0.758, -0.861, 1.02, -0.323),
    "ITSESPC": (0.712, -0.921, 0.968, -0.247),
    "ITAESPC": (0.586, -0.916, 1.03, -0.165),
}


@pytest.mark.parametrize("r", [0.3, 1.0, 2.2])
def test_printed_rules_against_a_second_transcription(r: float) -> None:
    gain, tau = 1.7, 0.6
    symbols = {"K": gain, "tau": tau, "L": r * tau, "tau_cl": 0.25}
    expected = {
        "ZN": (0.9 / (gain * r), 3 * r * tau),
        "CC": ((0.9 + r / 12) / (gain * r), (3.33 * r + 0.33 * r * r) / (1 + 2.2 * r) / gain),
        "IMC": (tau / gain / (0.25 + r * tau), tau),
    }
    expected |= {id: (c / gain * r**p, tau / d * r**q) for id, (c, p, d, q) in POWER.items()}
    expected |= {id: (c / gain * r**p, tau / (d + q * r)) for id, (c, p, d, q) in LINEAR.items()}
    rules = competing_rules()
    assert set(rules) == set(expected)
    for id, (kp, ti) in expected.items():
        found = rules[id].evaluate(**symbols)
        assert [float(found.kp), float(found.ti)] == pytest.approx([kp, ti], rel=1e-14), id


def test_rules_at_exact_fractions() -> None:
    symbols = {"K": Fraction(7, 8), "tau": Fraction(2, 3), "L": Fraction(1, 5), "tau_cl": Fraction(1, 10)}
    assert competing_rules()["IMC"].evaluate(**symbols) == competing_rules("authors")["IMC"].evaluate(**symbols)
    assert competing_rules()["IMC"].evaluate(**symbols).kp == Fraction(2, 3) / (Fraction(7, 8) * Fraction(3, 10))
    assert competing_rules()["ZN"].evaluate(**symbols).ti == Fraction(3, 5)
    # Cohen-Coon with r = L/tau = 3/10: L (30 + 9/10)/(9 + 6) = 103/250.
    assert competing_rules("authors")["CC"].evaluate(**symbols).ti == Fraction(103, 250)


@pytest.mark.parametrize("variant", ["printed", "corrected", "authors"])
def test_integral_times_are_times_once_the_print_is_mended(variant: str) -> None:
    """Measured in other units of time, and with another gain, a rule must give the same controller."""
    symbols = {"K": 2.0, "tau": 0.7, "L": 0.9, "tau_cl": 0.3}
    scaled = {name: value * (5.0 if name == "K" else 60.0) for name, value in symbols.items()}
    wrong = set()
    for id, rule in competing_rules(variant).items():
        here, there = rule.evaluate(**symbols), rule.evaluate(**scaled)
        assert there.kp == pytest.approx(here.kp / 5.0)
        if not math.isclose(there.ti, 60.0 * here.ti):
            wrong.add(id)
    assert wrong == ({"CC"} if variant == "printed" else set())

"""The exact values of hard loops: closed forms among them, and what the measurement makes of them."""

from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path

import mpmath as mp
import pytest

from replicate.loops.conformance import Quantity, digits, goldens, measure
from replicate.loops.conformance.adapters.replicate_loops import library

GOLDENS = {golden.id: golden for golden in goldens()}
QUICK = (
    "foptd-simc", "foptd-critical", "foptd-tiny-delay-1e-5", "foptd-small-delay-slow-loop", "integrator-p-tiny-delay",
    "dead-time-pi", "integrator-p", "lag-3-no-delay", "unstable-limit",
)  # fmt: skip


@pytest.mark.parametrize("name", QUICK)
def test_this_library_gets_nine_digits(name: str) -> None:
    found = measure(library(), GOLDENS[name], "exact")
    assert not {quantity.name: right for quantity, right in found.items() if right is not None and right < 9.0}
    assert None not in found.values()


def test_the_file_holds_its_closed_forms() -> None:
    # L = e^{-s}/(2s): poles W_k(-1/2) and the cancelled -1; margins pi and 90 degrees - 1/2
    simc = GOLDENS["foptd-simc"].record
    assert complex(simc["poles"][0]["re"], simc["poles"][0]["im"]) == complex(mp.lambertw(-0.5))
    assert (simc["poles"][1]["re"], simc["poles"][1]["multiplicity"]) == (-1.0, 1)
    assert simc["gain_margin"]["value"] == math.pi
    assert simc["phase_margin"]["value"] == pytest.approx(90 - math.degrees(0.5), rel=1e-15)
    assert GOLDENS["foptd-critical"].record["poles"][0] == {"re": -1.0, "im": 0.0, "multiplicity": 3}
    assert GOLDENS["unstable-limit"].record["poles"][0]["re"] == pytest.approx(mp.lambertw(-2).real, rel=1e-15)
    # e^{-1e-6 s}/s: margins pi/2 / 1e-6 and pi/2 - 1e-6, however far apart
    tiny = GOLDENS["integrator-p-tiny-delay"].record
    assert tiny["gain_margin"]["value"] == pytest.approx(math.pi / 2e-6, rel=1e-15)
    assert tiny["delay_margin"]["value"] == pytest.approx(math.pi / 2 - 1e-6, rel=1e-15)
    # e^{-s}/s under k: y = k (t - 1) until t = 2
    integrator = GOLDENS["integrator-p"].record
    assert integrator["responses"]["step"][0] == 0.25
    assert integrator["responses"]["load_step"][0] == 0.5


def test_the_generator_makes_the_file_again() -> None:
    # a few that take seconds; `make goldens ARGS=--check` tries all
    made = subprocess.run(
        [sys.executable, "tools/goldens/make.py", "--check", "integrator-p", "foptd-p", "lag-2-critical"],
        cwd=Path(__file__).parents[2], capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert made.stdout.count("as in the file") == 3, made.stdout + made.stderr
    assert made.returncode == 0


def test_every_loop_says_what_it_is_and_where_it_comes_from() -> None:
    assert len(GOLDENS) >= 55
    for golden in GOLDENS.values():
        assert golden.kind
        assert golden.record["source"]
        assert len(list(golden.quantities())) >= 3


def test_the_digits_of_a_multiple_pole_count_for_its_multiplicity() -> None:
    pole = Quantity("poles", "pole 1", -1.0, 1.0, attainable=5.0)
    assert digits(pole, -1.0 + 1e-5) == pytest.approx(15.0, abs=1e-9)
    assert digits(pole, -1.1) == pytest.approx(3.0, abs=1e-9)
    assert digits(pole, None) == 0.0
    assert digits(Quantity("margins", "gain_margin", None, 1.0), math.inf) == 15.0

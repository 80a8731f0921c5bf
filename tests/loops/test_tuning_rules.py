"""Tuning rules as data: parsing, exactness, variants, and what a damaged file is told."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import pytest

from replicate.loops.errors import TuningRuleError
from replicate.loops.tune import Gains, classical_rules, formula, load_rules

FILE = """
[[rule]]
id = "X"
name = "Example"
source = "[1]"
[rule.printed]
Kp = "2*tau/(K*L)"
Ti = "tau"
Ti_tex = 'T'
[rule.mended]
Ti = "3*L"
why = "a slip"
"""


def write(folder: Path, text: str) -> Path:
    path = folder / "rules.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_formula_follows_the_usual_precedence_and_stays_exact() -> None:
    value = formula("-2**2 + 3*(x - 1)/4")({"x": Fraction(1, 3)})
    assert value == Fraction(-9, 2)


@pytest.mark.parametrize(
    "text", ["", "1 +", "x if y else z", "f(x)", "x.y", "'a'", "True", "x % 2", "~x", "x == 1", "1j"]
)
def test_formula_refuses_everything_but_arithmetic(text: str) -> None:
    with pytest.raises(TuningRuleError):
        formula(text)


def test_a_variant_changes_only_what_it_names(tmp_path: Path) -> None:
    path = write(tmp_path, FILE)
    symbols = {"K": Fraction(2), "L": Fraction(1, 2), "tau": Fraction(3)}
    printed, mended = (load_rules(path, variant)["X"].evaluate(**symbols) for variant in ("printed", "mended"))
    assert (printed.kp, printed.ti, printed.ki) == (6, 3, 2)
    assert (mended.kp, mended.ti, mended.ki) == (6, Fraction(3, 2), 4)
    assert load_rules(path, "mended")["X"].why == "a slip"
    assert load_rules(path)["X"].why == ""
    assert load_rules(path)["X"].tex == {"Ti": "T"}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (FILE + FILE, r"rules\.toml: rule X is given twice"),
        (FILE.replace('Ti = "tau"', ""), r"rules\.toml: rule X: Ti is missing"),
        (
            FILE.replace("2*tau", "2 tau"),
            r"rules\.toml: rule X: '2 tau/\(K\*L\)' is not an arithmetic expression",
        ),
    ],
)
def test_a_damaged_file_is_refused_by_name_and_rule(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(TuningRuleError, match=message):
        load_rules(write(tmp_path, text))


def test_a_missing_parameter_is_named(tmp_path: Path) -> None:
    with pytest.raises(TuningRuleError, match="rule X needs tau; given are K, L"):
        load_rules(write(tmp_path, FILE))["X"].evaluate(K=1.0, L=1.0)


SECOND = """
[[rule]]
id = "Y"
name = "Case of a pair"
holds = { quantity = "p*h", low = 0.01, high = 0.2 }
[rule.printed]
Kp = "p/2"
Ki = "p/h"
[[rule]]
id = "Z"
name = "Borrowed"
[rule.printed]
same_as = "cohen-coon"
[rule.rounded]
same_as = "cohen-coon/decimals-033"
"""


def test_an_integral_gain_may_stand_for_the_integral_time(tmp_path: Path) -> None:
    rule = load_rules(write(tmp_path, SECOND))["Y"]
    gains = rule.evaluate(p=Fraction(2), h=Fraction(1, 3))
    assert (gains.kp, gains.ki, gains.ti) == (1, 6, Fraction(1, 6))
    assert rule.holds is not None
    assert rule.holds.contains(p=0.5, h=0.4)
    assert not rule.holds.contains(p=1.0, h=0.4)


def test_no_integral_action_is_an_infinite_integral_time() -> None:
    gains = Gains.parallel(2.0, 0.0)
    assert (gains.ti, gains.ki) == (float("inf"), 0.0)


def test_a_rule_of_the_literature_is_borrowed_not_copied(tmp_path: Path) -> None:
    path = write(tmp_path, SECOND)
    symbols = {"K": Fraction(3), "L": Fraction(1, 2), "tau": Fraction(2)}
    # Cohen and Coon's fractions at L/tau = 1/4: 0.9 + 1/48 and L (30 + 3/4)/(9 + 5)
    gains = load_rules(path)["Z"].evaluate(**symbols)
    assert float(gains.kp) == pytest.approx((0.9 + 1 / 48) * 4 / 3, rel=1e-15)
    assert gains.ti == Fraction(1, 2) * Fraction(123, 4) / 14
    assert float(load_rules(path, "rounded")["Z"].evaluate(**symbols).kp) == pytest.approx(3.683 / 3, rel=1e-15)


@pytest.mark.parametrize(
    ("reference", "message"),
    [
        ("cohen", r"rule Z: same_as = 'cohen' is not known; allowed: amigo, amigo-integrator, cohen-coon, "),
        ("cohen-coon/x", r"rule Z: same_as = 'cohen-coon/x': cohen-coon has no variant 'x'; allowed: printed, "),
    ],
)
def test_a_wrong_reference_names_what_is_allowed(tmp_path: Path, reference: str, message: str) -> None:
    with pytest.raises(TuningRuleError, match=message):
        load_rules(write(tmp_path, SECOND.replace('"cohen-coon"', f'"{reference}"')))


def test_classical_rules_of_the_literature() -> None:
    """Values of the rules as the textbooks tabulate them, at K = 2, tau = 3, L = 1.5 (ratio 1/2)."""
    symbols = {"K": 2.0, "tau": 3.0, "L": 1.5}
    expected = {
        "ziegler-nichols": (0.9 / 2 * 2, 4.5),
        "cohen-coon": (0.5 * (1.8 + 1 / 12), 1.5 * 31.5 / 19),
        "itae-setpoint": (0.293 * 0.5**-0.916, 3 / (1.03 - 0.0825)),
        "ise-setpoint": (0.49 * 0.5**-0.892, 3 / (0.69 - 0.0775)),
    }
    rules = classical_rules()
    assert set(rules) == set(expected)
    for id, (kp, ti) in expected.items():
        gains = rules[id].evaluate(**symbols)
        assert [float(gains.kp), float(gains.ti)] == pytest.approx([kp, ti], rel=1e-14), id

"""Tuning rules as data: parsing, exactness, variants, and what a damaged file is told."""

from fractions import Fraction
from pathlib import Path

import pytest

from replicate.errors import PaperDefinitionError
from replicate.rules import formula, load_rules

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


def test_formula_follows_the_usual_precedence_and_stays_exact():
    value = formula("-2**2 + 3*(x - 1)/4")({"x": Fraction(1, 3)})
    assert value == Fraction(-9, 2)


@pytest.mark.parametrize(
    "text", ["", "1 +", "x if y else z", "f(x)", "x.y", "'a'", "True", "x % 2", "~x", "x == 1", "1j"]
)
def test_formula_refuses_everything_but_arithmetic(text):
    with pytest.raises(PaperDefinitionError):
        formula(text)


def test_a_variant_changes_only_what_it_names(tmp_path):
    path = write(tmp_path, FILE)
    symbols = {"K": Fraction(2), "L": Fraction(1, 2), "tau": Fraction(3)}
    printed, mended = (
        load_rules(path, variant)["X"].evaluate(**symbols) for variant in ("printed", "mended")
    )
    assert (printed.kp, printed.ti, printed.ki) == (6, 3, 2)
    assert (mended.kp, mended.ti, mended.ki) == (6, Fraction(3, 2), 4)
    assert load_rules(path, "mended")["X"].why == "a slip"
    assert load_rules(path)["X"].why == ""
    assert load_rules(path)["X"].tex == {"Ti": "T"}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (FILE + FILE, r"rules\.toml: rule X is given twice"),
        (FILE.replace('Ti = "tau"', ""), r"rules\.toml: rule X lacks Ti"),
        (
            FILE.replace("2*tau", "2 tau"),
            r"rules\.toml: rule X: '2 tau/\(K\*L\)' is not an arithmetic expression",
        ),
    ],
)
def test_a_damaged_file_is_refused_by_name_and_rule(tmp_path, text, message):
    with pytest.raises(PaperDefinitionError, match=message):
        load_rules(write(tmp_path, text))


def test_a_missing_parameter_is_named(tmp_path):
    with pytest.raises(PaperDefinitionError, match="rule X needs tau; given are K, L"):
        load_rules(write(tmp_path, FILE))["X"].evaluate(K=1.0, L=1.0)

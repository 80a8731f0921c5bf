"""Tuning rules as data: records with formula, range of validity and source, kept in TOML files."""

from replicate.loops.tune.formulas import Formula, Number, formula
from replicate.loops.tune.rule_files import PRINTED, classical_rules, load_rules
from replicate.loops.tune.rules import Gains, Range, TuningRule

__all__ = [
    "PRINTED",
    "Formula",
    "Gains",
    "Number",
    "Range",
    "TuningRule",
    "classical_rules",
    "formula",
    "load_rules",
]

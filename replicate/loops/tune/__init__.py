"""Tuning rules: callable for a plant, and as data, kept in TOML files with formula, range of validity and source."""

from replicate.loops.tune.astrom_hagglund import amigo
from replicate.loops.tune.cards import RULES, RuleCard
from replicate.loops.tune.classical import by_name
from replicate.loops.tune.formulas import Formula, Number, formula, formula_tree
from replicate.loops.tune.lambda_tuning import lambda_
from replicate.loops.tune.margin_specifications import gain_phase_margins
from replicate.loops.tune.models import LagModel, half_rule, lag_model
from replicate.loops.tune.rule_files import PRINTED, classical_rules, first_order_rules, load_rules, marked_rules
from replicate.loops.tune.rules import Gains, Range, TuningRule
from replicate.loops.tune.skogestad import simc
from replicate.loops.tune.ziegler_and_nichols import ultimate, ziegler_nichols

__all__ = [
    "PRINTED",
    "RULES",
    "Formula",
    "Gains",
    "LagModel",
    "Number",
    "Range",
    "RuleCard",
    "TuningRule",
    "amigo",
    "by_name",
    "classical_rules",
    "first_order_rules",
    "formula",
    "formula_tree",
    "gain_phase_margins",
    "half_rule",
    "lag_model",
    "lambda_",
    "load_rules",
    "marked_rules",
    "simc",
    "ultimate",
    "ziegler_nichols",
]

"""Tuning rules read from TOML files.

A rule says how the controller gains follow from the parameters of a process model. Its formulas are
arithmetic expressions, kept as text in a TOML file next to the paper that prints them, so that they can be
proofread against the page; a formula too long for one line may be a Python function instead. A rule may exist
in several *variants*: as the paper prints it, with a printing error mended, as the authors evidently used it.
Rules of the literature that several papers use stand once, in ``classical_rules.toml``; a paper's file refers to them.

```toml
[[rule]]
id = "AMIGO"
name = "AMIGO"
source = "Astrom and Hagglund (2004)"
range = "any dead time"
[rule.printed]
Kp = "0.15/K + (0.35 - L*tau/(L + tau)**2)*tau/(K*L)"
Ti = "0.35*L + 13*L*tau**2/(tau**2 + 12*L*tau + 7*L**2)"
Kp_tex = '...'        # the formula as displayed
[rule.corrected]      # only what differs from the printed form
Ti = "..."
why = "what is wrong in print, and how one knows"
```

In place of ``Ti`` a form may give ``Ki``, the integral gain of the parallel form ``Kp + Ki/s``. In place of formulas it
may say ``same_as = "cohen-coon"``, or ``same_as = "cohen-coon/decimals-033"`` for a variant. A rule that is one case of
a pair says for which processes it was made: ``holds = { quantity = "p*h", low = 0.01, high = 0.2 }``. ``where`` defines
symbols that the formulas use besides the parameters, ``unit`` a factor of the gains.
"""

from __future__ import annotations

import importlib.resources
import tomllib
from collections.abc import Mapping
from functools import cache
from importlib.resources.abc import Traversable
from typing import Any

from replicate.loops.errors import TuningRuleError
from replicate.loops.tune.formulas import formula, formula_tree
from replicate.loops.tune.rules import Range, TuningRule

PRINTED = "printed"
CLASSICAL, FIRST_ORDER = "classical_rules.toml", "first_order_rules.toml"


def load_rules(source: Traversable, variant: str = PRINTED) -> dict[str, TuningRule]:
    """Read the rules of a TOML file, in its order, each in the given variant.

    A rule that does not define the variant, or defines only a part of it, keeps its printed form for the
    rest.

    Parameters
    ----------
    source
        The file; its layout is shown at the top of this module.
    variant
        ``printed`` or another name used in the file.

    Raises
    ------
    TuningRuleError
        If a rule is incomplete, given twice, or a formula cannot be read; the message names file and rule.

    Examples
    --------
    The file of classical rules that comes with the project:

    >>> rules = load_rules(importlib.resources.files("replicate.loops.tune") / "classical_rules.toml")
    >>> rules["ziegler-nichols"].name
    'Ziegler-Nichols, reaction curve, PI'
    """
    rules: dict[str, TuningRule] = {}
    for record in tomllib.loads(source.read_text(encoding="utf-8")).get("rule", []):
        key = record.get("id", "?")
        where = f"{source.name}: rule {key}"
        if key in rules:
            msg = f"{where} is given twice"
            raise TuningRuleError(msg)
        try:
            form = _form(record, variant)
            second = "Ki" if "Ki" in form and "Ti" not in form else "Ti"
            gain, integral = (formula(_required(form | record, name)) for name in ("Kp", second))
            name = _required(record, "name")
            holds = _range(record["holds"]) if "holds" in record else None
        except TuningRuleError as error:
            msg = f"{where}: {error}"
            raise TuningRuleError(msg) from error
        tex = {name: form[f"{name}_tex"] for name in ("Kp", "Ti", "Ki") if f"{name}_tex" in form}
        rules[key] = TuningRule(
            key, name, gain, integral if second == "Ti" else None,
            record.get("source", ""), record.get("range", ""), tex, form.get("why", ""),
            integral_gain=integral if second == "Ki" else None, holds=holds,
            where={symbol: formula(text) for symbol, text in record.get("where", {}).items()},
            unit=formula(record["unit"]) if "unit" in record else None,
        )  # fmt: skip
    return rules


def _form(record: Mapping[str, Any], variant: str) -> dict[str, Any]:
    """Return the strings of one variant, with what a reference to a classical rule stands for."""
    form: dict[str, Any] = {}
    for part in (PRINTED, variant):
        own = record.get(part, {})
        if "same_as" in own:
            id, _, other = own["same_as"].partition("/")
            classical = _classical_forms()
            if id not in classical:
                msg = f"same_as = '{own['same_as']}' is not known; allowed: {', '.join(sorted(classical))}"
                raise TuningRuleError(msg)
            if other and other not in classical[id]:
                variants = ", ".join(key for key, value in classical[id].items() if isinstance(value, dict))
                msg = f"same_as = '{own['same_as']}': {id} has no variant '{other}'; allowed: {variants}"
                raise TuningRuleError(msg)
            own = classical[id][PRINTED] | (classical[id][other] if other else {}) | own
        form |= own
    return form


@cache
def _classical_forms() -> dict[str, dict[str, Any]]:
    return {record["id"]: record for file in (CLASSICAL, FIRST_ORDER) for record in _records(file)}


def _records(name: str) -> list[dict[str, Any]]:
    file = importlib.resources.files("replicate.loops.tune") / name
    records: list[dict[str, Any]] = tomllib.loads(file.read_text(encoding="utf-8"))["rule"]
    return records


def _range(record: Mapping[str, Any]) -> Range:
    quantity, low, high = (_required(record, name) for name in ("quantity", "low", "high"))
    return Range(formula(quantity), float(low), float(high))


def _required(record: Mapping[str, Any], name: str) -> Any:
    if name not in record:
        msg = f"{name} is missing"
        raise TuningRuleError(msg)
    return record[name]


@cache
def classical_rules(variant: str = PRINTED) -> Mapping[str, TuningRule]:
    """Return the rules of the literature that more than one paper uses; symbols ``K``, ``tau``, ``L``.

    Parameters
    ----------
    variant
        Which version of each rule; the printed one where a rule has no such version.

    Examples
    --------
    >>> rule = classical_rules()["ziegler-nichols"]  # 0.9 tau/(K L)
    >>> round(rule.evaluate(K=1.0, tau=2.0, L=0.9).kp, 12)
    2.0
    """
    return load_rules(importlib.resources.files("replicate.loops.tune") / CLASSICAL, variant)


@cache
def first_order_rules() -> Mapping[str, TuningRule]:
    """Return the rules for first-order and integrating processes that several parts of the package use.

    Symbols are ``K``, ``tau``, ``L``; of an integrating process ``K`` and ``L``.

    Examples
    --------
    >>> rule = first_order_rules()["simc-integrator"]  # 1/(K (tau_c + L)) and 4 (tau_c + L)
    >>> gains = rule.evaluate(K=1.0, L=1.0, tau_c=1.0)
    >>> gains.kp, gains.ti
    (0.5, 8.0)
    """
    return load_rules(importlib.resources.files("replicate.loops.tune") / FIRST_ORDER)


def marked_rules() -> list[dict[str, Any]]:
    """Return the rules that a gain plane marks, as data for JSON; a formula is what `formula_tree` returns.

    Each has ``name``, ``process`` (``lag`` or ``integrator``), ``reduces`` (whether the half rule comes first),
    ``where`` (pairs of symbol and formula, in order), ``Kp``, ``Ki``, and for one case of several ``holds``:
    quantity, low, high.

    Examples
    --------
    >>> sorted({rule["process"] for rule in marked_rules()})
    ['integrator', 'lag']
    """
    return [_marked(record) for record in _records(FIRST_ORDER)]


def _marked(record: Mapping[str, Any]) -> dict[str, Any]:
    form = _form(record, record["mark"]["form"])
    scaled = {name: f"({record.get('unit', 1)})*({form[name]})" for name in ("Kp", "Ki") if name in form}
    holds = record.get("holds")
    return {
        "name": record["mark"]["name"],
        "process": record["process"],
        "reduces": record.get("reduces", False),
        "where": [[symbol, formula_tree(text)] for symbol, text in record.get("where", {}).items()],
        "holds": [formula_tree(holds["quantity"]), holds["low"], holds["high"]] if holds else None,
        "Kp": formula_tree(scaled["Kp"]),
        "Ki": formula_tree(scaled.get("Ki") or f"({scaled['Kp']})/({form['Ti']})"),
    }

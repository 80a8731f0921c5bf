"""Tuning rules as data: small records that several papers can share.

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
a pair says for which processes it was made: ``holds = { quantity = "p*h", low = 0.01, high = 0.2 }``.
"""

from __future__ import annotations

import ast
import importlib.resources
import math
import operator
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cache
from importlib.resources.abc import Traversable
from typing import Any

from replicate.errors import PaperDefinitionError

Number = float | Fraction
Formula = Callable[[Mapping[str, Number]], Number]

PRINTED = "printed"
CLASSICAL = "classical_rules.toml"

_OPERATIONS: dict[type[ast.operator], Callable[[Any, Any], Number]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}


def formula(text: str) -> Formula:
    """Parse an arithmetic expression into a function of its symbols.

    Allowed are numbers, names, parentheses, a leading minus and ``+ - * / **``. Integers stay integers, so
    that an expression without decimals is exact for exact (`fractions.Fraction`) arguments.

    Parameters
    ----------
    text
        The expression in Python notation, for example ``"tau/(K*(tau_cl + L))"``.

    Returns
    -------
    Callable
        Takes a mapping from symbol to number and returns the value; a missing symbol raises `KeyError`.

    Raises
    ------
    PaperDefinitionError
        If the text is not such an expression.

    Examples
    --------
    >>> formula("tau/(K*(tau_cl + L))")({"tau": 1.0, "K": 1.0, "tau_cl": 0.25, "L": 1.0})
    0.8
    """
    try:
        tree = ast.parse(text, mode="eval").body
    except SyntaxError as error:
        msg = f"'{text}' is not an arithmetic expression"
        raise PaperDefinitionError(msg) from error
    for node in ast.walk(tree):
        allowed = (ast.BinOp, ast.UnaryOp, ast.Name, ast.Constant, ast.operator, ast.USub, ast.Load)
        number = not isinstance(node, ast.Constant) or type(node.value) in {int, float}
        known = not isinstance(node, ast.BinOp) or type(node.op) in _OPERATIONS
        if not (isinstance(node, allowed) and number and known):
            msg = f"'{text}' may hold numbers, names and + - * / ** only"
            raise PaperDefinitionError(msg)
    return lambda symbols: _evaluate(tree, symbols)


def _evaluate(node: ast.expr, symbols: Mapping[str, Number]) -> Number:
    match node:
        case ast.Constant(value=int() | float() as value):
            return value
        case ast.Name(id=name):
            return symbols[name]
        case ast.UnaryOp(operand=operand):
            return -_evaluate(operand, symbols)
        case ast.BinOp(left=left, op=op, right=right):
            return _OPERATIONS[type(op)](_evaluate(left, symbols), _evaluate(right, symbols))
        case _:  # pragma: no cover - `formula` has refused everything else
            raise AssertionError


@dataclass(frozen=True)
class Gains:
    """Gains of a PI controller: proportional gain and integral time of ``kp (1 + 1/(s ti))``."""

    kp: Number
    ti: Number

    @property
    def ki(self) -> Number:
        """The integral gain ``kp/ti`` of the parallel form ``kp + ki/s``."""
        return self.kp / self.ti

    @classmethod
    def parallel(cls, kp: Number, ki: Number) -> Gains:
        """Return the gains of the parallel form ``kp + ki/s``; without integral action ``ti`` is infinite."""
        return cls(kp, kp / ki if ki else math.inf)


@dataclass(frozen=True)
class Range:
    """The processes for which one of several cases of a rule was made: those with low <= quantity <= high."""

    quantity: Formula
    low: float
    high: float

    def contains(self, **symbols: Number) -> bool:
        """Whether the case was made for a process with these parameters."""
        return self.low <= self.quantity(symbols) <= self.high


@dataclass(frozen=True)
class TuningRule:
    """How the gains of a PI controller follow from the parameters of a process model.

    Attributes
    ----------
    id, name
        Short key and full name.
    gain, integral_time
        The formulas; symbols are those of the paper.
    integral_gain
        The formula of ``ki`` where the rule gives that in place of an integral time.
    source
        Where the paper takes the rule from.
    range
        For which processes the rule was made, as text; empty if not stated.
    tex
        The formulas as displayed, by quantity (``Kp``, ``Ti``), LaTeX without ``$``.
    why
        For a variant other than the printed one: what differs and how one knows.
    holds
        For one case of several: where it applies.
    """

    id: str
    name: str
    gain: Formula
    integral_time: Formula | None
    source: str = ""
    range: str = ""
    tex: Mapping[str, str] = field(default_factory=dict)
    why: str = ""
    integral_gain: Formula | None = None
    holds: Range | None = None

    def evaluate(self, **symbols: Number) -> Gains:
        """Return the gains for the given parameters, exactly if parameters and formulas are exact.

        Raises
        ------
        PaperDefinitionError
            If the formulas need a parameter that is not given.
        """
        try:
            if self.integral_gain is not None:
                return Gains.parallel(self.gain(symbols), self.integral_gain(symbols))
            assert self.integral_time is not None  # noqa: S101  -- `load_rules` demands one of the two
            return Gains(self.gain(symbols), self.integral_time(symbols))
        except KeyError as error:
            msg = f"rule {self.id} needs {error.args[0]}; given are {', '.join(sorted(symbols))}"
            raise PaperDefinitionError(msg) from error


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
    PaperDefinitionError
        If a rule is incomplete, given twice, or a formula cannot be read; the message names file and rule.
    """
    rules: dict[str, TuningRule] = {}
    for record in tomllib.loads(source.read_text(encoding="utf-8")).get("rule", []):
        key = record.get("id", "?")
        where = f"{source.name}: rule {key}"
        if key in rules:
            msg = f"{where} is given twice"
            raise PaperDefinitionError(msg)
        try:
            form = _form(record, variant)
            second = "Ki" if "Ki" in form and "Ti" not in form else "Ti"
            gain, integral = (formula(_required(form | record, name)) for name in ("Kp", second))
            name = _required(record, "name")
            holds = _range(record["holds"]) if "holds" in record else None
        except PaperDefinitionError as error:
            msg = f"{where}: {error}"
            raise PaperDefinitionError(msg) from error
        tex = {name: form[f"{name}_tex"] for name in ("Kp", "Ti", "Ki") if f"{name}_tex" in form}
        rules[key] = TuningRule(
            key, name, gain, integral if second == "Ti" else None,
            record.get("source", ""), record.get("range", ""), tex, form.get("why", ""),
            integral_gain=integral if second == "Ki" else None, holds=holds,
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
                raise PaperDefinitionError(msg)
            if other and other not in classical[id]:
                variants = ", ".join(key for key, value in classical[id].items() if isinstance(value, dict))
                msg = f"same_as = '{own['same_as']}': {id} has no variant '{other}'; allowed: {variants}"
                raise PaperDefinitionError(msg)
            own = classical[id][PRINTED] | (classical[id][other] if other else {}) | own
        form |= own
    return form


@cache
def _classical_forms() -> dict[str, dict[str, Any]]:
    file = importlib.resources.files("replicate") / CLASSICAL
    return {record["id"]: record for record in tomllib.loads(file.read_text(encoding="utf-8"))["rule"]}


def _range(record: Mapping[str, Any]) -> Range:
    quantity, low, high = (_required(record, name) for name in ("quantity", "low", "high"))
    return Range(formula(quantity), float(low), float(high))


def _required(record: Mapping[str, Any], name: str) -> Any:
    if name not in record:
        msg = f"{name} is missing"
        raise PaperDefinitionError(msg)
    return record[name]


@cache
def classical_rules(variant: str = PRINTED) -> Mapping[str, TuningRule]:
    """Return the rules of the literature that more than one paper uses; symbols ``K``, ``tau``, ``L``."""
    return load_rules(importlib.resources.files("replicate") / CLASSICAL, variant)

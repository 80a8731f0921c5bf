"""A tuning rule: how the gains of a PI controller follow from the parameters of a process model."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from replicate.loops.errors import TuningRuleError
from replicate.loops.tune.formulas import Formula, Number


@dataclass(frozen=True)
class Gains:
    """Gains of a PI controller: proportional gain and integral time of ``kp (1 + 1/(s ti))``.

    Attributes
    ----------
    kp
        Proportional gain.
    ti
        Integral time; ``inf`` without integral action.

    Examples
    --------
    >>> Gains(kp=2.0, ti=4.0).ki
    0.5
    >>> Gains.parallel(kp=2.0, ki=0.0).ti
    inf
    """

    kp: Number
    ti: Number

    @property
    def ki(self) -> Number:
        """The integral gain ``kp/ti`` of the parallel form ``kp + ki/s``."""
        return self.kp / self.ti

    @classmethod
    def parallel(cls, kp: Number, ki: Number) -> Gains:
        """Return the gains of the parallel form ``kp + ki/s``; without integral action ``ti`` is infinite.

        Parameters
        ----------
        kp, ki
            Proportional and integral gain.
        """
        return cls(kp, kp / ki if ki else math.inf)


@dataclass(frozen=True)
class Range:
    """The processes for which one of several cases of a rule was made: those with low <= quantity <= high.

    Attributes
    ----------
    quantity
        Formula of the parameters of a process.
    low, high
        Its least and largest value.

    Examples
    --------
    >>> from replicate.loops.tune import formula
    >>> Range(formula("L/tau"), 0.1, 1.0).contains(L=1.0, tau=2.0)
    True
    """

    quantity: Formula
    low: float
    high: float

    def contains(self, **symbols: Number) -> bool:
        """Whether the case was made for a process with these parameters.

        Parameters
        ----------
        symbols
            Parameters of the process by name.
        """
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
    where
        What else the formulas use, in order; each counts where no such parameter is given.
    unit
        What the gains are multiplied by, where the rule is made for a process of another gain; `None` for 1.

    Examples
    --------
    A rule of one's own, with the closed loop as fast as the process, evaluated exactly:

    >>> from fractions import Fraction
    >>> from replicate.loops.tune import formula
    >>> rule = TuningRule("own", "Closed loop as fast as the process", formula("T/(K*(T + L))"), formula("T"))
    >>> gains = rule.evaluate(K=Fraction(1), T=Fraction(3), L=Fraction(1))
    >>> gains.kp, gains.ti
    (Fraction(3, 4), Fraction(3, 1))
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
    where: Mapping[str, Formula] = field(default_factory=dict)
    unit: Formula | None = None

    def evaluate(self, **symbols: Number) -> Gains:
        """Return the gains for the given parameters, exactly if parameters and formulas are exact.

        Parameters
        ----------
        symbols
            Parameters of the process by name.

        Raises
        ------
        TuningRuleError
            If the formulas need a parameter that is not given.
        """
        try:
            for name, formula in self.where.items():
                symbols.setdefault(name, formula(symbols))
            unit = self.unit(symbols) if self.unit is not None else 1
            if self.integral_gain is not None:
                return Gains.parallel(unit * self.gain(symbols), unit * self.integral_gain(symbols))
            assert self.integral_time is not None  # noqa: S101  -- `load_rules` demands one of the two
            return Gains(unit * self.gain(symbols), self.integral_time(symbols))
        except KeyError as error:
            msg = f"rule {self.id} needs {error.args[0]}; given are {', '.join(sorted(symbols))}"
            raise TuningRuleError(msg) from error

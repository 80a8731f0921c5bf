"""What there is to know of each callable rule: its source and what it is made for."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType, ModuleType

from replicate.loops.controller import PID
from replicate.loops.tune import (
    astrom_hagglund,
    classical,
    lambda_tuning,
    margin_specifications,
    skogestad,
    ziegler_and_nichols,
)


@dataclass(frozen=True)
class RuleCard:
    """A callable tuning rule, its source, and the plants it is made for.

    Attributes
    ----------
    rule
        Takes a plant and returns a controller.
    source
        Where it was published.
    validity
        The plants for which it is made, in words.

    Examples
    --------
    >>> from replicate.loops import Plant
    >>> RULES["lambda_"].rule(Plant.foptd(2.0, 6.0, 1.0), tau_cl=2.0).k  # 6/(2 (2 + 1))
    1.0
    """

    rule: Callable[..., PID]
    source: str
    validity: str


_HOMES: Mapping[Callable[..., PID], ModuleType] = {
    skogestad.simc: skogestad,
    astrom_hagglund.amigo: astrom_hagglund,
    lambda_tuning.lambda_: lambda_tuning,
    ziegler_and_nichols.ziegler_nichols: ziegler_and_nichols,
    margin_specifications.gain_phase_margins: margin_specifications,
    classical.by_name: classical,
}

#: The callable rules by the name of their function.
RULES: Mapping[str, RuleCard] = MappingProxyType(
    {rule.__name__: RuleCard(rule, home.SOURCE, home.VALIDITY) for rule, home in _HOMES.items()}
)

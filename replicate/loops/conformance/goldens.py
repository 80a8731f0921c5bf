"""The exact values as records."""

from __future__ import annotations

import importlib.resources
import json
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

from replicate.loops.conformance.digits import ATTAINABLE, Quantity

PEAKS = ("sensitivity_peak", "complementary_peak")
MARGINS = ("gain_margin", "gain_reduction_margin", "phase_margin", "delay_margin")


@dataclass(frozen=True)
class Golden:
    """One loop: ``record`` is its object in `goldens.json`."""

    record: dict[str, Any]

    @property
    def id(self) -> str:
        """Its name."""
        return str(self.record["id"])

    @property
    def kind(self) -> str:
        """What is hard about it."""
        return str(self.record["kind"])

    @property
    def stable(self) -> bool:
        """Whether all closed-loop poles lie in the open left half-plane."""
        return bool(self.record["stable"])

    @property
    def times(self) -> list[float]:
        """The times of the responses."""
        return list(self.record["responses"]["times"])

    def quantities(self) -> Iterator[Quantity]:
        """Yield all exact values of the loop, stability first."""
        yield Quantity("stability", "stable", float(self.stable), 1e-15)
        for index, pole in enumerate(self.record["poles"], start=1):
            value = complex(pole["re"], pole["im"])
            yield Quantity("poles", f"pole {index}", value, abs(value), ATTAINABLE / pole["multiplicity"])
        for group, names in (("peaks", PEAKS), ("margins", MARGINS)):
            for name in names:
                if name in self.record:
                    value = self.record[name]["value"]
                    yield Quantity(group, name, value, abs(value or 1.0))
        for name in ("step", "load_step"):
            values = self.record["responses"][name]
            largest = max(map(abs, values)) or 1.0
            for t, value in zip(self.times, values, strict=True):
                yield Quantity("responses", f"{name}({t:g})", value, largest)
        for name, value in self.record.get("metrics", {}).items():
            if value is not None:
                yield Quantity("metrics", name, value, 1.0 if name == "overshoot" else abs(value) or 1.0)


@cache
def _document() -> dict[str, Any]:
    file = importlib.resources.files("replicate.loops") / "goldens.json"
    document: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    return document


def goldens() -> list[Golden]:
    """Return all loops, in the order of the file."""
    return [Golden(record) for record in _document()["loops"]]

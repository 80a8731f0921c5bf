"""A place on an axis in the words of that axis: a number, a date or a category."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import datetime
from typing import Any

import numpy as np


def on_axis(value: float, axes: Mapping[str, Any] | None = None, axis: str = "") -> str:
    """Return a value on an axis as text.

    Parameters
    ----------
    axes, axis
        The description of axes and the name of one of them, ``"x"`` or ``"y"``; by default a plain number.

    Examples
    --------
    >>> dates = {"xkind": "date", "ykind": "date", "yunit": "M"}
    >>> on_axis(0.25), on_axis(19723.0, dates, "x"), on_axis(649.0, dates, "y")
    ('0.25', '2024-01-01', '2024-02')
    >>> on_axis(1.0, {"xkind": "categories", "xcategories": ["PI", "PID"]}, "x")
    "'PID'"
    """
    kind = axes.get(f"{axis}kind") if axes is not None else None
    if axes is not None and kind == "categories":
        names = axes.get(f"{axis}categories", [])
        if abs(value - round(value)) < 1e-6 and 0 <= round(value) < len(names):
            return f"'{names[round(value)]}'"
    if axes is not None and kind == "date":
        return _date(value, axes.get(f"{axis}unit", "D"))
    return f"{value:.4g}"


def _date(value: float, unit: str) -> str:
    if unit != "D":
        return str(np.datetime64(round(value), unit))  # type: ignore[call-overload]
    from matplotlib.dates import num2date

    date: datetime = num2date(value)  # type: ignore[no-untyped-call]
    return date.strftime("%Y-%m-%d %H:%M:%S").removesuffix(" 00:00:00")

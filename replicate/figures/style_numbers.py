"""The numbers of a style object of matplotlib that are not matplotlib's own: of arrows, boxes and path effects."""

from __future__ import annotations

from numbers import Real
from typing import Any

from matplotlib.colors import is_color_like, to_hex, to_rgba


def style_numbers(style: object) -> str:
    """Return what differs from a style of the same class that is made without arguments.

    Examples
    --------
    >>> from matplotlib.patches import BoxStyle
    >>> from matplotlib.patheffects import Stroke
    >>> style_numbers(BoxStyle("round", pad=0.6)), style_numbers(Stroke(offset=(4, -4), foreground="white"))
    ('pad=0.6', 'offset=(4, -4), foreground=#ffffff')
    """
    try:
        usual = vars(type(style)())
    except TypeError:  # a style of somebody else's, which needs arguments
        usual = {}
    given = vars(style) | getattr(style, "_gc", {})  # colours and widths of a path effect
    own = {name: _shown(value) for name, value in given.items() if value is not usual.get(name)}
    return ", ".join(
        f"{name.lstrip('_')}={value}" for name, value in own.items() if value and value != _shown(usual.get(name))
    )


def _shown(value: Any) -> str:
    """Return a number, a tuple of them, a colour or a word as text; nothing for anything else."""
    if isinstance(value, str):
        return to_hex(value, keep_alpha=to_rgba(value)[3] < 1.0) if is_color_like(value) else value
    if isinstance(value, tuple | list) and value and all(isinstance(part, Real) for part in value):
        return f"({', '.join(f'{float(part):.3g}' for part in value)})"
    return f"{float(value):.3g}" if isinstance(value, Real) else ""

"""The numbers of a style object of matplotlib that are not matplotlib's own: of arrows, boxes and path effects."""

from __future__ import annotations

from typing import Any


def style_numbers(style: object) -> str:
    """Return what differs from a style of the same class that is made without arguments.

    Examples
    --------
    >>> from matplotlib.patches import BoxStyle
    >>> from matplotlib.patheffects import SimpleLineShadow
    >>> style_numbers(BoxStyle("round", pad=0.6)), style_numbers(SimpleLineShadow(offset=(4, -4)))
    ('pad=0.6', 'offset=(4, -4)')
    """
    try:
        usual = vars(type(style)())
    except TypeError:  # a style of somebody else's, which needs arguments
        usual = {}
    own = {name: _shown(value) for name, value in vars(style).items() if value is not usual.get(name)}
    return ", ".join(
        f"{name.lstrip('_')}={value}" for name, value in own.items() if value and value != _shown(usual.get(name))
    )


def _shown(value: Any) -> str:
    """Return a number, or a tuple of them, as text; nothing for anything else."""
    if isinstance(value, tuple | list) and value and all(map(_is_number, value)):
        return f"({', '.join(f'{float(part):.3g}' for part in value)})"
    return f"{float(value):.3g}" if _is_number(value) else ""


def _is_number(value: object) -> bool:
    return isinstance(value, int | float)

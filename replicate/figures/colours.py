"""Colours and dashes in words, and when two of them look the same."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

#: Steps of 255 that nobody sees; a colour map has no finer ones.
SAME = 4

# The colours that matplotlib itself begins with, and the ones that people write by name.
_NAMES = {
    "black": "#000000", "white": "#ffffff", "grey": "#808080 #7f7f7f #b0b0b0", "light grey": "#d3d3d3 #e6e6e6",
    "dark grey": "#404040", "red": "#d62728 #ff0000", "dark red": "#8b0000", "orange": "#ff7f0e #ffa500",
    "yellow": "#ffff00", "light yellow": "#ffffe0", "olive": "#bcbd22 #808000", "lime": "#00ff00",
    "green": "#2ca02c #008000", "dark green": "#006400", "cyan": "#17becf #00ffff", "light blue": "#87cefa #add8e6",
    "blue": "#1f77b4 #0000ff", "dark blue": "#00008b #000080", "purple": "#9467bd #800080",
    "dark purple": "#440154", "magenta": "#ff00ff", "pink": "#e377c2 #ffc0cb", "brown": "#8c564b #a52a2a",
    "gold": "#daa520 #ffd700", "wheat": "#f5deb3",
}  # fmt: skip

_DASHES = {"dashed": (3.7, 1.6), "dash-dotted": (6.4, 1.6, 1.0, 1.6), "dotted": (1.0, 1.65)}


def channels(colour: str) -> list[int]:
    """Return red, green, blue and alpha, each from 0 to 255.

    Examples
    --------
    >>> channels("#ff8000"), channels("#ff800080")
    ([255, 128, 0, 255], [255, 128, 0, 128])
    """
    parts = [int(colour[place : place + 2], 16) for place in range(1, len(colour), 2)]
    return parts if len(parts) == 4 else [*parts, 255]


def same_colour(one: str, other: str) -> bool:
    """Whether two colours look the same; what cannot be seen has no colour."""
    first, second = channels(one), channels(other)
    if not (is_seen(one) or is_seen(other)):
        return True
    return all(abs(a - b) <= SAME for a, b in zip(first, second, strict=True))


def is_seen(colours: Any) -> bool:
    """Whether anything can be seen of a colour, or of many of them, of which a digest may be all that is known."""
    return channels(colours)[3] > 1 if isinstance(colours, str) else colours is not None


def colour_words(one: str, other: str) -> tuple[str, str]:
    """Return what two colours are called, with their codes only where the names do not tell them apart.

    Examples
    --------
    >>> colour_words("#1f77b4", "#ff7f0e"), colour_words("#1f77b4", "#1f77c0")
    (('blue', 'orange'), ('blue #1f77b4', 'blue #1f77c0'))
    """
    names = _name(one), _name(other)
    if names[0] == names[1]:
        return f"{names[0]} {one}", f"{names[1]} {other}"
    return names


def alphas(one: str, other: str) -> tuple[float, float] | None:
    """Return both opacities if nothing but these differs."""
    first, second = channels(one), channels(other)
    if all(abs(a - b) <= SAME for a, b in zip(first[:3], second[:3], strict=True)):
        return round(first[3] / 255.0, 2), round(second[3] / 255.0, 2)
    return None


def _name(colour: str) -> str:
    red, green, blue, _ = channels(colour)
    distances = {
        name: min(_apart((red, green, blue), channels(code)[:3]) for code in codes.split())
        for name, codes in _NAMES.items()
    }
    return min(distances, key=lambda name: distances[name])


def _apart(one: Sequence[int], other: Sequence[int]) -> float:
    # The mean of red decides how much red and blue count (Riemersma, "Colour metric").
    mean = (one[0] + other[0]) / 2.0
    red, green, blue = (a - b for a, b in zip(one, other, strict=True))
    return math.sqrt((2.0 + mean / 256.0) * red**2 + 4.0 * green**2 + (2.0 + (255.0 - mean) / 256.0) * blue**2)


def dash_words(pattern: Sequence[float], width: float) -> str:
    """Return what a dash pattern is called: offset and lengths in points, for a line of some width.

    Examples
    --------
    >>> dash_words([], 1.5), dash_words([0.0, 5.55, 2.4], 1.5), dash_words([0.0, 9.0, 9.0], 1.0)
    ('solid', 'dashed', 'dashed 9-9')
    """
    if not pattern:
        return "solid"
    lengths = [length / (width or 1.0) for length in pattern[1:]]
    for name, known in _DASHES.items():
        if len(known) == len(lengths) and all(
            math.isclose(a, b, rel_tol=0.02, abs_tol=0.02) for a, b in zip(known, lengths, strict=True)
        ):
            return name if not pattern[0] else f"{name} from {pattern[0]:.3g} pt"
    return (
        "dashed "
        + "-".join(f"{length:.3g}" for length in lengths)
        + (f" from {pattern[0]:.3g} pt" if pattern[0] else "")
    )

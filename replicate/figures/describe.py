"""Describe axes as a person would: titles, limits, scales, labels, legend, texts, where they are and what they show."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from matplotlib.category import StrCategoryConverter
from matplotlib.contour import ContourSet
from matplotlib.dates import DateConverter, _SwitchableDateConverter
from matplotlib.projections.polar import PolarAxes

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis

    from replicate.figures.ink import Ink

_DIGITS = 9
_SIDES: tuple[Literal["left"], Literal["center"], Literal["right"]] = ("left", "center", "right")
# Steps of a table that gives the place of a value on an axis that is neither linear nor logarithmic.
_STEPS = 192
_PERIODS = {
    "Y": "Y",
    "YE": "Y",
    "A": "Y",
    "M": "M",
    "ME": "M",
    "D": "D",
    "h": "h",
    "H": "h",
    "min": "m",
    "T": "m",
    "s": "s",
}


def describe(panel: str, axes: Axes, ink: Ink | None = None) -> dict[str, Any]:
    """Return the description of axes, ready for JSON.

    Parameters
    ----------
    ink
        What the artists have left on the figure, if it was drawn: a text that left nothing is none.

    Returns
    -------
    dict
        ``panel, title, xlabel, ylabel, xscale, yscale, xlim, ylim, legend, texts``. A text is
        ``{"text", "x", "y"}`` with its anchor in data coordinates, or with ``"in": "axes"`` in fractions of the
        axes. Only where it applies: ``titles`` (if there are several), ``aspect``, ``hidden`` (axes that are switched
        off), ``projection``, ``units`` ("box": the coordinates of curves are fractions of the axes), ``xtable``
        (where values lie on an axis that is neither linear nor logarithmic), ``xkind`` ("date", "categories"),
        ``xunit`` (what dates count since 1970, if not days), ``xcategories``, ``polar``, ``view``, ``depth`` and what
        belongs to the third axis.
    """
    legend = axes.get_legend() if hasattr(axes, "get_legend") else None
    said = said_titles(axes)
    texts = (text for text in said_texts(axes) if text.get_visible() and (ink is None or ink.shows(text)))
    found: dict[str, Any] = {
        "panel": panel,
        "title": said[0] if said else "",
        "xlabel": axes.get_xlabel(),
        "ylabel": axes.get_ylabel(),
        "xscale": axes.get_xscale(),
        "yscale": axes.get_yscale(),
        "xlim": [number(limit) for limit in axes.get_xlim()],
        "ylim": [number(limit) for limit in axes.get_ylim()],
        "legend": [text.get_text() for text in legend.get_texts()] if legend and legend.get_visible() else [],
        "texts": [_text(text, axes) for text in texts],
    }
    if len(said) > 1:
        found["titles"] = [axes.get_title(loc=side) for side in _SIDES]
    if axes.get_aspect() != "auto":
        found["aspect"] = "equal" if axes.get_aspect() == 1.0 else number(axes.get_aspect())
    if not axes.axison:
        found["hidden"] = True
    if axes.name != "rectilinear":
        found["projection"] = str(axes.name)
    if isinstance(axes, PolarAxes):
        found["polar"] = _polar(axes)
    elif axes.name != "rectilinear":
        found |= {"units": "box"} | _solid(axes)
    else:
        for place, name in enumerate("xy"):
            found |= _axis(axes, name, place)
    return found


def said_titles(axes: Axes) -> list[str]:
    """Return the titles of axes, the one in the centre first; an axis that was added to others can have none."""
    if not hasattr(axes, "get_title"):
        return []
    return [title for side in ("center", "left", "right") if (title := axes.get_title(loc=side))]


def said_label(artist: Artist) -> str:
    """Return the label that somebody gave an artist, in one line; empty if nobody did."""
    label = artist.get_label()
    words = "" if label is None else " ".join(str(label).split())
    return "" if words.startswith("_") else words


def said_texts(axes: Axes) -> list[Any]:
    """Return the texts of axes, without the labels of contours: where these are follows from their width."""
    sets = (artist for artist in axes.collections if isinstance(artist, ContourSet))
    labels = {id(text) for artist in sets for text in getattr(artist, "labelTexts", ())}
    return [text for text in axes.texts if text.get_text() and id(text) not in labels]


def number(value: Any) -> Any:
    """Round a number to nine significant digits; a category or a date stays the text it is."""
    try:
        return float(f"{float(value):.{_DIGITS}g}")
    except (TypeError, ValueError):
        return str(value)


def _text(text: Any, axes: Axes) -> dict[str, Any]:
    x, y = getattr(text, "xy", text.get_position())
    coordinates = getattr(text, "xycoords", text.get_transform())
    fraction = coordinates in ("axes fraction", axes.transAxes)
    return {"text": text.get_text(), "x": number(x), "y": number(y)} | ({"in": "axes"} if fraction else {})


def _axis(axes: Axes, name: str, place: int) -> dict[str, Any]:
    """Describe what is special about one axis: a scale of its own, dates, categories."""
    axis: Axis = getattr(axes, f"{name}axis")
    found: dict[str, Any] = {}
    if axis.get_scale() not in {"linear", "log"}:
        found[f"{name}table"] = _table(axes, place)
    converter = axis.get_converter() if hasattr(axis, "get_converter") else getattr(axis, "converter", None)
    if isinstance(converter, DateConverter | _SwitchableDateConverter):
        unit = _period(axis) if type(converter).__name__ == "PeriodConverter" else "D"
        found |= {f"{name}kind": "date"} if unit else {}
        found |= {f"{name}unit": unit} if unit not in {"", "D"} else {}
        found[f"{name}lim"] = [float(f"{float(end):.14g}") for end in getattr(axes, f"get_{name}lim")()]
    elif isinstance(converter, StrCategoryConverter):
        found[f"{name}kind"] = "categories"
        mapping: dict[str, int] = getattr(getattr(axis, "units", None), "_mapping", {})
        found[f"{name}categories"] = [str(key) for key, _ in sorted(mapping.items(), key=lambda item: item[1])]
    return found


def _period(axis: Any) -> str:
    """Return what an axis of pandas' periods counts, as NumPy calls it; empty if NumPy does not know it."""
    frequency = getattr(axis, "freq", "")  # its name, or an object that has one
    return _PERIODS.get(str(getattr(frequency, "rule_code", frequency)).partition("-")[0], "")


def _table(axes: Axes, place: int) -> dict[str, list[float]]:
    """Return values on an axis and where they lie, far to both sides of what can be seen."""
    at = np.linspace(-1.0, 2.0, 3 * _STEPS + 1)
    points = np.column_stack([at, at])
    with np.errstate(all="ignore"):
        data = axes.transScale.inverted().transform(axes.transLimits.inverted().transform(points))[:, place]
        back = axes.transLimits.transform(axes.transScale.transform(np.column_stack([data, data])))[:, place]
    there = np.isfinite(data) & (np.abs(back - at) < 1e-6)
    # In increasing order, and no value twice where a scale saturates.
    values, first = np.unique(data[there], return_index=True)
    return {
        "data": [float(f"{value:.{_DIGITS}g}") for value in values],
        "at": [float(f"{value:.6g}") for value in at[there][first]],
    }


def _polar(axes: PolarAxes) -> dict[str, Any]:
    low, high = axes.get_rorigin(), axes.get_rmax()
    offset, direction = float(axes.get_theta_offset()), int(axes.get_theta_direction())
    found: dict[str, Any] = {"offset": float(f"{offset:.9g}"), "direction": direction, "rscale": axes.get_yscale()}
    found["rlim"] = [number(low), number(high)]
    to_axes = axes.transData - axes.transAxes
    # Three points of the unit disk tell where it lies in the box of the axes.
    angles = (np.array([0.0, np.pi / 2.0]) - offset) / direction
    with np.errstate(all="ignore"):
        right, up = to_axes.transform(np.column_stack([angles, [high, high]]))
        (left,) = to_axes.transform([[(np.pi - offset) / direction, high]])
    centre = (right + left) / 2.0
    matrix = np.column_stack([right - centre, up - centre, centre])
    found["matrix"] = [float(f"{part:.9g}") + 0.0 for part in matrix.ravel()]
    if axes.get_yscale() != "linear":
        share = np.linspace(0.0, 1.5, 2 * _STEPS + 1)
        places = centre + share[:, None] * (right - centre)
        data = to_axes.inverted().transform(places)[:, 1]
        there = np.isfinite(data)
        found["rtable"] = {"data": [float(f"{r:.9g}") for r in data[there]], "at": share[there].tolist()}
    return found


def _solid(axes: Any) -> dict[str, Any]:
    """Describe the third axis, and where one looks from."""
    if not hasattr(axes, "get_zlim"):
        return {}
    return {
        "zlabel": axes.get_zlabel(),
        "zlim": [number(limit) for limit in axes.get_zlim()],
        "view": [number(getattr(axes, part, 0.0)) for part in ("elev", "azim", "roll")],
        "depth": _depth(axes),
        "proportions": [number(part) for part in getattr(axes, "_box_aspect", ())],
    }


def _depth(axes: Any) -> str:
    """Return how axes in space are projected; what is parallel is seen from infinitely far."""
    length = float(getattr(axes, "_focal_length", 1.0))
    return "orthographic" if math.isinf(length) else f"in perspective, focal length {length:.4g}"

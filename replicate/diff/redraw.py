"""Draw stored figures: what is compared is the data, so both states are drawn by the same, present renderer.

A difference between two of these pictures is a difference of the data, whatever matplotlib made the figure
when it was accepted.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from replicate.diff.accepted import FigureState
from replicate.diff.curve_looks import look_of
from replicate.figures import style as plotstyle
from replicate.figures.axes import symbol
from replicate.figures.distance import exact_distances
from replicate.figures.off_screen import svg_text
from replicate.figures.pair import Pair
from replicate.figures.panel_pairs import matched_panels
from replicate.figures.polylines import Points
from replicate.figures.scaling import finite, from_units, in_units

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Canvas

ACCEPTED, NEW = plotstyle.PALETTE[1], plotstyle.PALETTE[0]

#: Differences of at most this many curves are drawn, those that moved most.
MOST_CURVES = 6

_WIDTH, _HEIGHT, _LOW = 6.4, 3.6, 2.9
_COLUMNS = 2
_LONGEST_LABEL = 40
_ACCEPTED: dict[str, Any] = {"color": ACCEPTED, "linestyle": (0, (4, 2)), "linewidth": 1.6, "zorder": 4}
_NEW: dict[str, Any] = {"color": NEW, "linestyle": "-", "linewidth": 1.6, "zorder": 3}
_UNCHANGED: dict[str, Any] = {"color": plotstyle.GRID, "linestyle": "-", "linewidth": 0.9, "alpha": 0.7}

Description = Mapping[str, Any]


def picture(state: FigureState, salt: str, order: Sequence[tuple[str, str]]) -> str:
    """Return one state of a figure as an SVG.

    Parameters
    ----------
    order
        All curves of both states, so that a curve has the same colour in both pictures. One whose look is recorded
        has that of the paper's figure.
    """

    def draw(axes: Axes, panel: Description) -> None:
        names = [name for owner, name in order if owner == panel["panel"]]
        for place, name in enumerate(names):
            points = state.curves.get((panel["panel"], name))
            if points is not None:
                _draw_curve(axes, panel, name, points, **(_look(place) | look_of(panel, name)))
        _draw_legend(axes, panel)

    return _drawn(state.axes, draw, salt)


def overlay(before: FigureState, after: FigureState, same: Collection[tuple[str, str]], salt: str) -> str:
    """Return both states in one picture: what changed in two colours, everything else in grey.

    Parameters
    ----------
    same
        Accepted panel and name of the curves that did not change.
    """
    partner = {
        str(old["panel"]): new
        for old, new in matched_panels(before.axes, after.axes)
        if old is not None and new is not None
    }

    def draw(axes: Axes, panel: Description) -> None:
        new = partner[panel["panel"]]
        for state, description, look in ((before, panel, _ACCEPTED), (after, new, _NEW)):
            for (owner, name), points in state.curves.items():
                if owner != description["panel"]:
                    continue
                if (str(panel["panel"]), name) not in same:
                    _draw_curve(axes, description, name, points, **look)
                elif state is after:
                    _draw_curve(axes, description, name, points, **_UNCHANGED)
        for line in axes.lines:
            line.set_label("_")
        if "polar" not in panel and panel.get("units") != "box":
            axes.set_xlim(*_both(panel["xlim"], new["xlim"]))
            axes.set_ylim(*_both(panel["ylim"], new["ylim"]))
        axes.plot([], [], label="accepted", **_ACCEPTED)
        axes.plot([], [], label="new", **_NEW)
        axes.legend(loc="best")

    return _drawn([panel for panel in before.axes if str(panel["panel"]) in partner], draw, salt)


def differences(pairs: Sequence[Pair], salt: str) -> str:
    """Return, for each of the curves that moved, how far it did, with the tolerance band around zero."""
    from matplotlib.figure import Figure as Canvas

    several = len({pair.axes["panel"] for pair in pairs}) > 1
    with plotstyle.style(hashsalt=salt):
        canvas = Canvas(figsize=(_WIDTH, 0.5 + 1.35 * len(pairs)))
        for axes, pair in zip(canvas.subplots(len(pairs), squeeze=False)[:, 0], pairs, strict=True):
            place = f" ({_shortened(pair.axes['panel'])})" if several else ""
            axes.set_title(_shortened(pair.name) + place, loc="left", fontsize=10)
            if pair.values is not None:
                _draw_values(axes, pair)
            else:
                _draw_distance(axes, pair)
        return svg_text(canvas, "differences")


def _draw_values(axes: Axes, pair: Pair) -> None:
    found = pair.values
    assert found is not None  # noqa: S101  -- the caller has looked
    relative = np.column_stack([part - found.before for part in (found.after, found.lower, found.upper)])
    # The limits from both sides of every x are needed only where something jumps.
    twin = np.r_[False, (np.diff(found.x) == 0.0) & np.all(np.diff(relative, axis=0) == 0.0, axis=1)]
    x = np.array([from_units(float(value), pair.axes, "x") for value in found.x[~twin]])
    moved, lower, upper = 100.0 * relative[~twin].T
    reach = 1.2 * max(float(np.nanmax(np.abs(moved), initial=0.0)), 300.0 * pair.tolerance)
    axes.fill_between(x, lower, upper, color=plotstyle.PALETTE[2], alpha=0.25, linewidth=0.0, label="tolerance")
    axes.plot(x, moved, color=NEW, linewidth=1.2, label="new − accepted")
    if pair.axes.get("xscale") == "log":
        axes.set_xscale("log")
    axes.set_xlim(*pair.axes["xlim"])
    axes.set_ylim(-reach, reach)
    axes.set_ylabel("% of the axis")
    axes.set_xlabel(symbol(pair.axes, "x"))


def _draw_distance(axes: Axes, pair: Pair) -> None:
    found = pair.distance[0]
    along = np.linspace(0.0, 100.0, len(found.distance)) if len(found.distance) > 1 else np.zeros(1)
    # Scattered points are measured from each other, not from lines between them.
    scattered = pair.name in pair.axes.get("points", ())
    distance = found.distance if scattered else exact_distances(found, in_units(pair.before, pair.axes))
    drawn = np.where(np.isfinite(distance), distance, np.nan)
    axes.axhspan(0.0, 100.0 * pair.tolerance, color=plotstyle.PALETTE[2], alpha=0.25, linewidth=0.0)
    if len(drawn):
        axes.plot(along, 100.0 * drawn, color=NEW, linewidth=1.2)
    axes.set_xlim(0.0, 100.0)
    axes.set_ylim(bottom=0.0)
    axes.set_ylabel("% of the axes")
    axes.set_xlabel("along the new curve in %; distance from the accepted one")


def _drawn(panels: Sequence[Description], draw: Callable[[Axes, Description], None], salt: str) -> str:
    from matplotlib.figure import Figure as Canvas

    columns = min(_COLUMNS, len(panels))
    rows = max(1, -(-len(panels) // max(columns, 1)))
    height = max((_panel_height(panel, columns) for panel in panels), default=1.0)
    with plotstyle.style(hashsalt=salt):
        canvas: Canvas = Canvas(figsize=(_WIDTH, 0.2 + height * rows))
        for place, panel in enumerate(panels, start=1):
            axes = canvas.add_subplot(rows, columns, place, projection="polar" if "polar" in panel else None)
            _set_axes(axes, panel)
            draw(axes, panel)
        if panels and panels[0].get("figure_title"):
            canvas.suptitle(panels[0]["figure_title"])
        return svg_text(canvas, salt)


def _panel_height(panel: Description, columns: int) -> float:
    """Return the height in inches of a panel; one with equal units on both axes is as high as it must be."""
    if panel.get("aspect") == "equal" and panel.get("xscale") == panel.get("yscale"):
        width, height = (abs(panel[f"{axis}lim"][1] - panel[f"{axis}lim"][0]) for axis in "xy")
        return float(np.clip(_WIDTH / columns * height / width, 1.0, 1.5 * _HEIGHT))
    return _HEIGHT if columns == 1 else _LOW


def _set_axes(axes: Axes, panel: Description) -> None:
    if panel.get("units") == "box":  # of a solid, or a globe: only the picture of the curves is known
        axes.set(xlim=(0.0, 1.0), ylim=(0.0, 1.0), title=panel.get("title", ""))
        axes.set_axis_off()
        return
    if "polar" in panel:
        _set_polar(axes, panel)
        return
    for axis in "xy":
        _set_scale(axes, axis, panel)
        getattr(axes, f"set_{axis}lim")(*panel[f"{axis}lim"])
        getattr(axes, f"set_{axis}label")(panel.get(f"{axis}label", ""))
    axes.set_title(panel.get("title", ""))
    if panel.get("hidden"):
        axes.set_axis_off()
    if panel.get("aspect") == "equal":
        axes.set_aspect("equal", adjustable="box")
    for text in panel.get("texts", ()):
        if isinstance(text["x"], float) and isinstance(text["y"], float):
            where = axes.transAxes if text.get("in") == "axes" else axes.transData
            axes.text(
                text["x"], text["y"], text["text"], transform=where, fontsize=9, clip_on=True, ha="center", va="center"
            )


def _set_scale(axes: Axes, axis: str, panel: Description) -> None:
    """Give an axis its scale, one that cannot be made again by its name by the table of its values."""
    from matplotlib.scale import get_scale_names

    scale = panel.get(f"{axis}scale", "linear")
    if f"{axis}table" not in panel:
        getattr(axes, f"set_{axis}scale")(scale if scale in get_scale_names() else "linear")
        return
    table = panel[f"{axis}table"]
    order = np.argsort(table["data"])
    data, places = (np.asarray(table[name], dtype=float)[order] for name in ("data", "at"))
    falling = places[0] > places[-1]
    at = -places if falling else places

    def there(values: Any) -> Any:
        return np.interp(values, data, at)

    def back(values: Any) -> Any:
        return np.interp(values, at, data)

    getattr(axes, f"set_{axis}scale")("function", functions=(there, back))


def _set_polar(axes: Any, panel: Description) -> None:
    polar = panel["polar"]
    axes.set_theta_offset(polar["offset"])
    axes.set_theta_direction(polar["direction"])
    axes.set_rorigin(polar["rlim"][0])
    axes.set_rlim(*panel["ylim"])
    axes.set_title(panel.get("title", ""))


def _draw_curve(axes: Axes, panel: Description, name: str, points: Points, **look: Any) -> None:
    label = name if name in _legend(panel) else "_"
    if name in panel.get("points", ()):
        axes.plot(*points.T, label=label, **{**look, "linestyle": "none", "marker": "o", "markersize": 3.0})
        return
    axes.plot(*points.T, label=label, **look)
    if name in panel.get("areas", ()):
        axes.fill(*points[finite(points)].T, color=look["color"], alpha=0.15, linewidth=0.0)


def _draw_legend(axes: Axes, panel: Description) -> None:
    handles = {str(line.get_label()): line for line in axes.lines}
    entries = [name for name in _legend(panel) if name in handles]
    if entries:
        axes.legend([handles[name] for name in entries], entries, loc="best", fontsize=9)


def _legend(panel: Description) -> Sequence[str]:
    """Return the entries of a panel's legend; one of the whole figure stands with the first panel."""
    return [*panel.get("legend", ()), *panel.get("figure_legend", ())]


def _look(place: int) -> dict[str, Any]:
    colours = len(plotstyle.PALETTE)
    return {
        "color": plotstyle.PALETTE[place % colours],
        "linestyle": ("-", "--")[place // colours % 2],
        "linewidth": 1.3,
    }


def _both(one: Sequence[float], other: Sequence[float]) -> tuple[float, float]:
    """Return limits that show both ranges, in the direction of the new one."""
    low, high = min(*one, *other), max(*one, *other)
    return (low, high) if other[0] <= other[1] else (high, low)


def _shortened(name: str) -> str:
    return name if len(name) <= _LONGEST_LABEL or "$" in name else f"{name[:_LONGEST_LABEL]}…"

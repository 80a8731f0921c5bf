# ruff: noqa: E501  -- a table reads best with one line for each case
"""Nothing visible moves unnoticed: each visible property of the gallery is changed once, and what is said names it."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest
from gallery import GALLERY, NOISE, T, X, Y, Z
from matplotlib import colormaps
from matplotlib.colors import BoundaryNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.markers import MarkerStyle
from matplotlib.patches import Circle
from matplotlib.patheffects import TickedStroke, withSimplePatchShadow, withStroke
from matplotlib.transforms import Affine2D, Bbox

from replicate.figures import Record, capture, compare

Change = Callable[[Any], object]


def drawn(name: str) -> Figure:
    figure = Figure()
    GALLERY[name](figure)
    return figure


@cache
def accepted(name: str) -> Record:
    return Record.from_json(capture(drawn(name)).to_json())


def on(get: Callable[[Any], Any], **properties: Any) -> Change:
    """Return a change that sets properties of an artist of the first axes."""

    def change(figure: Figure) -> None:
        artist = get(figure.axes[0])
        for name, value in properties.items():
            getattr(artist, f"set_{name}")(value)

    return change


def axes(change: Callable[[Any], object]) -> Change:
    """Return a change of the first axes."""
    return lambda figure: change(figure.axes[0])


def line(axes: Any) -> Any:
    return axes.lines[0]


def collection(axes: Any) -> Any:
    return axes.collections[0]


def patch(axes: Any) -> Any:
    return axes.patches[0]


def picture(axes: Any) -> Any:
    return axes.images[0]


def words(axes: Any) -> Any:
    return axes.texts[0]


def twice_as_long(figure: Figure) -> None:
    figure.axes[0].texts[0].set_position((1.2, 0.3))


def in_other_panel(place: int, change: Callable[[Any], object]) -> Change:
    return lambda figure: change(figure.axes[place])


def turned(axes: Any) -> None:
    u, v = collection(axes).U, collection(axes).V
    collection(axes).set_UVC(-v, u)


def other_noise(figure: Figure) -> None:
    line(figure.axes[0]).set_ydata(np.random.default_rng(8).standard_normal(len(NOISE)))


def other_frequency(figure: Figure) -> None:
    t = np.linspace(0.0, 1.0, 100_000)
    line(figure.axes[0]).set_ydata(np.sin(2.0 * np.pi * 1300.0 * t))


def stretched(figure: Figure) -> None:
    x, y = line(figure.axes[0]).get_data()
    line(figure.axes[0]).set_data(1.02 * x, y)


def one_pixel(figure: Figure) -> None:
    values = np.array(picture(figure.axes[0]).get_array())
    values[17, 33] += 0.1 * np.ptp(values)
    picture(figure.axes[0]).set_data(values)


def doubled(place: int) -> Callable[[Any], object]:
    def change(axes: Any) -> None:
        x = np.array(line(axes).get_xdata(), dtype=float)
        x[place] *= 2.0
        limits = axes.get_xlim()
        line(axes).set_xdata(x)
        axes.set_xlim(limits)

    return change


def swapped_handles(axes: Any) -> None:
    first, second = axes.lines
    axes.legend([second, first], ["ZN", "PA"])


def other_colour_steps(axes: Any) -> None:
    mesh = collection(axes)
    ends = mesh.norm.boundaries
    mesh.set_norm(BoundaryNorm([ends[0], *(0.5 * (ends[1:-1] + ends[2:])), ends[-1]], mesh.norm.Ncmap))


def other_steps(axes: Any) -> None:
    line(axes).set_drawstyle("steps-pre")


ALARMS: list[tuple[str, str, Change, str]] = [
    # Lines.
    ("lines", "colour", on(line, color="red"), "colour of curve 'ZN' changed from blue to"),
    ("lines", "dashes", on(line, linestyle="--"), "curve 'ZN' is dashed now"),
    ("lines", "dotted", on(line, linestyle=":"), "curve 'ZN' is dotted now"),
    ("lines", "width", on(line, linewidth=3.0), "line of curve 'ZN' is 3 pt wide now .was 1.5"),
    ("lines", "alpha", on(line, alpha=0.5), "opacity of curve 'ZN' is now 0.5"),
    ("lines", "marker", on(line, marker="o", markevery=50), "curve 'ZN' now has markers"),
    ("lines", "order", on(line, zorder=5), "curve 'ZN' is drawn over curve 'PA' now"),
    ("lines", "hidden", on(line, visible=False), "curve 'ZN' is missing"),
    ("lines", "label", on(line, label="other"), "curve 'ZN' is now called 'other'"),
    ("lines", "data", on(line, ydata=np.sin(T) + 0.01), "curve 'ZN' moved"),
    ("lines", "clip off", on(line, clip_on=False), "curve 'ZN' is clipped nowhere now"),
    ("lines", "sketch", axes(lambda ax: line(ax).set_sketch_params(2.0, 100.0, 5.0)), "sketch style of curve 'ZN'"),
    ("lines", "new line", axes(lambda ax: ax.plot([0, 1], label="new")), "curve 'new' is new"),
    ("lines", "cap", on(line, linewidth=8.0, solid_capstyle="butt"), "curve 'ZN'"),
    ("lines", "x label", axes(lambda ax: ax.set_xlabel("other")), "label of the x axis is now 'other'"),
    ("lines", "x label pad", axes(lambda ax: ax.set_xlabel("time $t$", labelpad=20)), "pad of label of the x axis"),
    ("lines", "x label place", axes(lambda ax: ax.set_xlabel("time $t$", loc="left")), "label of the x axis"),
    ("lines", "x label colour", on(lambda ax: ax.xaxis.label, color="red"), "colour of label of the x axis changed"),
    ("lines", "y label turned", on(lambda ax: ax.yaxis.label, rotation=0), "label of the y axis is turned by 0"),
    ("lines", "title", axes(lambda ax: ax.set_title("Other")), "title is now 'Other'"),
    ("lines", "title place", axes(lambda ax: ax.set_title("Step", loc="left")), "title"),
    ("lines", "title height", axes(lambda ax: ax.set_title("Step", y=0.5)), "vertical place of title is now 0.5"),
    ("lines", "title size", on(lambda ax: ax.title, fontsize=20), "title has a size of 20 pt now .was 12"),
    ("lines", "title weight", on(lambda ax: ax.title, fontweight="bold"), "weight of title is now bold"),
    ("lines", "title slant", on(lambda ax: ax.title, fontstyle="italic"), "slant of title is now italic"),
    ("lines", "limits", axes(lambda ax: ax.set_xlim(0, 8)), "x axis now"),
    ("lines", "inverted", axes(lambda ax: ax.invert_yaxis()), "the other way round"),
    ("lines", "scale", axes(lambda ax: ax.set_xscale("symlog")), "scale of the x axis is now 'symlog'"),
    ("lines", "grid", axes(lambda ax: ax.grid(visible=True)), "grid lines of the x axis are new"),
    ("lines", "spine", on(lambda ax: ax.spines["top"], visible=False), "top spine is gone"),
    ("lines", "spine colour", on(lambda ax: ax.spines["left"], color="red"), "colour of left spine changed from black"),
    ("lines", "spine width", on(lambda ax: ax.spines["left"], linewidth=3), "line of left spine is 3 pt wide"),
    ("lines", "face", axes(lambda ax: ax.set_facecolor("yellow")), "colour of background changed from white"),
    ("lines", "legend handles", axes(swapped_handles), "colour of legend entry 'ZN' changed from blue to orange"),
    ("lines", "legend title", axes(lambda ax: ax.get_legend().set_title("Rules")), "title of the legend is new"),
    ("lines", "legend place", axes(lambda ax: ax.legend(loc="lower left")), "place of legend is now lower left"),
    ("lines", "legend anchor", axes(lambda ax: ax.legend(bbox_to_anchor=(1.0, 0.5))), "anchor of legend"),
    ("lines", "legend hidden", axes(lambda ax: ax.get_legend().set_visible(False)), "legend is gone"),
    ("lines", "legend removed", axes(lambda ax: ax.get_legend().remove()), "legend is gone"),
    ("lines", "legend frame", axes(lambda ax: ax.get_legend().set_frame_on(False)), "legend"),
    ("lines", "legend columns", axes(lambda ax: ax.legend(ncols=2)), "columns of legend is now 2"),
    ("lines", "legend spacing", axes(lambda ax: ax.legend(labelspacing=2)), "spacing of legend is now 2"),
    ("lines", "legend corners", axes(lambda ax: ax.legend(fancybox=False)), "frame of legend is now Square"),
    ("lines", "title pad", axes(lambda ax: ax.set_title("Step", pad=40)), "pad of title is now 40"),
    ("lines", "legend order", axes(lambda ax: ax.legend(ax.lines[::-1], ["PA", "ZN"])), "legend entries"),
    ("lines", "legend text colour", axes(lambda ax: ax.legend(labelcolor="red")), "colour of legend entry 'ZN'"),
    ("lines", "size", lambda figure: figure.set_size_inches(8.0, 4.8), "the figure is now 8 × 4.8 in"),
    ("lines", "figure face", lambda figure: figure.set_facecolor("yellow"), "colour of background changed from white"),
    ("lines", "position", axes(lambda ax: ax.set_position((0.2, 0.2, 0.5, 0.5))), "the panel is now at"),
    ("lines", "rasterised away", axes(lambda ax: ax.set_visible(False)), "panel 'Step' is gone"),
    ("lines", "text", axes(lambda ax: ax.text(5, 0, "note")), "text 'note' at .5, 0. is new"),
    ("markers", "shape", on(line, marker="^"), "markers of curve 'measured' have another shape"),
    ("markers", "size", on(line, markersize=12), "markers of curve 'measured' are 2 times as large"),
    ("markers", "face", on(lambda ax: ax.lines[1], markerfacecolor="red"), "curve 'model' has a fill now"),
    ("markers", "edge", on(line, markeredgecolor="black"), "line colour of curve 'measured' changed from blue"),
    ("markers", "edge width", on(line, markeredgewidth=3), "line of curve 'measured' is 3 pt wide"),
    ("markers", "some of them", on(lambda ax: ax.lines[1], markevery=2), "choice of markers of curve 'model' is now 2"),
    ("markers", "legend title", axes(lambda ax: ax.get_legend().set_title("Else")), "title of the legend now reads 'Else'"),
    ("mark_every", "markevery", on(line, markevery=50), "line 1"),
    ("step_line", "where", axes(other_steps), "curve 'u'"),
    ("step_line", "plain", on(line, drawstyle="default"), "curve 'u'"),
    ("stairs", "values", axes(lambda ax: patch(ax).set_data([1, 3, 1])), "shape 1"),
    ("stems", "heads", on(line, marker="s"), "markers of curve 'line 1'"),
    ("straight", "slope", lambda figure: line(figure.axes[0]).set_slope(0.6), "slope"),
    ("straight", "span", on(patch, alpha=0.6), "opacity of curve 'shape 1' is now 0.6"),
    ("many_lines", "colours", on(collection, color="red"), "lines 1"),
    ("many_lines", "dashes", on(lambda ax: ax.collections[1], linestyle="solid"), "curve 'lines 2' is solid now"),
    ("error_bars", "caps", on(lambda ax: ax.lines[1], markersize=20), "markers of"),
    ("error_bars", "bars", on(collection, linewidth=4), "line of curve 'lines 1' is 4 pt wide"),
    ("noise", "another seed", other_noise, "curve 'line 1' (its|is|has)"),
    ("fast_sine", "another frequency", other_frequency, "curve 'line 1' oscillates 1.4"),
    ("spiral", "stretched", stretched, "curve 'line 1' (its|is)"),
    ("gap_colours", "gap", on(line, gapcolor="green"), "colour of curve 'line 1' changed from orange to"),
    ("text_effects", "stroke", on(words, path_effects=[]), "text 'outlined'"),
    ("text_effects", "shadow", on(line, path_effects=[]), "line 1"),
    # Points.
    ("scatter", "marker", axes(lambda ax: collection(ax).set_paths([Circle((0, 0), 1).get_path()])), "runs"),
    ("scatter", "size", on(collection, sizes=[100.0]), "markers of curve 'runs' are"),
    ("scatter", "colour", on(collection, color="red"), "colour of curve 'runs' changed from blue"),
    ("scatter", "place", axes(lambda ax: collection(ax).set_offsets(collection(ax).get_offsets() + 0.01)), "'runs' moved"),
    ("scatter_colours", "values", axes(lambda ax: collection(ax).set_array(np.linspace(0, 1, 30))), "values of curve"),
    ("scatter_colours", "sizes", on(collection, sizes=np.linspace(1, 90, 30)), "sizes of the markers of curve 'points 1'"),
    ("scatter_colours", "colour bar label", in_other_panel(1, lambda ax: ax.set_ylabel("x")), "label of the y axis is now 'x'"),
    ("scatter_many", "moved", axes(lambda ax: collection(ax).set_offsets(collection(ax).get_offsets()[::-1] * 1.01)), "points 1"),
    ("events", "places", axes(lambda ax: collection(ax).set_positions([1, 2, 5])), "lines 1"),
    ("event_collection", "length", on(collection, linelength=0.2), "(EventCollection|lines) 1"),
    ("hexbin", "colour map", on(collection, cmap="gray"), "colour map of area 1 is now gray"),
    ("hexbin", "limits", on(collection, clim=(0, 5)), "colours of area 1 now run from"),
    ("circle_collection", "sizes", on(collection, sizes=[80, 100]), "CircleCollection 1"),
    ("ellipse_collection", "angles", on(collection, angles=[0, 80]), "EllipseCollection 1"),
    ("polygon_collection", "places", axes(lambda ax: collection(ax).set_offsets([(0.2, 0.3), (0.6, 0.8)])), "RegularPoly"),
    # Bars and areas.
    ("bars", "category", lambda figure: figure.axes[0].set_xticks([0, 1, 2], ["PI", "PID", "ZN"]), "tick labels of the x axis are now|categories"),
    ("bars", "height", on(patch, height=3.2), "shape 1"),
    ("bars", "colour", on(patch, facecolor="red"), "colour of curve 'shape 1' changed"),
    ("bars_across", "hatch", on(patch, hatch="x"), "hatch of curve 'shape 1' is now x"),
    ("bar_labels", "label", on(words, text="3.1"), "text '3.0' now reads '3.1'"),
    ("bar_labels", "pad", on(words, position=(0, 30)), "offset of text '3.0' is now"),
    ("bars_across", "hatch width", axes(lambda ax: setattr(patch(ax), "_hatch_linewidth", 4.0)), "hatch of curve 'shape 1' is now .*4 pt"),
    ("bars_across", "hatch colour", axes(lambda ax: setattr(patch(ax), "_hatch_color", (1.0, 0.0, 0.0, 1.0))), "hatch of curve 'shape 1' is now .*#ff0000"),
    ("broken_bars", "colours", on(collection, facecolor=["C2", "C1"]), "one colour of curve 'area 1'"),
    ("histogram", "bin", on(patch, height=40.0), "shape 1"),
    ("histogram_steps", "colour", on(patch, edgecolor="red"), "colour of curve 'b' changed"),
    ("boxes", "box", on(patch, facecolor="red"), "colour of curve 'shape 1' changed"),
    ("boxes", "median", on(lambda ax: ax.lines[4], ydata=[0.5, 0.5]), "curve"),
    ("violins", "body", on(collection, facecolor="red"), "area 1"),
    ("filled", "band", on(collection, alpha=0.8), "opacity of curve 'band'"),
    ("filled", "hatch", on(lambda ax: ax.collections[1], hatch="x"), "hatch of curve 'area 2'"),
    ("stacked", "colour", on(collection, facecolor="red"), "colour of curve 'a' changed"),
    ("pie", "wedge", on(patch, theta2=170.0), "curve 'a' moved"),
    ("pie", "colour", on(patch, facecolor="red"), "colour of curve 'a' changed from blue to red"),
    # Images and meshes.
    ("image", "values", on(picture, data=Z * 1.1), "values of image 1 differ by at most .* % of the colour range, mostly around"),
    ("image", "extent", on(picture, extent=(-2, 2.2, -1.5, 1.5)), "image 1 now covers"),
    ("image", "colour map", on(picture, cmap="gray"), "colour map of image 1 is now gray"),
    ("image", "limits", on(picture, clim=(0, 0.5)), "colours of image 1 now run from 0 to 0.5"),
    ("image", "alpha", on(picture, alpha=0.5), "opacity of image 1 is now 0.5"),
    ("image", "opacities", on(picture, alpha=np.linspace(0, 1, 525).reshape(21, 25)), "opacities of image 1"),
    ("image", "turned", axes(lambda ax: picture(ax).set_transform(Affine2D().rotate_deg(3) + ax.transData)), "transform of image 1"),
    ("image", "interpolation", on(picture, interpolation="bilinear"), "interpolation of image 1 is now bilinear"),
    ("image_large", "one pixel", one_pixel, "values of image 1"),
    ("image_colours", "values", on(picture, data=np.zeros((21, 25, 3))), "values of image 1"),
    ("matrix", "values", on(picture, data=np.arange(12)[::-1].reshape(3, 4)), "values of image 1"),
    ("sparse", "pattern", on(line, xdata=[0, 1, 2, 3, 4, 4, 2, 3, 4, 5]), "line 1"),
    ("mesh", "values", on(collection, array=Z[::-1] * 0.9), "values of mesh 1"),
    ("mesh", "edges", on(collection, edgecolor="black"), "mesh 1"),
    ("mesh_log", "limits", on(collection, clim=(1e-2, 1.0)), "colours of mesh 1 now run"),
    ("mesh_smooth", "values", on(collection, array=Z * 1.1), "values of mesh 1"),
    ("pcolor", "values", on(collection, array=Z[1:8, 1:8]), "values of"),
    ("pcolorfast", "values", on(picture, data=Z * 0.9), "values of image 1"),
    ("colour_steps", "steps", axes(other_colour_steps), "colour scale of mesh 1 runs otherwise"),
    ("colour_steps", "colours", on(collection, cmap="viridis"), "colour map of mesh 1"),
    ("contours", "width", on(collection, linewidth=3), "line of contours is 3 pt wide"),
    ("contours", "colours", on(collection, cmap="gray"), "contours"),
    ("contours_filled", "colours", on(collection, cmap="gray"), "contours"),
    ("tri_lines", "colour", on(line, color="red"), "colour of curve 'line 1'"),
    ("tri_colours", "values", on(collection, array=np.linspace(0, 1, 45)), "(values|shape|now has|area|colours)"),
    ("tri_smooth", "colour map", on(collection, cmap="gray"), "colour map of TriMesh 1 is now gray"),
    # Arrows and shapes.
    ("quiver", "direction", axes(turned), "Quiver 1"),
    ("quiver", "key", lambda figure: figure.axes[0].artists[0].text.set_text("2 m/s"), "QuiverKey 1 now reads '2 m/s'"),
    ("barbs", "speed", axes(lambda ax: collection(ax).set_UVC([10, 20, 40], [5, 30, 10])), "Barbs 1"),
    ("stream", "colour", on(collection, color="red"), "colour"),
    ("shapes", "radius", on(patch, radius=0.12), "shape 1"),
    ("shapes", "turned", on(lambda ax: ax.patches[1], angle=25), "shape 2"),
    ("shapes", "hatch", on(lambda ax: ax.patches[1], hatch="o"), "hatch of curve 'shape 2'"),
    ("shapes", "fill", on(patch, fill=False), "curve 'shape 1'"),
    ("fancy", "style", on(patch, boxstyle="sawtooth"), "shape"),
    ("fancy", "arrow", lambda figure: figure.axes[0].patches[1].set_positions((0.1, 0.7), (0.9, 0.6)), "shape"),
    ("patch_collection", "values", on(collection, array=np.linspace(0, 1, 10)), "values of PatchCollection 1"),
    ("clipped", "image", axes(lambda ax: picture(ax).set_clip_path(Circle((0.5, 0.5), 0.4, transform=ax.transData))), "image 1 is clipped"),
    ("clipped", "line", axes(lambda ax: line(ax).set_clip_path(ax.patch)), "line 1' is clipped to its axes now"),
    # Texts.
    ("texts", "wrapped", on(words, wrap=True), "line breaks of text 'peak' are now"),
    ("texts", "effects", on(words, path_effects=[withSimplePatchShadow()]), "effects of text 'peak'"),
    ("texts", "words", on(words, text="dip"), "text 'peak' now reads 'dip'"),
    ("texts", "place", on(words, position=(0.3, 0.3)), "text 'peak' moved from"),
    ("texts", "rotation", on(words, rotation=60), "text 'peak' is turned by 60"),
    ("texts", "colour", on(words, color="red"), "colour of text 'peak' changed from purple"),
    ("texts", "size", on(words, fontsize=20), "text 'peak' has a size of 20"),
    ("texts", "alignment", on(words, ha="right"), "alignment of text 'peak' is now right"),
    ("texts", "box", on(lambda ax: ax.texts[0].get_bbox_patch(), facecolor="red"), "colour of box of text 'peak'"),
    ("texts", "box style", on(lambda ax: ax.texts[0].get_bbox_patch(), boxstyle="square"), "style of box of text 'peak' is now Square"),
    ("annotated", "twice the length", twice_as_long, "arrow of text ''.* moved"),
    ("annotated", "arrow style", on(lambda ax: ax.texts[0].arrow_patch, arrowstyle="-"), "arrow of text ''"),
    ("annotated", "arrow colour", on(lambda ax: ax.texts[0].arrow_patch, color="red"), "colour of arrow of text ''"),
    ("annotated", "offset", on(lambda ax: ax.texts[1], position=(60, 30)), "text 'peak'"),
    ("titles", "left", axes(lambda ax: ax.set_title("links", loc="left")), "titles .left, centre, right. are now"),
    ("two_legends", "second", axes(lambda ax: ax.artists[0].get_texts()[0].set_text("c")), "'c'"),
    ("two_legends", "second handle", axes(lambda ax: ax.artists[0].legend_handles[0].set_color("red")), "entry 'a'"),
    ("two_legends", "second gone", axes(lambda ax: ax.artists[0].remove()), "legend 1 is gone"),
    ("own_handles", "handle", axes(lambda ax: ax.get_legend().legend_handles[0].set_color("g")), "legend entry 'r'"),
    ("table", "cell", axes(lambda ax: ax.tables[0][1, 1].get_text().set_text("9")), "table 1, cell 1, 1 now reads '9'"),
    ("table", "cell colour", axes(lambda ax: ax.tables[0][1, 1].set_facecolor("red")), "table 1, cell 1, 1"),
    ("anchored", "words", axes(lambda ax: ax.artists[0].txt.set_text("corner!")), "AnchoredText 1 now reads"),
    ("anchored", "place", axes(lambda ax: setattr(ax.artists[1], "xybox", (0.3, 0.8))), "AnnotationBbox 1 moved"),
    # Axes.
    ("symlog", "a value doubled", axes(doubled(4)), "curve 'line 1'"),
    ("symlog", "threshold", axes(lambda ax: ax.set_xscale("symlog", linthresh=10.0)), "x axis"),
    ("logit", "a value doubled", axes(doubled(1)), "curve 'line 1' moved"),
    ("asinh", "a value doubled", axes(doubled(1)), "curve 'line 1' moved"),
    ("own_scale", "a value doubled", axes(doubled(1)), "curve 'line 1' moved"),
    ("log_log", "minor grid", axes(lambda ax: ax.grid(visible=False, which="minor")), "minor grid lines of the x axis are gone"),
    ("dates", "a day", axes(lambda ax: ax.lines[0].set_xdata([np.datetime64(f"2024-01-0{d}") for d in (1, 6, 9)])), "at x = 2024-01-0"),
    ("categories", "a value", on(line, ydata=[1, 3, 2.5]), "curve 'line 1' moved.* at x = 'MIGO'"),
    ("ticks", "places", axes(lambda ax: ax.set_xticks([0, 5, 10])), "tick labels of the x axis are now"),
    ("ticks", "labels", axes(lambda ax: ax.set_xticks([0, 5, 10], ["a", "b", "c"])), "tick labels of the x axis are now a, b, c"),
    ("ticks", "formatter", axes(lambda ax: ax.yaxis.set_major_formatter("{x:.0f}")), "tick labels of the y axis are now"),
    ("ticks", "direction", axes(lambda ax: ax.tick_params(direction="out")), "tick marks of the x axis"),
    ("ticks", "length", axes(lambda ax: ax.tick_params(length=12)), "tick marks of the x axis"),
    ("ticks", "minor", axes(lambda ax: ax.minorticks_off()), "minor tick marks of the x axis are gone"),
    ("ticks", "label size", axes(lambda ax: ax.tick_params(labelsize=16)), "tick labels of the x axis.* size of 16"),
    ("ticks", "label rotation", axes(lambda ax: ax.tick_params(labelrotation=90)), "tick labels of the x axis.* turned by 90"),
    ("ticks", "label colour", axes(lambda ax: ax.tick_params(labelcolor="red")), "colour of tick labels of the x axis"),
    ("ticks", "label pad", axes(lambda ax: ax.tick_params(pad=20)), "pad of tick labels of the x axis"),
    ("ticks", "sides", axes(lambda ax: ax.tick_params(top=True)), "tick marks of the x axis"),
    ("tick_format", "grid style", axes(lambda ax: ax.grid(axis="x", linestyle="--")), "grid lines of the x axis are dashed"),
    ("spines", "position", axes(lambda ax: ax.spines["left"].set_position(("data", 0.5))), "left spine moved"),
    ("hidden", "shown", axes(lambda ax: ax.set_axis_on()), "axes are now visible"),
    ("square", "aspect", axes(lambda ax: ax.set_aspect("auto")), "aspect"),
    ("two_scales", "second axis", in_other_panel(1, lambda ax: ax.set_ylim(0, 200)), "'panel 2': y axis now"),
    ("secondary", "label", axes(lambda ax: ax.child_axes[0].set_xlabel("gradians")), "label of the x axis is now 'gradians'"),
    ("secondary", "function", axes(lambda ax: ax.child_axes[0].set_functions((np.square, np.sqrt))), "x axis"),
    ("inset", "limits", axes(lambda ax: ax.child_axes[0].set_xlim(2, 4)), "'panel 2': x axis now ends at 4"),
    ("inset", "gone", axes(lambda ax: ax.child_axes[0].remove()), "panel 'panel 2' is gone"),
    ("inset", "indicator colour", lambda figure: set_indicator(figure, edgecolor="red"), "(InsetIndicator|shape) 1"),
    ("inset", "position", axes(lambda ax: ax.child_axes[0].set_axes_locator(lambda *_: Bbox.from_bounds(0.2, 0.2, 0.3, 0.3))), "the panel is now at"),
    ("polar", "angle", on(line, xdata=T + 0.05), "curve 'r' moved: .* angle = "),
    ("polar", "radius", on(line, ydata=T / 5.0 * 1.02), "curve 'r' moved"),
    ("polar", "bar", on(patch, width=0.5), "shape 1"),
    ("polar", "zero", axes(lambda ax: ax.set_theta_zero_location("N")), "zero of the angle"),
    ("polar", "direction", axes(lambda ax: ax.set_theta_direction(-1)), "direction of the angle"),
    ("polar", "radius limit", axes(lambda ax: ax.set_rmax(4.0)), "radius now runs over"),
    ("polar_wedge", "wedge", axes(lambda ax: ax.set_thetamax(150)), "(part of the circle|axis now|axes)"),
    ("globe", "line", on(line, ydata=[0.5, -0.1, 1.0]), "line 1 moved"),
    ("globe", "grid", axes(lambda ax: ax.grid(visible=False)), "grid lines"),
    ("solid_lines", "view", axes(lambda ax: ax.view_init(elev=50)), "view"),
    ("solid_lines", "line", axes(lambda ax: line(ax).set_3d_properties(T * 0.9)), "helix moved"),
    ("solid_lines", "points", axes(lambda ax: collection(ax).set_sizes([80])), "Path3DCollection 1"),
    ("solid_lines", "label", axes(lambda ax: ax.set_zlabel("depth")), "zlabel is now 'depth'|label of the z axis"),
    ("solid_lines", "limits", axes(lambda ax: ax.set_zlim(0, 20)), "zlim is now|z axis"),
    ("solid_lines", "text", axes(lambda ax: words(ax).set_text("there")), "'there'"),
    ("solid_surface", "colour", on(collection, cmap="gray"), "Poly3DCollection 1"),
    ("solid_bars", "colour", on(collection, facecolor="red"), "colour.* of Poly3DCollection 1"),
    ("solid_wires", "width", on(collection, linewidth=3), "3 pt wide"),
    # Figures.
    ("panels", "title", lambda figure: figure.suptitle("Five cases"), "figure title is now 'Five cases'"),
    ("panels", "title colour", lambda figure: figure.suptitle("Four cases", color="red"), "colour of figure title changed"),
    ("panels", "label", lambda figure: figure.supxlabel("hours"), "hours"),
    ("panels", "space", lambda figure: figure.subplots_adjust(hspace=0.8), "the panel is now at"),
    ("constrained", "ratio", lambda figure: figure.axes[0].get_subplotspec().get_gridspec().set_width_ratios([1, 2]), "the panel"),
    ("sub_figures", "title", lambda figure: figure.subfigs[0].suptitle("links"), "title of sub-figure 1 now reads 'links'"),
    ("sub_figures", "face", lambda figure: figure.subfigs[1].set_facecolor("yellow"), "background of sub-figure 2 changed from light grey to yellow"),
    ("figure_artists", "note moved", lambda figure: figure.texts[0].set_position((0.2, 0.9)), "text 'note' moved"),
    ("figure_artists", "note", lambda figure: figure.texts[0].set_text("other note"), "text 'note' now reads 'other note'"),
    ("figure_artists", "line", lambda figure: figure.artists[0].set_ydata([0.08, 0.08]), "line 1 moved"),
    ("figure_artists", "line colour", lambda figure: figure.artists[0].set_color("b"), "colour of line 1 changed"),
    ("figure_artists", "box", lambda figure: figure.artists[1].set_x(0.5), "shape 1 moved"),
    ("figure_artists", "picture", lambda figure: figure.images[0].set_data(np.eye(20)), "image 1"),
    ("figure_artists", "legend", lambda figure: figure.legends[0].set_visible(False), "legend"),
    ("figure_artists", "new line", lambda figure: figure.add_artist(Line2D([0, 1], [0, 1])), "line 2 is new"),
    ("connected", "end", lambda figure: setattr(figure.artists[0], "xy2", (0.9, 0.9)), "shape 1 moved"),
    ("no_axes", "words", lambda figure: figure.texts[0].set_text("something"), "something"),
]  # fmt: skip


def coloured(over: str) -> Any:
    return colormaps["viridis"].with_extremes(over=over)


#: Two figures that differ in one property, and what is said of it.
PAIRS: list[tuple[str, Callable[[Any, Any], object], tuple[Any, Any], str]] = [
    ("edges of a table", lambda ax, v: ax.table([["1"]], edges=v), ("closed", "horizontal"), "lines of table 1, cell 0, 0"),
    ("head of an arrow", lambda ax, v: ax.annotate("a", (0.2, 0.2), (0.6, 0.6), arrowprops={"arrowstyle": f"->,head_width={v}"}), (0.2, 0.8), "shape of arrow of text 'a' is now head_width=0.8"),
    ("width of an arrow", lambda ax, v: ax.annotate("a", (0.2, 0.2), (0.6, 0.6), arrowprops={"width": v}), (3, 6), "shape of arrow of text 'a' is now .*tail_width=0.6"),
    ("length of handles", lambda ax, v: ax.legend(ax.plot([0, 1]), ["a"], handlelength=v), (2, 4), "length of the handles of legend is now 4"),
    ("side of handles", lambda ax, v: ax.legend(ax.plot([0, 1]), ["a"], markerfirst=v), (True, False), "place of the handles of legend is now behind"),
    ("place of a label", lambda ax, v: (ax.set_xlabel("t"), ax.xaxis.set_label_coords(0.5, v)), (-0.1, -0.2), "place of label of the x axis is now .0.5, -0.2."),
    ("side of the title", lambda ax, v: ax.set_title("t", loc=v), ("center", "left"), "title is now at the left .was in the centre"),
    ("turned about", lambda ax, v: ax.text(0.5, 0.5, "words", rotation=45, rotation_mode=v), ("default", "anchor"), "turning of text 'words'"),
    ("clip of a text", lambda ax, v: ax.text(0.9, 0.5, "many words", clip_on=v), (False, True), "clipping of text 'many words'"),
    ("clip of a note", lambda ax, v: ax.annotate("a", (1.2, 0.2), annotation_clip=v), (False, True), "^text 'a' at .1.2, 0.2. is gone$"),
    ("colour above", lambda ax, v: ax.imshow(Z, cmap=coloured(v), vmax=0.5), ("k", "r"), "colour of values above the range of image 1 changed from black to red"),
    ("missing value", lambda ax, v: ax.imshow([[1.0, 2.0], [3.0, v]], vmin=0, vmax=4), (4.0, np.nan), "image 1 now leaves out 1 value "),
    ("shape of a clip", lambda ax, v: ax.plot([0, 1])[0].set_clip_path(Circle((0, 0), v, transform=ax.transData)), (0.5, 0.6), "the shape to which curve 'line 1' is clipped changed"),
    ("dashes below zero", lambda ax, v: ax.contour(X, Y, Z - 0.2, [-0.1, 0.1], colors="k", negative_linestyles=v), ("dashed", "dotted"), "dashes of contours changed"),
    ("coordinates of a text", lambda ax, v: (ax.set_xlim(0, 2), ax.text(0.5, 0.5, "w", transform=getattr(ax, v))), ("transData", "transAxes"), "text 'w' moved from .0.5, 0.5. of the data to .0.5, 0.5. of the axes"),
    ("twin on top", lambda ax, v: (ax.twinx().plot([1, 0]), ax.plot([0, 1]), ax.set_zorder(v)), (0, 1), "panel 'panel 1' is drawn over panel 'panel 2' now"),
    ("inset below", lambda ax, v: (ax.plot([0, 1], label="a"), ax.inset_axes((0.3, 0.3, 0.4, 0.4), zorder=v)), (5, 1), "curve 'a' is drawn over panel 'panel 2' now"),
    ("shape on top", lambda ax, v: ax.figure.add_artist(Circle((0.5, 0.5), 0.2, zorder=v)), (-1, 9), "shape 1 is drawn over panel 'panel 1' now"),
    ("pad of a box", lambda ax, v: ax.text(0.5, 0.5, "a", bbox={"boxstyle": f"round,pad={v}"}), (0.3, 0.4), "shape of box of text 'a' is now pad=0.4"),
    ("ticked line", lambda ax, v: ax.plot([0, 1], path_effects=[TickedStroke(angle=v)]), (60, 90), "path effects of curve 'line 1' are now .TickedStroke angle=90"),
    ("gap in a straight line", lambda ax, v: ax.plot([0, 1, 2, 3, 4], [0, 1, v, 3, 4]), (2, np.nan), "^curve 'line 1' now has a gap from x = 1.001 to 2.999$"),
    ("frameless legend", lambda ax, v: ax.legend(ax.plot([0, 1]), ["a"], frameon=False, loc=v), ("upper left", "lower right"), "^place of legend is now lower right .was upper left.$"),
    ("frame of a legend", lambda ax, v: ax.legend(ax.plot([0, 1]), ["a"], frameon=v), (True, False), "^frame of legend is now none .was automatic.$"),
    ("title of a legend", lambda ax, v: ax.legend(ax.plot([0, 1]), ["many words"], title="a", alignment=v), ("center", "left"), "^alignment of legend is now left"),
    ("large point beside the axes", lambda ax, v: (ax.set(xlim=(0, 1), ylim=(0, 1)), ax.scatter([0.5, v], [0.5, 0.5], s=4000)), (7, 1.04), "^curve 'points 1' now has 2 points .was 1.$"),
    ("outlined word", lambda ax, v: ax.text(0.5, 0.5, "a", color=v, path_effects=[withStroke(linewidth=3)]), ("k", "r"), "^colour of text 'a' changed from black to red$"),
    ("outlined labels", lambda ax, v: [text.set_path_effects([withStroke(foreground=v)]) for text in ax.get_xticklabels()], ("w", "r"), "path effects of tick labels of the x axis are now .withStroke foreground=#ff0000"),
    ("nothing on a log axis", lambda ax, v: (ax.plot([1, 0, 10]), ax.set_yscale("log", nonpositive=v)), ("clip", "mask"), "^curve 'line 1' now has a gap"),
    ("angles", lambda ax, v: ax.figure.add_subplot(projection="polar").set_thetamax(v), (180, 150), "angle now ends at 150° .was 180°.$"),
    ("points in a legend", lambda ax, v: ax.legend(ax.plot([0, 1], "o"), ["a"], numpoints=v), (1, 2), "number of markers on each line of legend is now 2"),
    ("wide legend", lambda ax, v: ax.legend(ax.plot([0, 1]), ["a"], mode=v), (None, "expand"), "width of legend is now expanded"),
    ("legend outside", lambda ax, v: ax.figure.legend(ax.plot([0, 1]), ["a"], loc=f"{v}upper right"), ("", "outside "), "place outside the axes of legend is now upper"),
    ("height of cells", lambda ax, v: ax.table([["1"]]).scale(1, v), (1, 1.4), "height of table 1, cell 0, 0 is now"),
    ("side of a label", lambda ax, v: (ax.set_ylabel("t"), ax.yaxis.set_label_position(v)), ("left", "right"), "side of label of the y axis is now right"),
    ("one tick label", lambda ax, v: (ax.set_xticks([0, 1]), ax.get_xticklabels()[1].set_color(v)), ("k", "r"), "^colour of tick labels of the x axis changed from black to red: '1'$"),
    ("shape of points", lambda ax, v: ax.scatter([1, 2], [2, 1], marker=v, color="b"), ("o", "H"), "markers of curve 'points 1' have another shape"),
    ("square points", lambda ax, v: ax.scatter([1, 2], [2, 1], s=[20, 30], marker=v), ("o", "s"), "markers of curve 'points 1' have another shape"),
    ("point or dot", lambda ax, v: ax.scatter([1, 2], [2, 1], s=[20, 30], marker=v), ("o", "."), "sizes of the markers of curve 'points 1' changed"),
    ("shapes of points", lambda ax, v: ax.scatter([1, 2], [2, 1]).set_paths([MarkerStyle(one).get_path() for one in v]), ("os", "o^"), "markers of curve 'points 1' have other shapes"),
    ("a marker of points", lambda ax, v: ax.plot([0, 1], marker=[(-1, -1), (1, v)]), (1, 0.5), "markers of curve 'line 1' have another shape"),
    ("points of one colour", lambda ax, v: ax.scatter([1, 2], [2, 1], color=v), (("r", "r"), ("r", "b")), "colours of curve 'points 1' changed"),
    ("area that moves", lambda ax, v: ax.fill_between([0, 1, 2], [0, v, 1]), (0.5, 0.9), "^curve 'area 1' moved"),
    ("image on the axes", lambda ax, v: (ax.set_xlim(0, 2), ax.imshow([[0, 1]], transform=getattr(ax, v), extent=(0, 1, 0, 1))), ("transData", "transAxes"), "coordinates of image 1 is now fractions of the axes"),
    ("dates", lambda ax, v: ax.set_xlim(np.datetime64("2024-01-01"), np.datetime64(v)), ("2024-03-01", "2024-03-02"), "^x axis now ends at 2024-03-02 .was 2024-03-01.$"),
    ("second straight line", lambda ax, v: (ax.plot([0, 1]), ax.axline((0, 0), slope=v)), (0.5, 0.6), "^line 2 moved"),
    ("words in space", lambda ax, v: ax.figure.add_subplot(projection="3d").text(0.5, 0.5, v, "w"), (0.5, 0.6), "text 'w' moved by up to"),
]  # fmt: skip


@pytest.mark.parametrize(("draw", "values", "said"), [pair[1:] for pair in PAIRS], ids=[pair[0] for pair in PAIRS])
def test_one_property_of_two_figures_is_named(
    draw: Callable[[Any, Any], object], values: tuple[Any, Any], said: str
) -> None:
    def shown(value: Any) -> Record:
        figure = Figure()
        draw(figure.subplots(), value)
        return Record.from_json(capture(figure).to_json())

    first = shown(values[0])
    assert compare(first, shown(values[0])).changes == []
    changes = compare(first, shown(values[1])).changes
    assert any(re.search(said, text) for text in changes), changes


def two(axes: Any, kind: str, *, turned: bool) -> None:
    """Draw two things that do not overlap, in one order or in the other."""
    axes.set(xlim=(0, 4), ylim=(0, 4))
    first, second = ([0, 1], "C0"), ([2, 3], "C1")
    for x, colour in (second, first) if turned else (first, second):
        if kind == "lines":
            axes.plot(x, x, color=colour)
        elif kind == "labelled":
            axes.plot(x, x, color=colour, label=colour)
        elif kind == "shapes":
            axes.add_patch(Circle((x[0] + 0.5, x[0] + 0.5), 0.4, color=colour))
        else:
            axes.text(x[0], x[0], colour)


@pytest.mark.parametrize("kind", ["lines", "labelled", "shapes", "texts"])
def test_the_order_of_what_does_not_overlap_is_not_seen(kind: str) -> None:
    figures = Figure(), Figure()
    for figure, other_order in zip(figures, (False, True), strict=True):
        two(figure.subplots(), kind, turned=other_order)
    assert compare(*map(capture, figures)).changes == []


def test_the_order_of_what_overlaps_is() -> None:
    figures = Figure(), Figure()
    for figure, order in zip(figures, (("C0", "C1"), ("C1", "C0")), strict=True):
        axes = figure.subplots()
        for colour in order:
            axes.add_patch(Circle((0.5 + 0.1 * int(colour[1]), 0.5), 0.3, color=colour, label=colour))
    assert compare(*map(capture, figures)).changes == ["curve 'C1' is drawn below curve 'C0' now"]


def test_a_curve_less_is_said_of_that_curve_though_the_others_are_numbered_anew() -> None:
    figures = Figure(), Figure()
    for figure, slopes in zip(figures, ((1, 2, 3), (2, 3)), strict=True):
        axes = figure.subplots()
        axes.set_ylim(0, 3)
        for slope in slopes:
            axes.plot([0, 1], [0, slope], color="k")
    assert compare(*map(capture, figures)).changes == ["curve 'line 1' is missing"]


def test_an_area_that_ends_at_the_axes_may_round_to_either_side() -> None:
    x, y = np.meshgrid(*2 * [np.linspace(0.0, 10.0, 50)])
    figures = Figure(), Figure()
    for figure, factor in zip(figures, (1.0, 1.0 + 1e-10), strict=True):
        figure.subplots().contourf(x, y, np.sin(x) * np.cos(y) * factor)
    assert compare(*map(capture, figures)).changes == []


def test_records_that_number_the_parts_of_sub_figures_are_read() -> None:
    record = re.sub(r"background of sub-figure (\d)", r"shape \1", accepted("sub_figures").to_json())
    older = Record.from_json(record.replace("title of sub-figure 1", "text 'left part'"))
    assert compare(older, capture(drawn("sub_figures"))).changes == []


def set_indicator(figure: Figure, **properties: Any) -> None:
    for artist in figure.axes[0].get_children():
        if type(artist).__name__ == "InsetIndicator" or artist in figure.axes[0].patches:
            artist.set(**properties)


@pytest.mark.parametrize(("name", "what", "change", "said"), ALARMS, ids=[f"{a[0]}-{a[1]}" for a in ALARMS])
def test_the_alarm_rings_and_names_it(name: str, what: str, change: Change, said: str) -> None:
    figure = drawn(name)
    change(figure)
    changes = compare(accepted(name), capture(figure)).changes
    assert changes, f"{what} of {name} changed in silence"
    assert any(re.search(said, text) for text in changes), changes
    assert all("\n" not in text for text in changes)


@pytest.mark.parametrize("name", GALLERY)
def test_a_figure_drawn_again_is_the_same(name: str) -> None:
    figure = drawn(name)
    figure.set_dpi(157.0)
    new = capture(figure)
    assert compare(accepted(name), new).changes == []
    assert new.to_json() == accepted(name).to_json()
    assert len(new.to_json()) < 60_000


@pytest.mark.parametrize(
    ("words", "properties", "said"),
    [
        ("one\nlonger", {"linespacing": 3.0}, "line spacing of text 'one longer' is now 3"),
        ("one\nlonger", {"multialignment": "right"}, "alignment of the lines of text 'one longer' is now right"),
        ("$x^2$", {"parse_math": False}, "mathematics of text '.x.2.' is now as it is written"),
    ],
)
def test_how_a_text_is_set_is_said(words: str, properties: dict[str, Any], said: str) -> None:
    def shown(**given: Any) -> Record:
        figure = Figure()
        figure.subplots().text(0.2, 0.5, words, **given)
        return capture(figure)

    assert any(re.search(said, text) for text in compare(shown(), shown(**properties)).changes)

"""About a hundred figures, one for each kind of thing that matplotlib draws; drift and alarm tests share them.

Each function draws on an empty figure, always the same.
"""

from __future__ import annotations

import datetime as dt
from collections.abc import Callable
from typing import Any

import numpy as np
from matplotlib import patheffects
from matplotlib.collections import (
    CircleCollection,
    EllipseCollection,
    EventCollection,
    LineCollection,
    PatchCollection,
    RegularPolyCollection,
)
from matplotlib.colors import BoundaryNorm, ListedColormap, LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.offsetbox import AnchoredText, AnnotationBbox, OffsetImage, TextArea
from matplotlib.patches import (
    Arc,
    Arrow,
    Circle,
    ConnectionPatch,
    Ellipse,
    FancyArrowPatch,
    FancyBboxPatch,
    PathPatch,
    Polygon,
    Rectangle,
    RegularPolygon,
    Wedge,
)
from matplotlib.path import Path
from matplotlib.sankey import Sankey
from matplotlib.ticker import FormatStrFormatter, FuncFormatter, MultipleLocator
from matplotlib.tri import Triangulation

Draw = Callable[[Figure], None]
GALLERY: dict[str, Draw] = {}

T = np.linspace(0.0, 10.0, 501)
X, Y = np.meshgrid(np.linspace(-2.0, 2.0, 25), np.linspace(-1.5, 1.5, 21))
Z = np.exp(-(X**2) - Y**2) * (1.0 + X)
RANDOM = np.random.default_rng(7)
NOISE = RANDOM.standard_normal(100_000)
CLOUD = RANDOM.standard_normal((2, 1500))
FEW = RANDOM.random((4, 30))


def figure(draw: Callable[[Any], object]) -> Draw:
    """Register a function that draws on axes."""

    def on_axes(fig: Figure) -> None:
        draw(fig.subplots())

    GALLERY[draw.__name__] = on_axes
    return on_axes


def whole(draw: Callable[[Figure], object]) -> Draw:
    """Register a function that draws on a figure."""

    def on_figure(fig: Figure) -> None:
        draw(fig)

    GALLERY[draw.__name__] = on_figure
    return on_figure


# ------------------------------------------------------------------------------------------------- lines


@figure
def lines(axes: Any) -> None:
    axes.plot(T, np.sin(T), label="ZN")
    axes.plot(T, np.cos(T), "--", label="PA")
    axes.set(xlabel="time $t$", ylabel="output", title="Step")
    axes.legend()


@figure
def markers(axes: Any) -> None:
    axes.plot([1, 2, 3], [1, 3, 2], "o-", label="measured")
    axes.plot([1, 2, 3], [2, 1, 3], "s", markerfacecolor="none", label="model")
    axes.legend(title="What")


@figure
def step_line(axes: Any) -> None:
    axes.step([0, 1, 2, 3], [0, 2, 1, 3], where="post", label="u")


@figure
def stairs(axes: Any) -> None:
    axes.stairs([1, 3, 2], [0, 1, 2, 4], fill=True)


@figure
def stems(axes: Any) -> None:
    axes.stem([1, 2, 3], [2, 1, 3])


@figure
def straight(axes: Any) -> None:
    axes.axline((0.2, 0.1), slope=0.5, label="slope")
    axes.axhline(0.3, color="red")
    axes.axvline(0.6, linestyle=":")
    axes.axhspan(0.5, 0.6, alpha=0.3)
    axes.axvspan(0.1, 0.2, color="green", alpha=0.3)


@figure
def many_lines(axes: Any) -> None:
    axes.add_collection(LineCollection([[(0, i), (1, i + 0.5)] for i in range(5)], colors=["C0", "C1"]))
    axes.hlines([1.5, 2.5], 0, 1, colors="k", linestyles="dashed")
    axes.vlines([0.2, 0.8], 0, 5)
    axes.set_ylim(0, 6)


@figure
def error_bars(axes: Any) -> None:
    axes.errorbar([1, 2, 3], [2, 3, 1], yerr=[0.2, 0.3, 0.1], xerr=0.1, capsize=3, label="e")


@figure
def gaps(axes: Any) -> None:
    axes.plot(T, np.where(np.abs(T - 5.0) < 1.0, np.nan, T))


@figure
def noise(axes: Any) -> None:
    axes.plot(NOISE)


@figure
def fast_sine(axes: Any) -> None:
    t = np.linspace(0.0, 1.0, 100_000)
    axes.plot(t, np.sin(2.0 * np.pi * 900.0 * t))


@figure
def spiral(axes: Any) -> None:
    angle = np.linspace(0.0, 120.0 * np.pi, 60_000)
    axes.plot(angle * np.cos(angle), angle * np.sin(angle))
    axes.set(xlim=(-400, 400), ylim=(-400, 400))


@figure
def text_effects(axes: Any) -> None:
    axes.text(0.5, 0.5, "outlined", path_effects=[patheffects.withStroke(linewidth=3, foreground="red")])
    axes.plot([0, 1], path_effects=[patheffects.SimpleLineShadow(), patheffects.Normal()])


@figure
def gap_colours(axes: Any) -> None:
    axes.plot([0, 1], [0, 1], "--", gapcolor="orange", linewidth=4)


@figure
def mark_every(axes: Any) -> None:
    axes.plot(T, np.sin(T), "-o", markevery=100)


# ------------------------------------------------------------------------------------------------ points


@figure
def scatter(axes: Any) -> None:
    axes.scatter(FEW[0], FEW[1], label="runs")


@figure
def scatter_colours(axes: Any) -> None:
    points = axes.scatter(FEW[0], FEW[1], c=FEW[2], s=100.0 * FEW[3])
    axes.figure.colorbar(points, label="value")


@figure
def scatter_many(axes: Any) -> None:
    axes.scatter(*CLOUD, s=2)


@figure
def events(axes: Any) -> None:
    axes.eventplot([[1, 2, 4], [2, 3, 5]], colors=["C0", "C1"])


@figure
def event_collection(axes: Any) -> None:
    axes.set(xlim=(0, 1), ylim=(0, 1))
    axes.add_collection(EventCollection([0.2, 0.5, 0.9], linelength=0.1))


@figure
def hexbin(axes: Any) -> None:
    axes.hexbin(*CLOUD, gridsize=12)


@figure
def circle_collection(axes: Any) -> None:
    axes.set(xlim=(0, 1), ylim=(0, 1))
    axes.add_collection(CircleCollection([50, 100], offsets=[(0.2, 0.3), (0.6, 0.7)], offset_transform=axes.transData))


@figure
def ellipse_collection(axes: Any) -> None:
    axes.set(xlim=(0, 1), ylim=(0, 1))
    places = [(0.2, 0.3), (0.6, 0.7)]
    axes.add_collection(
        EllipseCollection([0.1, 0.2], 0.1, [0, 45], units="x", offsets=places, offset_transform=axes.transData)
    )


@figure
def polygon_collection(axes: Any) -> None:
    axes.set(xlim=(0, 1), ylim=(0, 1))
    places = [(0.2, 0.3), (0.6, 0.7)]
    axes.add_collection(RegularPolyCollection(5, sizes=(80,), offsets=places, offset_transform=axes.transData))


# ------------------------------------------------------------------------------------------ bars and areas


@figure
def bars(axes: Any) -> None:
    axes.bar(["PI", "PID", "PA"], [3, 1, 2], label="cost")


@figure
def bars_across(axes: Any) -> None:
    axes.barh([1, 2, 3], [3, 1, 2], hatch="//", edgecolor="black")


@figure
def bar_labels(axes: Any) -> None:
    axes.bar_label(axes.bar([1, 2], [3, 4]), fmt="%.1f")


@figure
def broken_bars(axes: Any) -> None:
    axes.broken_barh([(1, 2), (4, 1)], (0, 1), facecolors=("C0", "C1"))


@figure
def histogram(axes: Any) -> None:
    axes.hist(NOISE[:500], bins=12)


@figure
def histogram_steps(axes: Any) -> None:
    axes.hist([NOISE[:500], NOISE[500:900]], bins=8, histtype="step", label=["a", "b"])


@figure
def histogram_plane(axes: Any) -> None:
    axes.hist2d(*CLOUD, bins=10)


@figure
def boxes(axes: Any) -> None:
    axes.boxplot([NOISE[:50], NOISE[50:120]], patch_artist=True)


@figure
def violins(axes: Any) -> None:
    axes.violinplot([NOISE[:80], NOISE[80:200]])


@figure
def filled(axes: Any) -> None:
    axes.fill_between(T, np.sin(T), 0.0, alpha=0.4, label="band")
    axes.fill_betweenx([0, 1], [2, 3], [4, 5], hatch="..")


@figure
def filled_shape(axes: Any) -> None:
    axes.fill([0, 1, 0.5], [0, 0, 1], "g")


@figure
def stacked(axes: Any) -> None:
    axes.stackplot([0, 1, 2], [[1, 2, 1], [2, 1, 2]], labels=["a", "b"])


@figure
def pie(axes: Any) -> None:
    axes.pie([3, 2, 1], labels=["a", "b", "c"], autopct="%.0f", explode=[0, 0.1, 0])


# --------------------------------------------------------------------------------------- images and meshes


@figure
def image(axes: Any) -> None:
    axes.figure.colorbar(axes.imshow(Z, extent=(-2, 2, -1.5, 1.5), origin="lower"))


@figure
def image_large(axes: Any) -> None:
    axes.imshow(np.add.outer(np.arange(300.0), np.arange(200.0) ** 1.1))


@figure
def image_colours(axes: Any) -> None:
    axes.imshow(np.dstack([Z / Z.max(), 1.0 - Z / Z.max(), np.full_like(Z, 0.5)]).clip(0, 1))


@figure
def matrix(axes: Any) -> None:
    axes.matshow(np.arange(12).reshape(3, 4))


@figure
def sparse(axes: Any) -> None:
    axes.spy(np.eye(6) + np.eye(6, k=2), markersize=4)


@figure
def mesh(axes: Any) -> None:
    axes.pcolormesh(X, Y, Z, shading="auto", cmap="plasma")


@figure
def mesh_log(axes: Any) -> None:
    axes.figure.colorbar(axes.pcolormesh(X, Y, np.abs(Z) + 1e-3, shading="nearest", norm=LogNorm()))


@figure
def mesh_smooth(axes: Any) -> None:
    axes.pcolormesh(X, Y, Z, shading="gouraud")


@figure
def pcolor(axes: Any) -> None:
    axes.pcolor(X[:8, :8], Y[:8, :8], Z[:7, :7])


@figure
def pcolorfast(axes: Any) -> None:
    axes.pcolorfast((0, 4), (0, 3), Z)


@figure
def colour_steps(axes: Any) -> None:
    norm = BoundaryNorm([0, 0.25, 0.5, 1.0], 3)
    axes.pcolormesh(np.abs(Z), cmap=ListedColormap(["red", "green", "blue"]), norm=norm)


@figure
def contours(axes: Any) -> None:
    axes.contour(X, Y, Z, levels=6)


@figure
def contours_filled(axes: Any) -> None:
    axes.figure.colorbar(axes.contourf(X, Y, Z, levels=6))


@figure
def contour_labels(axes: Any) -> None:
    axes.clabel(axes.contour(X, Y, Z, levels=4))


@figure
def spectrogram(axes: Any) -> None:
    axes.specgram(NOISE[:4000], Fs=100.0)


# ------------------------------------------------------------------------------------ triangles and arrows


def triangles() -> Triangulation:
    return Triangulation(FEW[0], FEW[1])


@figure
def tri_lines(axes: Any) -> None:
    axes.triplot(triangles())


@figure
def tri_colours(axes: Any) -> None:
    axes.tripcolor(triangles(), FEW[2])


@figure
def tri_smooth(axes: Any) -> None:
    axes.tripcolor(triangles(), FEW[2], shading="gouraud")


@figure
def tri_contours(axes: Any) -> None:
    axes.tricontourf(triangles(), FEW[2], levels=4)


@figure
def quiver(axes: Any) -> None:
    arrows = axes.quiver(X[::4, ::4], Y[::4, ::4], Y[::4, ::4], -X[::4, ::4])
    axes.quiverkey(arrows, 0.9, 1.05, 1.0, "1 m/s")


@figure
def barbs(axes: Any) -> None:
    axes.barbs([0, 1, 2], [0, 1, 0], [10, 20, 50], [5, 30, 10])


@figure
def stream(axes: Any) -> None:
    axes.streamplot(X, Y, Y, -X, density=0.4)


@figure
def arrow(axes: Any) -> None:
    axes.arrow(0.1, 0.1, 0.5, 0.4, width=0.02)


# ------------------------------------------------------------------------------------------------ shapes


@figure
def shapes(axes: Any) -> None:
    for shape in (
        Circle((0.2, 0.2), 0.1),
        Rectangle((0.4, 0.1), 0.2, 0.3, angle=20, hatch="x"),
        Ellipse((0.8, 0.2), 0.3, 0.1, angle=30),
        Wedge((0.2, 0.7), 0.15, 30, 270, width=0.05),
        Polygon([(0.4, 0.6), (0.6, 0.6), (0.5, 0.9)], closed=True),
        RegularPolygon((0.8, 0.7), 6, radius=0.12),
        Arc((0.5, 0.5), 0.6, 0.4, theta1=20, theta2=150),
        Arrow(0.1, 0.45, 0.3, 0.05, width=0.1),
    ):
        axes.add_patch(shape)


@figure
def fancy(axes: Any) -> None:
    axes.add_patch(FancyBboxPatch((0.2, 0.2), 0.3, 0.2, boxstyle="round,pad=0.05"))
    axes.add_patch(FancyArrowPatch((0.1, 0.8), (0.9, 0.6), arrowstyle="->", mutation_scale=20))


@figure
def own_path(axes: Any) -> None:
    axes.add_patch(PathPatch(Path([(0.1, 0.1), (0.1, 0.9), (0.9, 0.9), (0.9, 0.1)], [1, 4, 4, 4]), fill=False))


@figure
def patch_collection(axes: Any) -> None:
    axes.set(xlim=(0, 1), ylim=(0, 1))
    collection = PatchCollection([Circle((x, y), 0.05) for x, y in FEW[:2].T[:10]])
    collection.set_array(FEW[2, :10])
    axes.add_collection(collection)


@figure
def clipped(axes: Any) -> None:
    picture = axes.imshow(Z, extent=(0, 1, 0, 1))
    picture.set_clip_path(Circle((0.5, 0.5), 0.3, transform=axes.transData))
    line = axes.plot([0, 1], [0, 1], color="white")[0]
    line.set_clip_path(Circle((0.5, 0.5), 0.2, transform=axes.transData))


# ------------------------------------------------------------------------------------------ texts, legends


@figure
def texts(axes: Any) -> None:
    axes.text(0.2, 0.3, "peak", rotation=30, color="purple", bbox={"boxstyle": "round", "facecolor": "wheat"})
    axes.text(0.5, 0.9, "above", transform=axes.transAxes, ha="center")


@figure
def annotated(axes: Any) -> None:
    axes.annotate("", xy=(0.2, 0.3), xytext=(0.7, 0.3), arrowprops={"arrowstyle": "<->"})
    axes.annotate("peak", xy=(0.5, 0.5), xytext=(20, 30), textcoords="offset points", arrowprops={"arrowstyle": "->"})


@figure
def titles(axes: Any) -> None:
    axes.set_title("left", loc="left")
    axes.set_title("centre")
    axes.set_title("right", loc="right")


@figure
def two_legends(axes: Any) -> None:
    first, second = axes.plot([0, 1], label="a")[0], axes.plot([1, 0], label="b")[0]
    axes.add_artist(axes.legend(handles=[first], loc="upper left"))
    axes.legend(handles=[second], loc="lower right", title="second", ncols=1)


@figure
def own_handles(axes: Any) -> None:
    axes.legend(handles=[Line2D([], [], color="red", label="r"), Rectangle((0, 0), 1, 1, color="b", label="b")])


@figure
def table(axes: Any) -> None:
    axes.table([["1", "2"], ["3", "4"]], rowLabels=["a", "b"], colLabels=["x", "y"], loc="center")


@figure
def anchored(axes: Any) -> None:
    axes.add_artist(AnchoredText("corner", loc="lower left"))
    axes.add_artist(AnnotationBbox(TextArea("boxed"), (0.5, 0.5), xybox=(0.7, 0.8)))
    axes.add_artist(AnnotationBbox(OffsetImage(np.eye(8), zoom=2), (0.2, 0.7)))


# --------------------------------------------------------------------------------------- axes of all kinds


@figure
def log_log(axes: Any) -> None:
    w = np.logspace(-2, 2, 200)
    axes.loglog(w, 1.0 / np.hypot(1.0, w))
    axes.grid(which="both")


@figure
def symlog(axes: Any) -> None:
    axes.plot([-100, -1, 0, 1, 100], [1, 2, 3, 4, 5])
    axes.set_xscale("symlog", linthresh=1.0)


@figure
def logit(axes: Any) -> None:
    axes.plot([0.01, 0.2, 0.5, 0.9, 0.999], [1, 2, 3, 4, 5])
    axes.set_xscale("logit")


@figure
def asinh(axes: Any) -> None:
    axes.plot([-100, -1, 0, 1, 100], [1, 2, 3, 4, 5])
    axes.set_xscale("asinh")


@figure
def own_scale(axes: Any) -> None:
    axes.plot([1, 4, 9], [1, 2, 3])
    axes.set_xscale("function", functions=(np.sqrt, np.square))


@figure
def dates(axes: Any) -> None:
    axes.plot([dt.datetime(2024, 1, day) for day in (1, 5, 9)], [1, 3, 2])  # noqa: DTZ001  -- as people plot


@figure
def categories(axes: Any) -> None:
    axes.plot(["ZN", "PA", "MIGO"], [1, 3, 2], "o-")


@figure
def ticks(axes: Any) -> None:
    axes.plot([0, 10], [0, 1000])
    axes.xaxis.set_major_locator(MultipleLocator(2.5))
    axes.xaxis.set_minor_locator(MultipleLocator(0.5))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.0f} Hz"))
    axes.tick_params(direction="in", length=6, labelrotation=20)


@figure
def tick_format(axes: Any) -> None:
    axes.plot([0, 1e7], [0, 1e-6])
    axes.xaxis.set_major_formatter(FormatStrFormatter("%.1e"))
    axes.grid(axis="x", linestyle=":")


@figure
def spines(axes: Any) -> None:
    axes.plot([-1, 1], [-1, 1])
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines["left"].set_position("zero")
    axes.spines["bottom"].set(color="red", linewidth=2, position=("outward", 10))


@figure
def hidden(axes: Any) -> None:
    axes.plot([0, 1])
    axes.set_axis_off()


@figure
def square(axes: Any) -> None:
    axes.plot(np.cos(T), np.sin(T))
    axes.set_aspect("equal")


@figure
def two_scales(axes: Any) -> None:
    axes.plot([0, 1], color="C0")
    other = axes.twinx()
    other.plot([100, 50], color="C1")
    other.set_ylabel("other")


@figure
def secondary(axes: Any) -> None:
    axes.plot([0, 1])
    axes.secondary_xaxis("top", functions=(np.rad2deg, np.deg2rad)).set_xlabel("degrees")


@figure
def inset(axes: Any) -> None:
    axes.plot(T, np.sin(T))
    inner = axes.inset_axes((0.6, 0.6, 0.3, 0.3), xlim=(2, 3), ylim=(0, 1))
    inner.plot(T, np.sin(T))
    axes.indicate_inset_zoom(inner)


@figure
def face(axes: Any) -> None:
    axes.set_facecolor("lightyellow")
    axes.plot([0, 1])


@whole
def polar(fig: Figure) -> None:
    axes: Any = fig.add_subplot(projection="polar")
    axes.plot(T, T / 5.0, label="r")
    axes.bar([1.0, 2.0], [1.5, 1.0], width=0.4, alpha=0.5)
    axes.scatter([0.5, 4.0], [1.0, 1.5])


@whole
def polar_wedge(fig: Figure) -> None:
    axes: Any = fig.add_subplot(projection="polar")
    axes.set(theta_zero_location="N", theta_direction=-1, thetamin=0, thetamax=120)
    axes.plot([0.2, 1.0, 2.0], [1.0, 2.0, 1.5])


@whole
def globe(fig: Figure) -> None:
    axes = fig.add_subplot(projection="mollweide")
    axes.plot([-1.0, 0.0, 2.0], [0.5, -0.3, 1.0])
    axes.grid()


@whole
def solid_lines(fig: Figure) -> None:
    axes: Any = fig.add_subplot(projection="3d")
    axes.plot(np.cos(T), np.sin(T), T, label="helix")
    axes.scatter([0, 1], [0, 1], [5, 8], depthshade=False)
    axes.text(0, 0, 5, "here")
    axes.set(xlabel="x", zlabel="height")


@whole
def solid_surface(fig: Figure) -> None:
    fig.add_subplot(projection="3d").plot_surface(X[::3, ::3], Y[::3, ::3], Z[::3, ::3], cmap="viridis")


@whole
def solid_wires(fig: Figure) -> None:
    axes: Any = fig.add_subplot(projection="3d")
    axes.plot_wireframe(X[::4, ::4], Y[::4, ::4], Z[::4, ::4])
    axes.contour(X, Y, Z, zdir="z", offset=-1)


@whole
def solid_bars(fig: Figure) -> None:
    axes: Any = fig.add_subplot(projection="3d")
    axes.bar3d([0, 1], [0, 1], [0, 0], 0.5, 0.5, [1, 2])
    axes.view_init(elev=20, azim=40)


@whole
def solid_blocks(fig: Figure) -> None:
    axes: Any = fig.add_subplot(projection="3d")
    axes.voxels(np.indices((3, 3, 3)).sum(axis=0) < 3)
    axes.quiver([0], [0], [0], [1], [1], [1])


# ---------------------------------------------------------------------------------------- whole figures


@whole
def panels(fig: Figure) -> None:
    axes = fig.subplots(2, 2, sharex=True)
    for place, one in enumerate(axes.flat):
        one.plot(T, np.sin(T + place))
        one.set_title(f"case {place + 1}")
    fig.suptitle("Four cases")
    fig.supxlabel("time")


@whole
def constrained(fig: Figure) -> None:
    fig.set_layout_engine("constrained")
    one, other = fig.subplots(1, 2)
    one.plot([0, 1], label="long name of a curve")
    one.legend(loc="upper left")
    other.imshow(Z)
    other.set_ylabel("a long label")
    fig.colorbar(other.images[0], ax=other)


@whole
def tight(fig: Figure) -> None:
    for axes in fig.subplots(2, 1):
        axes.plot([0, 1000], [0, 1e5])
        axes.set(xlabel="a label", ylabel="another label")
    fig.tight_layout()


@whole
def mosaic(fig: Figure) -> None:
    axes = fig.subplot_mosaic("AB;CC")
    axes["A"].plot([0, 1])
    axes["C"].bar([1, 2], [2, 1])


@whole
def sub_figures(fig: Figure) -> None:
    parts: Any = fig.subfigures(1, 2)
    left, right = parts
    left.subplots().plot([0, 1])
    left.suptitle("left part")
    right.subplots().plot([1, 0])
    right.set_facecolor("0.9")


@whole
def figure_artists(fig: Figure) -> None:
    fig.subplots().plot([0, 1], label="a")
    fig.text(0.1, 0.9, "note")
    fig.add_artist(Line2D([0.1, 0.9], [0.05, 0.05], color="red"))
    fig.add_artist(Rectangle((0.4, 0.9), 0.1, 0.05))
    fig.figimage(np.arange(400.0).reshape(20, 20), 10, 10)
    fig.legend(loc="outside upper right" if fig.get_layout_engine() else "upper right")


@whole
def connected(fig: Figure) -> None:
    one, other = fig.subplots(1, 2)
    one.plot([0, 1])
    other.plot([1, 0])
    fig.add_artist(ConnectionPatch((0.5, 0.5), (0.5, 0.5), "data", "data", axesA=one, axesB=other))


@whole
def no_axes(fig: Figure) -> None:
    fig.text(0.5, 0.5, "nothing to plot")


@whole
def sankey(fig: Figure) -> None:
    axes = fig.add_subplot(xticks=[], yticks=[])
    Sankey(axes, flows=[1, -0.6, -0.4], labels=["in", "out", "loss"]).finish()

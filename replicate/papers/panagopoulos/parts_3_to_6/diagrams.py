"""Block diagrams of the thesis, drawn from a few strokes: boxes, sums and arrows on matplotlib axes."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Point = tuple[float, float]


class Diagram:
    """A block diagram on one axes without frame, in units of a box's height."""

    def __init__(self, fig: Figure) -> None:
        self.axes: Axes = fig.add_subplot()
        self.axes.set_axis_off()
        self.axes.set_aspect("equal")
        self.ink = self.axes.xaxis.label.get_color()

    def box(self, center: Point, text: str, width: float = 1.6, height: float = 1.0) -> None:
        """Draw a block."""
        from matplotlib import patches

        x, y = center[0] - width / 2, center[1] - height / 2
        self.axes.add_patch(patches.Rectangle((x, y), width, height, fill=False, ec=self.ink, lw=1.2))
        self.axes.text(*center, text, ha="center", va="center", fontsize=11)

    def sum(self, center: Point, signs: dict[str, str] | None = None) -> None:
        """Draw a summing junction; ``signs`` puts signs beside its ``left``, ``top``, ``bottom`` or ``right``."""
        from matplotlib import patches

        self.axes.add_patch(patches.Circle(center, 0.2, fill=False, ec=self.ink, lw=1.2))
        places = {"left": (-0.36, 0.2), "top": (0.24, 0.36), "bottom": (0.24, -0.36), "right": (0.36, 0.2)}
        for side, sign in (signs or {}).items():
            dx, dy = places[side]
            self.axes.text(center[0] + dx, center[1] + dy, sign, ha="center", va="center", fontsize=10)

    def arrow(self, *points: Point, label: str = "", at: Point | None = None) -> None:
        """Draw an arrow along straight lines through points; its label stands above the first line, or ``at``."""
        xs, ys = zip(*points[:-1], strict=True)
        if len(points) > 2:
            self.axes.plot(xs, ys, color=self.ink, lw=1.2, ls="-", solid_capstyle="butt")
        style = {"arrowstyle": "-|>", "color": self.ink, "lw": 1.2, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 11}
        self.axes.annotate("", xy=points[-1], xytext=points[-2], arrowprops=style)
        if label:
            x, y = at or ((points[0][0] + points[1][0]) / 2, (points[0][1] + points[1][1]) / 2 + 0.25)
            self.axes.text(x, y, label, ha="center", va="center", fontsize=11)

    def dot(self, center: Point) -> None:
        """Mark where a signal branches."""
        self.axes.plot(*center, marker="o", ms=4, color=self.ink)

    def frame(self, left: float, right: float, bottom: float, top: float) -> None:
        """Set the visible region."""
        self.axes.set_xlim(left, right)
        self.axes.set_ylim(bottom, top)

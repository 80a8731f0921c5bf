"""Figure 8: the points that meet a phase margin and a gain margin, τ = 0.5, and the corners of their region."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.krajewski import paper
from replicate.papers.krajewski.drawing import draw_locus, fill_loci, label_locus, mark_point, plane
from replicate.papers.krajewski.loci import Corner, Locus, constant_gain_ratio, constant_phase_margin, corners
from replicate.papers.krajewski.point_tables import point_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TAU, MARGIN, RATIO = 0.5, 60.0, 0.3


def admissible_region() -> list[Locus]:
    """Return the border of the region m >= 60 degrees, g <= 0.3, without the piece of the b axis that closes it."""
    lower, upper = corners(TAU, MARGIN, RATIO)
    margin, ratio = constant_phase_margin(TAU, MARGIN), constant_gain_ratio(TAU, RATIO)
    return [
        ratio.part(0.0, lower.u_gain_ratio),
        margin.part(lower.u_phase_margin, upper.u_phase_margin),
        ratio.part(upper.u_gain_ratio, 1.0),
    ]


@paper.figure(
    "fig-8",
    "Admissible region for a phase and a gain margin, τ = 0.5",
    caption="Shaded: $m_\\varphi \\ge 60$ degrees and $g \\le 0.3$ together. The two curves cross at the two corners.",
    alt="A curve of phase margin 60 degrees and a curve g = 0.3 in the a-b plane cross twice; the region "
    "left of both is shaded, and its two corners are marked.",
    size=(6.4, 4.8),
)
def draw(fig: Figure) -> None:
    """Draw Figure 8."""
    axes = fig.add_subplot()
    plane(axes, (0.0, 1.5), (-0.62, 2.4))
    fill_loci(axes, admissible_region(), "admissible region", facecolor="C2", alpha=0.22)
    margin, ratio = constant_phase_margin(TAU, MARGIN), constant_gain_ratio(TAU, RATIO)
    draw_locus(axes, margin, "phase margin 60", edgecolor="C0")
    label_locus(axes, margin, 0.86, "$m_\\varphi = 60°$", "C0")
    draw_locus(axes, ratio, "g = 0.3", edgecolor="C1", linestyle="--")
    label_locus(axes, ratio, 0.33, "$g = 0.3$", "C1")
    lower, upper = corners(TAU, MARGIN, RATIO)
    mark_point(axes, upper.a, upper.b, _coordinates(upper), (8, 4))
    mark_point(axes, lower.a, lower.b, _coordinates(lower), (8, -11))
    axes.text(0.36, 0.45, "$m_\\varphi \\geq 60°$\n$g \\leq 0.3$", ha="center", va="center")


def _coordinates(corner: Corner) -> str:
    return f"({corner.a:.3f}, {corner.b:.3f})".replace("-", "\N{MINUS SIGN}")


point_table(
    "fig-8",
    "The corners of the admissible region",
    responses=False,
    caption="Where $m_\\varphi = 60$ degrees and $g = 0.3$ cross. The paper prints $b$ of the upper "
    "corner as $0.91\\bar6$.",
)

"""Figure 2: the ellipses of the sensitivity constraint and their envelope."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from replicate.loops import Circle
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.designs import design
from replicate.papers.panagopoulos.part_1.plants import PLANTS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MS = 2.0
# name, frequencies of the ellipses (denser where the plant turns faster), range of k, top of ki
PANELS = {
    "G6": ("smooth top", np.linspace(0.08, 4.0, 50), (-1.0, 1.6), 2.4),
    "G12 a=0.2": (
        "corner",
        np.concatenate([np.linspace(0.08, 2.6, 36), np.linspace(2.62, 3.1, 40)]),
        (-0.95, 0.55),
        1.9,
    ),
}


def ellipse(plant: str, w: float) -> tuple[np.ndarray, np.ndarray]:
    """Return (k, ki) on the ellipse f(k, ki, w) = R^2 (9): center on the stability limit, axes R/r and wR/r."""
    circle = Circle.of(MS)
    value = complex(PLANTS[plant](1j * w))
    r = abs(value)
    angle = np.linspace(0.0, 2.0 * np.pi, 181)
    k = -circle.center * value.real / r**2 + circle.radius / r * np.cos(angle)
    ki = -circle.center * w * value.imag / r**2 + circle.radius * w / r * np.sin(angle)
    return k, ki


def largest_gain(plant: str, gains: np.ndarray) -> np.ndarray:
    """Return for each k the ki at which the first ellipse is met from below; nan where ki = 0 is inside one."""
    w = np.geomspace(1e-3, 60.0, 6000)
    value = PLANTS[plant](1j * w)
    some = np.array_split(gains, max(1, len(gains) // 20))  # all at once need more time for memory than for numbers
    return np.concatenate([_first_met(w, value, part) for part in some])


def _first_met(w: np.ndarray, value: np.ndarray, gains: np.ndarray) -> np.ndarray:
    """Do so for a few gains, with the plant's ``value`` at the frequencies ``w``."""
    circle = Circle.of(MS)
    r = np.abs(value)
    inside = circle.radius**2 - (gains[:, None] * r + circle.center * value.real / r) ** 2
    half = np.sqrt(np.maximum(inside, 0.0))
    center = -circle.center * value.imag / r
    low, high = (center - half) * w / r, (center + half) * w / r
    met = (inside > 0.0) & (high > 0.0)
    lowest = np.min(np.where(met, low, np.inf), axis=1)
    return np.asarray(np.where((lowest > 0.0) & np.isfinite(lowest), lowest, np.nan))


@paper.figure(
    "I-fig-2",
    "The sensitivity constraint in the plane of the gains, $M_s = 2$",
    caption="Each ellipse is what the constraint (9) excludes at one frequency; their envelope bounds what is "
    "allowed (from $k_i = 0$ up to the thick line), and the dot is the design, its highest point. (a) $G_6$, "
    "where the envelope has a smooth top; (b) $G_{12}$ with $a = 0.2$, where it has a corner. The paper does "
    "not name its plants.",
    alt="Two panels of ellipses in the plane of proportional and integral gain. In the left one the lower "
    "envelope of the ellipses has a rounded top at the design point, in the right one two families of "
    "ellipses meet in a sharp corner there.",
    size=(7.4, 3.7),
)
def draw(fig: Figure) -> None:
    """Draw Figure 2."""
    for axes, (plant, (name, frequencies, reach, top)), letter in zip(
        fig.subplots(1, 2), PANELS.items(), "ab", strict=True
    ):
        _panel(axes, plant, frequencies, reach)
        axes.set_ylim(0.0, top)
        axes.set_title(f"({letter}) {name}")
        axes.set_xlabel("$k$")
        axes.set_ylabel("$k_i$")


def _panel(axes: Axes, plant: str, frequencies: np.ndarray, reach: tuple[float, float]) -> None:
    for w in frequencies:
        axes.plot(*ellipse(plant, w), color="C0", linestyle="-", linewidth=0.6, alpha=0.6)
    gains = np.unique(np.append(np.linspace(*reach, 601), design(plant, MS).k))
    axes.plot(gains, largest_gain(plant, gains), color="C1", linestyle="-", linewidth=2.2)
    axes.plot([design(plant, MS).k], [design(plant, MS).ki], marker="o", color="C1", linestyle="none", markersize=6)
    axes.set_xlim(*reach)

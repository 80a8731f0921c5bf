"""The one look of every figure, and the colours that a page may replace to suit its theme.

Curves use mid-tones that keep a contrast of at least 3 : 1 on white and on a dark page and stay apart under
the common forms of colour blindness (after Okabe and Ito, "Color universal design", 2008, the light tones
darkened). Text, axes and ticks use one ink colour and legends one paper colour, both used for nothing else,
so that `themed` can hand them over to the page that shows the figure.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

INK = "#1b1f24"
PAPER = "#fdfdfe"
GRID = "#8b949e"

#: Curve colours; the eighth curve starts over, dashed.
PALETTE = ("#0072b2", "#d55e00", "#009e73", "#b5609a", "#a97c00", "#2b8cc4", "#7d7f83")

PNG_DPI = 160

_STYLE: Any = {
    "axes.axisbelow": True,
    "axes.edgecolor": INK,
    "axes.facecolor": "none",
    "axes.formatter.use_mathtext": True,
    "axes.grid": True,
    "axes.labelcolor": INK,
    "axes.labelsize": 9.5,
    "axes.linewidth": 0.8,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlecolor": INK,
    "axes.titlesize": 10,
    "axes.unicode_minus": True,
    "axes.xmargin": 0.0,
    "figure.constrained_layout.use": True,
    "figure.facecolor": "none",
    "figure.edgecolor": "none",
    "figure.titlesize": 10,
    "font.family": "DejaVu Sans",  # ships with matplotlib: the same glyphs everywhere
    "font.size": 9.5,
    "grid.alpha": 0.3,
    "grid.color": GRID,
    "grid.linewidth": 0.6,
    "hatch.color": INK,
    "legend.edgecolor": "none",
    "legend.facecolor": PAPER,
    "legend.fontsize": 9,
    "legend.framealpha": 0.85,
    "legend.handlelength": 2.4,
    "legend.labelcolor": INK,
    "lines.linewidth": 1.6,
    "lines.markersize": 4.5,
    "mathtext.fontset": "dejavusans",
    "patch.edgecolor": INK,
    "svg.fonttype": "path",  # text as outlines: the same picture on every machine; alt texts carry the words
    "text.color": INK,
    "xtick.color": INK,
    "xtick.labelsize": 9,
    "ytick.color": INK,
    "ytick.labelsize": 9,
}


@contextmanager
def style(hashsalt: str) -> Iterator[None]:
    """Use the project's look inside a ``with`` block, whatever the user's own matplotlib settings are.

    Parameters
    ----------
    hashsalt
        Seeds the ids inside an SVG, so that they are the same in every run and differ between figures.
    """
    import matplotlib as mpl
    from cycler import cycler

    cycle = cycler(linestyle=["-", "--"]) * cycler(color=PALETTE)
    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update({**_STYLE, "axes.prop_cycle": cycle, "svg.hashsalt": hashsalt})
        yield


def themed(svg: str) -> str:
    """Return an SVG whose ink follows the text colour of the page it is placed in.

    Legends take the page's ``--figure-paper`` colour if it sets one. Only for SVGs inside an HTML page: a
    file opened on its own has no such colours.

    Examples
    --------
    >>> themed(f'<path style="stroke: {INK}"/>')
    '<path style="stroke: currentColor"/>'
    """
    return svg.replace(INK, "currentColor").replace(PAPER, f"var(--figure-paper, {PAPER})")

"""The one look of every figure, and the colours that a page may replace to suit its theme.

Curves differ in lightness as well as in hue, so that they stay apart for dichromats and in grey, and those whose
lightness is close differ in their dashes; `tests/test_palette.py` holds the distances. A dark page has colours of its
own for the same curves. Text, axes and ticks use one ink colour and legends one paper colour, both used for nothing
else, so that `themed` can hand them over to the page that shows the figure. Letters are those of the formulas of the
pages: STIX, which comes with matplotlib; behind it stand fonts of other scripts.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

INK = "#1b1f24"
PAPER = "#fdfdfe"
GRID = "#8b949e"

#: Curve colours: blue, vermilion, green, pink, brown, sky, plum.
PALETTE = ("#2a35c4", "#dc2f0c", "#006f5e", "#c0649b", "#5a3407", "#009dd4", "#391d4b")
#: The same curves on a dark page: blue, orange, green, pink, yellow, sky, grey.
DARK_PALETTE = ("#486be7", "#f8b14b", "#42c2a2", "#ba8ec5", "#f0f505", "#66e3ff", "#928597")
#: Dashes of the curves, as matplotlib writes them; the next round of colours has each curve's successor's.
DASHES = ("-", "-", "--", "-.", ":", (0, (7, 1.5, 1, 1.5, 1, 1.5)), (0, (9, 2)))

PNG_DPI = 160

_STYLE: Any = {
    "axes.axisbelow": True,
    "axes.edgecolor": INK,
    "axes.facecolor": "none",
    "axes.formatter.use_mathtext": True,
    "axes.grid": True,
    "axes.labelcolor": INK,
    "axes.labelsize": 10.5,
    "axes.linewidth": 0.8,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlecolor": INK,
    "axes.titlesize": 11,
    "axes.unicode_minus": True,
    "axes.xmargin": 0.0,
    "figure.constrained_layout.use": True,
    "figure.facecolor": "none",
    "figure.edgecolor": "none",
    "figure.titlesize": 11,
    "font.size": 10.5,
    "grid.alpha": 0.3,
    "grid.color": GRID,
    "grid.linewidth": 0.6,
    "hatch.color": INK,
    "legend.edgecolor": "none",
    "legend.facecolor": PAPER,
    "legend.fontsize": 10,
    "legend.framealpha": 0.85,
    "legend.handlelength": 2.4,
    "legend.labelcolor": INK,
    "lines.linewidth": 1.6,
    "lines.markersize": 4.5,
    "mathtext.fontset": "stix",
    "patch.edgecolor": INK,
    "svg.fonttype": "path",  # text as outlines: the same picture on every machine; alt texts carry the words
    "text.color": INK,
    "xtick.color": INK,
    "xtick.labelsize": 10,
    "ytick.color": INK,
    "ytick.labelsize": 10,
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

    from replicate.figures.fonts import families

    first = cycler(color=PALETTE) + cycler(linestyle=DASHES)
    second = cycler(color=PALETTE) + cycler(linestyle=[*DASHES[2:], *DASHES[1:3]])
    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update({**_STYLE, "axes.prop_cycle": first.concat(second), "svg.hashsalt": hashsalt})
        mpl.rcParams["font.family"] = ["STIXGeneral", *families()]
        yield


def themed(svg: str) -> str:
    """Return an SVG whose ink follows the text colour of the page it is placed in.

    Legends take the page's ``--figure-paper`` colour if it sets one, curves the colours of `dark_curves` where the page
    has that rule. Only for SVGs inside an HTML page: a file opened on its own has no such colours.

    Examples
    --------
    >>> themed(f'<path style="stroke: {INK}"/>')
    '<path style="stroke: currentColor"/>'
    >>> themed('<path style="stroke: #009dd4"/>')
    '<path style="stroke: var(--curve-6, #009dd4)"/>'
    """
    svg = svg.replace(INK, "currentColor").replace(PAPER, f"var(--figure-paper, {PAPER})")
    for number, colour in enumerate(PALETTE, start=1):
        svg = svg.replace(colour, f"var(--curve-{number}, {colour})")
    return svg


def dark_curves() -> str:
    """Return the rule of a style sheet that gives curves their colours on a dark screen."""
    colours = "; ".join(f"--curve-{number}: {colour}" for number, colour in enumerate(DARK_PALETTE, start=1))
    return f"@media screen and (prefers-color-scheme: dark) {{ :root {{ {colours} }} }}\n"

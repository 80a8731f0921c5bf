"""The colours of verdicts stay apart for every eye, and on a black-and-white print.

The simulation of dichromacy is that of G. M. Machado, M. M. Oliveira and L. A. F. Fernandes, "A physiologically-based
model for simulation of color vision deficiency", IEEE Trans. Visualization and Computer Graphics 15 (2009) 1291-1298,
severity 1.0; distances are those of CIE 1976 L*a*b*.
"""

from __future__ import annotations

import re
from itertools import combinations, pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

from replicate.resources import templates_dir

VISION = {
    "normal": np.eye(3),
    "protanopia": np.array(
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]
    ),
    "deuteranopia": np.array(
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]
    ),
    "tritanopia": np.array(
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]]
    ),
}
TO_XYZ = np.array(
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
)
WHITE = TO_XYZ.sum(axis=1)

Colour = NDArray[np.float64]

NAMES = ("good", "also", "near", "print", "cause", "open", "none")
LEAST, LEAST_GREY = 15.0, 4.5


def linear(colour: str) -> Colour:
    """Return the intensities of an sRGB colour (IEC 61966-2-1)."""
    value: Colour = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255.0
    return np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)


def lab(intensities: Colour) -> Colour:
    relative = TO_XYZ @ np.clip(intensities, 0.0, 1.0) / WHITE
    x, y, z = np.where(relative > 216 / 24389, np.cbrt(relative), (24389 / 27 * relative + 16) / 116)
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


def colours(scheme: str) -> dict[str, str]:
    style = (templates_dir() / "style.css").read_text(encoding="utf-8")
    light, _, rest = style.partition("@media (prefers-color-scheme: dark)")
    printed = style[style.index("color-scheme: light;\n") :]
    part = {"light": light, "dark": rest.partition("*, ::before")[0], "print": printed}[scheme]
    return {name: found[1] for name in NAMES if (found := re.search(rf"--{name}-bar: (#[0-9a-f]{{6}})", part))}


def test_the_distances_are_those_of_the_standard() -> None:
    assert lab(linear("#ffffff")) == pytest.approx([100.0, 0.0, 0.0], abs=1e-3)
    assert lab(linear("#ff0000")) == pytest.approx([53.24, 80.09, 67.20], abs=0.02)  # B. Lindbloom's calculator
    for matrix in VISION.values():
        assert matrix.sum(axis=1) == pytest.approx(np.ones(3), abs=1e-5)  # white stays white


@pytest.mark.parametrize("scheme", ["light", "dark", "print"])
@pytest.mark.parametrize("vision", sorted(VISION))
def test_verdicts_differ_for_every_eye(scheme: str, vision: str) -> None:
    seen = {name: lab(VISION[vision] @ linear(colour)) for name, colour in colours(scheme).items()}
    assert len(seen) == len(NAMES)
    apart = {(one, other): np.linalg.norm(seen[one] - seen[other]) for one, other in combinations(seen, 2)}
    assert {pair: distance for pair, distance in apart.items() if distance < LEAST} == {}


@pytest.mark.parametrize("scheme", ["light", "dark", "print"])
def test_verdicts_differ_in_grey(scheme: str) -> None:
    lightness = sorted(lab(linear(colour))[0] for colour in colours(scheme).values())
    assert min(upper - lower for lower, upper in pairwise(lightness)) >= LEAST_GREY

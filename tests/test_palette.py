"""The colours of verdicts and of curves stay apart for every eye, and on a black-and-white print.

The simulation of dichromacy is that of G. M. Machado, M. M. Oliveira and L. A. F. Fernandes, "A physiologically-based
model for simulation of color vision deficiency", IEEE Trans. Visualization and Computer Graphics 15 (2009) 1291-1298,
severity 1.0; distances of verdicts are those of CIE 1976 L*a*b*, those of curves CIEDE2000 (ISO/CIE 11664-6:2014),
which saturated colours need.
"""

from __future__ import annotations

import re
from itertools import combinations, pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

from replicate.figures import style
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

PALETTES = {"light": style.PALETTE, "dark": style.DARK_PALETTE}
GROUNDS = {"light": ("#ffffff", "#fdfcfa"), "dark": ("#15181c",)}
#: The least CIEDE2000 distance among the first two, four and all curves; in lightness alone; and from the ink.
LEAST_CURVES = {2: 40.0, 4: 15.0, 7: 10.0}
LEAST_CURVES_GREY, LEAST_INK = 5.5, 9.0
#: From here on two solid lines are told apart in grey.
SOLID_GREY = 12.0


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


def ciede2000(one: Colour, other: Colour) -> float:
    """Return the distance of two colours in L*a*b*: G. Sharma, W. Wu, E. N. Dalal, Color Res. Appl. 30 (2005) 21-30."""
    (l1, a1, b1), (l2, a2, b2) = one, other
    mean = (np.hypot(a1, b1) + np.hypot(a2, b2)) / 2
    stretch = 1.5 - 0.5 * np.sqrt(mean**7 / (mean**7 + 25.0**7))
    p, q = complex(stretch * a1, b1), complex(stretch * a2, b2)
    c1, c2 = abs(p), abs(q)
    h1, h2 = np.degrees(np.angle(p)) % 360, np.degrees(np.angle(q)) % 360
    turn = (h2 - h1 + 180) % 360 - 180 if c1 * c2 else 0.0
    lightness, chroma, hue = (l1 + l2) / 2, (c1 + c2) / 2, h1 + turn / 2
    if not c1 * c2:
        hue = h1 + h2
    weight = (
        1
        - 0.17 * np.cos(np.radians(hue - 30))
        + 0.24 * np.cos(np.radians(2 * hue))
        + 0.32 * np.cos(np.radians(3 * hue + 6))
        - 0.20 * np.cos(np.radians(4 * hue - 63))
    )
    d_l = (l2 - l1) / (1 + 0.015 * (lightness - 50) ** 2 / np.sqrt(20 + (lightness - 50) ** 2))
    d_c = (c2 - c1) / (1 + 0.045 * chroma)
    d_h = 2 * np.sqrt(c1 * c2) * np.sin(np.radians(turn) / 2) / (1 + 0.015 * chroma * weight)
    blue = 60 * np.exp(-((((hue % 360) - 275) / 25) ** 2))
    rotation = -2 * np.sqrt(chroma**7 / (chroma**7 + 25.0**7)) * np.sin(np.radians(blue))
    return float(np.sqrt(d_l**2 + d_c**2 + d_h**2 + rotation * d_c * d_h))


@pytest.mark.parametrize(
    ("one", "other", "distance"),
    [  # pairs 1, 4, 7, 9, 14, 17, 20, 24, 25, 29, 33 and 34 of table 1 of Sharma, Wu and Dalal
        ((50.0, 2.6772, -79.7751), (50.0, 0.0, -82.7485), 2.0425),
        ((50.0, -1.3802, -84.2814), (50.0, 0.0, -82.7485), 1.0000),
        ((50.0, 0.0, 0.0), (50.0, -1.0, 2.0), 2.3669),
        ((50.0, 2.49, -0.001), (50.0, -2.49, 0.0009), 7.1792),
        ((50.0, -0.001, 2.49), (50.0, 0.0011, -2.49), 4.7461),
        ((50.0, 2.5, 0.0), (73.0, 25.0, -18.0), 27.1492),
        ((50.0, 2.5, 0.0), (58.0, 24.0, 15.0), 19.4535),
        ((50.0, 2.5, 0.0), (50.0, 3.2592, 0.335), 1.0000),
        ((60.2574, -34.0099, 36.2677), (60.4626, -34.1751, 39.4387), 1.2644),
        ((22.7233, 20.0904, -46.6940), (23.0331, 14.9730, -42.5619), 2.0373),
        ((6.7747, -0.2908, -2.4247), (5.8714, -0.0985, -2.2286), 0.6377),
        ((2.0776, 0.0795, -1.1350), (0.9033, -0.0636, -0.5514), 0.9082),
    ],
)
def test_the_distance_of_curves_is_that_of_its_authors(one: object, other: object, distance: float) -> None:
    assert ciede2000(np.array(one), np.array(other)) == pytest.approx(distance, abs=6e-5)
    assert ciede2000(np.array(other), np.array(one)) == pytest.approx(distance, abs=6e-5)


@pytest.mark.parametrize("scheme", sorted(PALETTES))
@pytest.mark.parametrize("vision", sorted(VISION))
@pytest.mark.parametrize("first", sorted(LEAST_CURVES))
def test_curves_differ_for_every_eye(scheme: str, vision: str, first: int) -> None:
    seen = {colour: lab(VISION[vision] @ linear(colour)) for colour in PALETTES[scheme][:first]}
    assert len(seen) == first
    apart = {(one, other): ciede2000(seen[one], seen[other]) for one, other in combinations(seen, 2)}
    assert {pair: distance for pair, distance in apart.items() if distance < LEAST_CURVES[first]} == {}


@pytest.mark.parametrize("vision", sorted(VISION))
def test_no_curve_looks_like_the_ink(vision: str) -> None:
    for scheme, ink in (("light", style.INK), ("dark", "#e4e2dd")):
        there = lab(VISION[vision] @ linear(ink))
        for colour in PALETTES[scheme]:
            assert ciede2000(lab(VISION[vision] @ linear(colour)), there) >= LEAST_INK


def test_curves_differ_in_grey() -> None:
    for palette in PALETTES.values():
        lightness = sorted(lab(linear(colour))[0] for colour in palette)
        assert min(upper - lower for lower, upper in pairwise(lightness)) >= LEAST_CURVES_GREY


def test_curves_alike_in_grey_differ_in_their_dashes() -> None:
    lightness = [lab(linear(colour))[0] for colour in style.PALETTE]
    for one, other in combinations(range(len(style.PALETTE)), 2):
        if style.DASHES[one] == style.DASHES[other]:
            assert abs(lightness[one] - lightness[other]) >= SOLID_GREY


@pytest.mark.parametrize("scheme", sorted(PALETTES))
def test_curves_have_contrast_on_their_page(scheme: str) -> None:
    for ground in GROUNDS[scheme]:
        page = float(TO_XYZ[1] @ linear(ground))
        for colour in PALETTES[scheme]:
            darker, lighter = sorted((float(TO_XYZ[1] @ linear(colour)), page))
            assert (lighter + 0.05) / (darker + 0.05) >= 3.0  # WCAG 2.2, 1.4.11


def test_two_rounds_of_curves_all_look_different() -> None:
    import matplotlib as mpl

    with style.style(hashsalt="x"):
        looks = [(look["color"], str(look["linestyle"])) for look in mpl.rcParams["axes.prop_cycle"]]
    assert len(set(looks)) == len(looks) == 2 * len(style.PALETTE)


def test_a_page_redraws_curves_for_dark_screens() -> None:
    drawn = style.themed("".join(f'<path style="stroke: {colour}"/>' for colour in style.PALETTE))
    rule = style.dark_curves()
    assert rule.startswith("@media screen and (prefers-color-scheme: dark)")
    for number, (light, dark) in enumerate(zip(style.PALETTE, style.DARK_PALETTE, strict=True), start=1):
        assert f"var(--curve-{number}, {light})" in drawn
        assert f"--curve-{number}: {dark}" in rule

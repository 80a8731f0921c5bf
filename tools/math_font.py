"""Make the font of the formulas on the pages: a subset of a free math font, small enough to be put into every page.

    python tools/math_font.py FONT.otf

FONT is a font with a MATH table under the SIL Open Font License, such as STIX Math (Debian's package fonts-stix). The
subset gets a name of its own, as the license demands, and is written to templates/fonts/math.woff; the license lies
beside it.
"""

from __future__ import annotations

import sys
from pathlib import Path

from fontTools import subset
from fontTools.ttLib import TTFont

FAMILY = "Replicate Math"
TARGET = Path(__file__).parent.parent / "templates" / "fonts" / "math.woff"

# Letters and digits; Greek; what formulas of engineering papers are made of; italic letters, which a browser takes for
# every identifier of one letter; signs over letters, brackets, roots and integrals with their larger forms.
CHARACTERS = [
    *range(0x20, 0x7F), 0xA0, 0xAC, 0xAF, 0xB0, 0xB1, 0xB4, 0xB7, 0xD7, 0xF7, 0x2C6, 0x2C7, 0x2D9, 0x2DC,
    0x300, 0x301, 0x302, 0x303, 0x304, 0x305, 0x307, 0x308, 0x20D7, *range(0x391, 0x3AA), *range(0x3B1, 0x3CA), 0x3D1,
    0x3D5, 0x3F5, 0x2016, 0x2026, 0x2032, 0x2033, 0x203E, 0x2061, 0x2062, 0x2063, 0x210E, 0x210F, 0x2111, 0x211C,
    0x2112, 0x2115, 0x2124, 0x211D, 0x2102, *range(0x2190, 0x2195), 0x21D2, 0x21D4, 0x21A6, 0x2200, 0x2202, 0x2203,
    0x2205, 0x2206, 0x2207, 0x2208, 0x2209, 0x220F, 0x2211, 0x2212, 0x2213, 0x2217, 0x2218, 0x221A, 0x221D, 0x221E,
    0x2220, 0x2223, 0x2225, 0x2227, 0x2228, 0x2229, 0x222A, 0x222B, 0x222E, 0x223C, 0x2243, 0x2245, 0x2248, 0x2260,
    0x2261, 0x2264, 0x2265, 0x226A, 0x226B, 0x2282, 0x2286, 0x22C5, 0x22EF, 0x2308, 0x2309, 0x230A, 0x230B, 0x27E8,
    0x27E9, 0x23DE, 0x23DF, *range(0x1D434, 0x1D468), *range(0x1D6E2, 0x1D71C),
]  # fmt: skip


def main(source: Path) -> None:
    """Write the subset."""
    options = subset.Options(
        flavor="woff", layout_features=["ssty", "kern", "mark", "mkmk"], notdef_outline=True, hinting=False,
        desubroutinize=True, name_IDs=[], name_languages=[], drop_tables=["DSIG", "FFTM"],
    )  # fmt: skip
    font = TTFont(source, recalcTimestamp=False)
    if "MATH" not in font:
        msg = f"{source}: has no MATH table; needed: an OpenType font for mathematics"
        raise SystemExit(msg)
    subsetter = subset.Subsetter(options)
    subsetter.populate(unicodes=CHARACTERS)
    subsetter.subset(font)
    for id, text in ((1, FAMILY), (2, "Regular"), (4, FAMILY), (6, FAMILY.replace(" ", ""))):
        font["name"].setName(text, id, 3, 1, 0x409)
    if "CFF " in font:
        cff = font["CFF "].cff
        cff.fontNames = [FAMILY.replace(" ", "")]
        top = cff.topDictIndex[0]
        for name in ("FullName", "FamilyName"):
            if hasattr(top, name):
                setattr(top, name, FAMILY)
    TARGET.parent.mkdir(parents=True, exist_ok=True)
    font.flavor = "woff"
    font.save(TARGET)
    sys.stdout.write(f"{TARGET}: {TARGET.stat().st_size} bytes, {len(font.getGlyphOrder())} glyphs\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))

"""What the note says of its formula in words."""

from fractions import Fraction

from balmer1885 import paper
from balmer1885.lines import ORDERS, H, coefficient, fitted, measured
from replicate.exhibits import Finding

claims = paper.claims()

COEFFICIENTS = {"H-alpha": "9/5", "H-beta": "4/3", "H-gamma": "25/21", "H-delta": "9/8"}
ALLOWED = 40_000


@claims.claim(
    "coefficients",
    "The coefficients 9/5, 4/3, 25/21 and 9/8 are squares divided by the same squares less four.",
    where="the table",
)
def coefficients() -> Finding:
    """Compare in fractions."""
    wrong = [line for line, text in COEFFICIENTS.items() if Fraction(text) != _exact(ORDERS[line])]
    return Finding(
        "fails" if wrong else "holds",
        len(COEFFICIENTS) - len(wrong),
        f"{len(COEFFICIENTS) - len(wrong)} of {len(COEFFICIENTS)} are, with the squares of 3, 4, 5 and 6.",
    )


@claims.claim(
    "fundamental-number",
    "The common factor 3645.6 follows from Ångström's measurements.",
    where="before the table",
)
def fundamental_number() -> Finding:
    """Take the mean of measurement divided by coefficient."""
    mean = fitted()
    verdict = "holds" if round(mean, 1) == H else "fails"
    return Finding(verdict, mean, f"The mean of the four quotients is {mean:.3f}.")


@claims.claim(
    "accuracy",
    "Formula and measurement differ by at most a 40,000th of the wavelength.",
    where="after the table",
)
def accuracy() -> Finding:
    """Divide each wavelength by its difference."""
    ratios = {line: found / abs(found - H * coefficient(ORDERS[line])) for line, found in measured().items()}
    worst = min(ratios, key=ratios.__getitem__)
    verdict = "holds" if ratios[worst] >= ALLOWED else "fails"
    return Finding(verdict, ratios[worst], f"The largest difference is that of {worst}, 1/{ratios[worst]:.0f} of it.")


def _exact(order: int) -> Fraction:
    return Fraction(order**2, order**2 - 4)

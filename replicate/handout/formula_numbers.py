"""Numbers as a text of a handout writes them in formulas."""

from __future__ import annotations


def tex(number: float, digits: int = 3) -> str:
    r"""Return a number as LaTeX.

    Examples
    --------
    >>> tex(0.0123456), tex(-1234567.0), tex(2.0)
    ('0.0123', '-1.23 \\cdot 10^{6}', '2')
    """
    text = f"{float(number) + 0.0:.{digits}g}"
    mantissa, _, exponent = text.partition("e")
    return rf"{mantissa} \cdot 10^{{{int(exponent)}}}" if exponent else text


def fixed(number: float, decimals: int) -> str:
    """Return a number with so many decimals.

    Examples
    --------
    >>> fixed(2.0, 2), fixed(-0.0001, 2)
    ('2.00', '0.00')
    """
    text = f"{float(number):.{decimals}f}"
    return text if float(text) else text.removeprefix("-")


def percent(number: float, digits: int = 2) -> str:
    """Return a fraction in per cent, without the sign.

    Examples
    --------
    >>> percent(0.12345), percent(1.0, 3)
    ('12', '100')
    """
    return tex(100.0 * float(number), digits)

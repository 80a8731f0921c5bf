"""Labels without Markdown and TeX, for the data and for drawings, which no call of pandoc converts: "K_P".

What a page says of its own formulas is read from their MathML, by `formula_text`.
"""

from __future__ import annotations

import re
import unicodedata

from replicate.display.numbers import OVERLINE

_SPACE = re.compile(r"\\[,;:]")
_FONT = re.compile(r"\\(?:(?:mathrm|mathit|mathbf|mathsf|text|operatorname|rm|hat|tilde|left|right)(?![A-Za-z])|[! ])")
_BAR = re.compile(r"\\bar(?:\{(\w)\}|(\d))")
_FRACTION = re.compile(r"\\[dt]?frac\{([^{}]*)\}\{([^{}]*)\}")
_COMMAND = re.compile(r"\\([A-Za-z]+)")
_MARKS = re.compile(r"[$*`{}\\]")
_SIGNS = {
    "bar": "", "cdot": "·", "ge": "≥", "geq": "≥", "infty": "∞", "lambda": "λ", "le": "≤", "leq": "≤",
    "pm": "±", "sqrt": "√", "sum": "∑", "times": "×", "to": "→",
}  # fmt: skip


def unmarked(text: str) -> str:
    r"""Return a label without Markdown and TeX.

    Examples
    --------
    >>> unmarked(r"I, $K_{Popt}$: *a*"), unmarked(r"$\frac{1}{\tau}$"), unmarked("$t$ (s)")
    ('I, K_Popt: a', '1/τ', 't (s)')
    >>> unmarked(r"$|W(i\omega)|$"), unmarked(r"$T\hat\omega_A \leq 90^\circ$"), unmarked(r"$\mathrm{Im}\,L$")
    ('|W(iω)|', 'Tω_A ≤ 90°', 'Im L')
    >>> unmarked(r"$b = 2.\bar{2}$") == "b = 2.2\N{COMBINING OVERLINE}"
    True
    """
    text = _SPACE.sub(" ", text).replace(r"^\circ", "°")
    text = _BAR.sub(lambda found: f"{found[1] or found[2]}{OVERLINE}", text)
    text = _COMMAND.sub(_character, _FRACTION.sub(r"\1/\2", _FONT.sub("", text)))
    return " ".join(_MARKS.sub("", text).split())


def _character(command: re.Match[str]) -> str:
    """Return the letter or sign of a command; its name where there is none."""
    name = command[1]
    size = "CAPITAL" if name[0].isupper() else "SMALL"
    try:
        return unicodedata.lookup(f"GREEK {size} LETTER {name.removeprefix('var').upper()}")
    except KeyError:
        return _SIGNS.get(name, name)

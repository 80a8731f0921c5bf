"""LaTeX formulas to Typst and MathML, each with its words, or a message that says which one is wrong and where."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

from replicate.display.function_names import functions_apart
from replicate.display.pandoc import PandocError, refusal
from replicate.errors import TemplateError
from replicate.handout.pandoc import written
from replicate.handout.spoken_math import spoken
from replicate.handout.tree import Blocks, elements

Formula = tuple[bool, str]  # whether it is displayed on a line of its own, and its LaTeX


@dataclass(frozen=True)
class Converted:
    """One formula: Typst markup between dollar signs, a MathML element that has its words, and the words."""

    typst: str
    mathml: str
    words: str


class FormulaError(Exception):
    """A formula that pandoc does not understand; the message says why."""

    def __init__(self, tex: str, reason: str) -> None:
        super().__init__(reason)
        self.tex = tex


def formulas_in(document: Blocks) -> list[Formula]:
    """Return the different formulas of a document in the order of the text."""
    found = (element["c"] for element in elements(document) if element["t"] == "Math")
    return list(dict.fromkeys((kind["t"] == "DisplayMath", tex) for kind, tex in found))


def convert(formulas: Sequence[Formula], known: dict[Formula, Converted] | None = None) -> dict[Formula, Converted]:
    """Convert formulas, all in one call of pandoc per format.

    Parameters
    ----------
    known
        Formulas that are converted already; the new ones are added.

    Raises
    ------
    FormulaError
        For the first formula that pandoc cannot convert.
    """
    known = {} if known is None else known
    known |= _converted([formula for formula in dict.fromkeys(formulas) if formula not in known])
    return {formula: known[formula] for formula in formulas}


def _converted(formulas: Sequence[Formula]) -> dict[Formula, Converted]:
    if not formulas:
        return {}
    try:
        typst, pages = _written(formulas, "typst"), _written(formulas, "html", "--mathml")
    except PandocError:
        for formula in formulas:  # which one is it?
            try:
                _written([formula], "typst")
            except PandocError as error:
                raise FormulaError(formula[1], refusal(str(error))) from error
        raise
    mathml = [functions_apart(page[page.index("<math") : page.rindex("</math>")] + "</math>") for page in pages]
    return {
        formula: Converted(one, other.replace("<math", f'<math alttext="{escape(spoken(other))}"', 1), spoken(other))
        for formula, one, other in zip(formulas, typst, mathml, strict=True)
    }


def _written(formulas: Sequence[Formula], target: str, *options: str) -> list[str]:
    """Write each formula in a paragraph of its own."""
    kinds = {True: "DisplayMath", False: "InlineMath"}
    math = [[{"t": "Para", "c": [{"t": "Math", "c": [{"t": kinds[displayed]}, tex]}]}] for displayed, tex in formulas]
    return [part.strip() for part in written(math, target, *options)]


def located(error: FormulaError, lines: Sequence[tuple[str, int]], source: str) -> TemplateError:
    """Return an error that names file, line and formula.

    Parameters
    ----------
    lines
        The text that was converted, with the line of the source that each line stems from.
    """
    return TemplateError(f"{source}:{line_of(error.tex, lines)}: pandoc cannot convert ${error.tex}$: {error}")


def line_of(text: str, lines: Sequence[tuple[str, int]]) -> int:
    """Return the line of the source in which a text begins, however its blanks are spread; 1 if nowhere."""
    whole = "\n".join(line for line, _ in lines)
    words = r"\s+".join(re.escape(word) for word in text.split())
    found = re.search(words, whole) if words else None
    return lines[whole.count("\n", 0, found.start())][1] if found else 1

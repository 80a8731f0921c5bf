"""From a paper's ``handout.md`` to one document: numbers filled in, one edition chosen, exhibits in place."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

import pypandoc

from replicate.errors import TemplateError
from replicate.exhibits import Paper
from replicate.exhibits.file_names import display_name
from replicate.exhibits.plain_text import read_text
from replicate.exhibits.results import Results
from replicate.handout.exercise_heads import selected, with_heads
from replicate.handout.form import Form
from replicate.handout.formulas import Converted, Formula, FormulaError, convert, formulas_in, line_of, located
from replicate.handout.placing import CLOSE, OPEN, Drawing, Placed, Placing
from replicate.handout.programs import run_programs
from replicate.handout.sheet import Language, Sheet, language
from replicate.handout.tree import Blocks, Element, attribute, classes, div, elements, plain, string, text_of, transform
from replicate.verdicts.prose import Prose
from replicate.verdicts.rows import VerdictRow

FILE = "handout.md"

# "(5) and (6) give ..." is a sentence about equations, not item 5 of a list, and "<" is a less-than sign.
# What is raw is read as such, so that it can be refused with its line: the text says what, not how in one format.
_FORMAT = (
    "markdown-auto_identifiers-implicit_figures-yaml_metadata_block-fancy_lists-example_lists-citations"
    "+raw_html+raw_tex+raw_attribute-native_divs-native_spans-markdown_in_html_blocks"
)
_OPTIONS = ["--sandbox", "--fail-if-warnings", "--columns=10000"]
_FOREIGN = {
    "RawInline": "raw text for one format",
    "RawBlock": "raw text for one format",
    "Image": "an image from a file",
}
_MARK = re.compile(f"{OPEN}(\\d+){CLOSE}")


@dataclass(frozen=True)
class Document:
    """One edition of a handout, ready to be written in any format.

    Attributes
    ----------
    title
        Plain text.
    blocks
        Pandoc's tree. A figure is a Div of class ``drawing`` with its name, a table one of class ``exhibit``;
        both hold the caption in a Div of class ``caption``.
    formulas, drawings
        What the formulas and the names of drawings in the tree stand for.
    form
        The id of the form if the numbers of its exercises were drawn.
    sheet
        What a lecturer set besides.
    language
        Of the text; the words besides are in that of `sheet`.
    """

    paper: Paper
    solutions: bool
    title: str
    blocks: Blocks
    formulas: dict[Formula, Converted]
    drawings: dict[str, Drawing]
    form: str = ""
    sheet: Sheet = field(default_factory=Sheet)
    language: Language = field(default_factory=lambda: language("en"))


def edition(
    paper: Paper,
    results: Results,
    verdicts: Sequence[VerdictRow],
    *,
    solutions: bool,
    form: Form | None = None,
    sheet: Sheet | None = None,
    shared: dict[str, Any] | None = None,
) -> Document:
    """Make one edition of a paper's handout.

    Parameters
    ----------
    results, verdicts
        Of this paper, perhaps among others.
    solutions
        Whether the solutions are in it.
    form
        Whose numbers the exercises have; without one, the numbers that all share.
    sheet
        What a lecturer sets besides.
    shared
        Kept from one form to the next: what does not vary.

    Raises
    ------
    TemplateError
        If there is no handout, the text asks for something that does not exist, a program in it fails, or a
        formula cannot be converted. The message names file, line and what is wrong.
    ReplicateError
        If what is set for the sheet does not go with the text.
    """
    sheet = sheet or Sheet()
    file, text_language = _file(paper, sheet.language)
    source = display_name(file)
    if not file.is_file():
        msg = f"{source}: the paper has no handout"
        raise TemplateError(msg)
    shared = {} if shared is None else shared
    placing = Placing(paper, results, verdicts, form.draw if form else "", shared)
    prose = Prose(paper, results, verdicts, placing.functions())
    lines = prose.render_lines(read_text(file, source, TemplateError), source)
    blocks = _read(lines, source)
    if not solutions:
        blocks = transform(blocks, lambda element: [] if "solution" in classes(element) else None)
    title, blocks = _title(blocks, source)
    blocks = with_heads(blocks, source, placing.exercises, sheet)
    blocks = selected(run_programs(_placed(blocks, placing), lines, source, shared), sheet)
    try:
        formulas = convert(formulas_in(blocks), shared.setdefault("formulas", {}))
    except FormulaError as error:
        raise located(error, lines, source) from error
    drawings = {thing.name: thing for thing in placing.things if isinstance(thing, Drawing)}
    return Document(
        paper,
        solutions,
        sheet.title or title,
        blocks,
        formulas,
        drawings,
        str(form) if form else "",
        sheet,
        text_language,
    )


def without_solutions(document: Document) -> Document:
    """Return the edition for those who are to solve the exercises."""
    blocks: Blocks = transform(document.blocks, lambda element: [] if "solution" in classes(element) else None)
    kept = {formula: document.formulas[formula] for formula in formulas_in(blocks)}
    shown = {attribute(element, "name") for element in elements(blocks) if "drawing" in classes(element)}
    drawings = {name: drawing for name, drawing in document.drawings.items() if name in shown}
    return replace(document, solutions=False, blocks=blocks, formulas=kept, drawings=drawings)


def _file(paper: Paper, wanted: Language) -> tuple[Traversable, Language]:
    """Return the text in the language wanted if there is one, otherwise the English one."""
    translated = paper.folder() / f"{Path(FILE).stem}.{wanted.tag}.md"
    return (translated, wanted) if translated.is_file() else (paper.folder() / FILE, language("en"))


def _read(lines: Sequence[tuple[str, int]], source: str) -> Blocks:
    """Read Markdown into pandoc's tree."""
    text = "\n".join(line for line, _ in lines)
    try:
        tree = json.loads(pypandoc.convert_text(text, "json", format=_FORMAT, extra_args=_OPTIONS))
    except RuntimeError as error:
        words = " ".join(str(error).split())
        found = re.search(r"\[WARNING\] (.*?)(?: Failing because|$)", words)
        at = re.search(r"line (\d+)", words)
        line = lines[min(int(at[1]), len(lines)) - 1][1] if at else 1
        msg = f"{source}:{line}: pandoc cannot read the text: {found[1] if found else words}"
        raise TemplateError(msg) from error
    blocks: Blocks = tree["blocks"]
    for element in elements(blocks):
        if element["t"] in _FOREIGN:
            raise _refused(element, lines, source)
    return blocks


def _refused(element: Element, lines: Sequence[tuple[str, int]], source: str) -> TemplateError:
    """Return an error about something that a handout must not hold: it could read files, or differ by format."""
    text = element["c"][2][0] if element["t"] == "Image" else element["c"][1]
    shown = " ".join(text.split())[:60]
    instead = "figures are placed with figure(...)" if element["t"] == "Image" else r"write \< or \\ for the sign"
    msg = f"{source}:{line_of(text, lines)}: {_FOREIGN[element['t']]} is not allowed: {shown}; {instead}"
    return TemplateError(msg)


def _title(blocks: Blocks, source: str) -> tuple[str, Blocks]:
    """Split off the heading of level 1 that every handout begins with; the others move up one level."""
    if not blocks or blocks[0]["t"] != "Header" or blocks[0]["c"][0] != 1:
        msg = f"{source}:1: a handout must begin with its title, a heading of level 1"
        raise TemplateError(msg)

    def raised(element: Element) -> list[Element] | None:
        if element["t"] != "Header":
            return None
        level, attributes, content = element["c"]
        return [{"t": "Header", "c": [level - 1, attributes, content]}]

    return text_of(blocks[0]["c"][2]), transform(blocks[1:], raised)


def _placed(blocks: Blocks, placing: Placing) -> Blocks:
    """Put tables and figures where their marks are; the rest of the paragraph is the caption."""

    def changed(element: Element) -> list[Element] | None:
        if element["t"] != "Para" or not element["c"] or element["c"][0]["t"] != "Str":
            return None
        found = _MARK.match(element["c"][0]["c"])
        if found is None:
            return None
        thing = placing.things[int(found[1])]
        words = [string(element["c"][0]["c"][found.end() :]), *element["c"][1:]]
        while words and (words[0]["t"] in {"Space", "SoftBreak"} or words[0]["c"] == ""):
            words.pop(0)
        if isinstance(thing, Drawing):
            caption = [div([plain(words)], "caption")] if words else []
            return [div(caption, "drawing", name=thing.name)]
        caption = [div([plain(_with_legend(words, thing))], "caption")] if words or thing.legend else []
        return [div([thing.table, *caption], "exhibit")]

    placed: Blocks = transform(blocks, changed)
    return placed


def _with_legend(words: list[Element], thing: Placed) -> list[Element]:
    if not thing.legend:
        return words
    return [*words, *([{"t": "Space"}] if words else []), *thing.legend]

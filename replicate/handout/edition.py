"""From a paper's ``handout.md`` to one document: numbers filled in, one edition chosen, exhibits in place."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from importlib.resources.abc import Traversable
from typing import Any

from replicate.errors import TemplateError
from replicate.exhibits import Paper
from replicate.exhibits.file_names import display_name
from replicate.exhibits.results import Results
from replicate.handout.drawings import Drawing
from replicate.handout.exercise_heads import selected, with_heads
from replicate.handout.form import Form
from replicate.handout.formulas import Converted, Formula, FormulaError, convert, formulas_in, located
from replicate.handout.own_exercises import OwnExercise
from replicate.handout.placing import CLOSE, OPEN, Placed, Placing
from replicate.handout.programs import run_programs
from replicate.handout.reading import Lines, begin_of_exercise, read
from replicate.handout.sheet import Sheet
from replicate.handout.tree import Blocks, Element, attribute, classes, div, elements, plain, string, text_of, transform
from replicate.languages import Language, language
from replicate.plain_text import read_text
from replicate.verdicts.prose import Prose
from replicate.verdicts.rows import VerdictRow

TEXT = "handout"  # the name of the text, without the ending
AT_ONCE = 25  # documents in one call of pandoc

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
    source
        What messages call its text.
    """

    paper: Paper
    solutions: bool
    title: str
    blocks: Blocks
    formulas: dict[Formula, Converted]
    drawings: dict[str, Drawing]
    form: str = ""
    sheet: Sheet = field(default_factory=Sheet)
    language: Language = field(default_factory=language)
    source: str = ""


def edition(
    paper: Paper,
    results: Results,
    verdicts: Sequence[VerdictRow],
    *,
    solutions: bool,
    form: Form | None = None,
    sheet: Sheet | None = None,
    shared: dict[str, Any] | None = None,
    kind: str = TEXT,
    only_read: bool = False,
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
    kind
        Which text of the paper: its handout or its slides.
    only_read
        Whether neither programs in the text are run nor figures drawn: to see whether the text can be read.

    Raises
    ------
    TemplateError
        If there is no such text, the text asks for something that does not exist, a program in it fails, or a
        formula cannot be converted. The message names file, line and what is wrong.
    ReplicateError
        If what is set for the sheet does not go with the text.
    """
    (made,) = editions(
        paper,
        results,
        verdicts,
        solutions=solutions,
        forms=[form],
        sheet=sheet,
        shared={} if shared is None else shared,
        kind=kind,
        only_read=only_read,
    )
    return made


def editions(
    paper: Paper,
    results: Results,
    verdicts: Sequence[VerdictRow],
    *,
    solutions: bool,
    forms: Sequence[Form | None],
    sheet: Sheet | None,
    shared: dict[str, Any],
    kind: str = TEXT,
    only_read: bool = False,
) -> list[Document]:
    """Make one edition for each of several forms, in few calls of pandoc; `edition` says more."""
    sheet = sheet or Sheet()
    file, text_language = _file(paper, sheet.language, kind)
    source = display_name(file)
    if not file.is_file():
        msg = f"{source}: the paper has no {kind}"
        raise TemplateError(msg)
    content = read_text(file, source, TemplateError)
    placings = [
        Placing(paper, results, verdicts, form.draw if form else "", shared, sheet.own, only_read) for form in forms
    ]
    prose = partial(Prose, paper, results, verdicts)
    filled = [prose(one.functions()).render_lines(content, source) for one in placings]
    texts = [_Text(source, filled, read(filled, source)), *(_own_text(one, prose, placings) for one in sheet.own)]
    found: list[tuple[str, Blocks]] = []
    for number, placing in enumerate(placings):
        title, main = _title(texts[0].blocks[number], source)
        parts = [main, *(text.blocks[number] for text in texts[1:])]
        parts = parts if solutions else [_unsolved(part) for part in parts]
        with_heads([block for part in parts for block in part], source, placing.exercises, sheet)
        done: Blocks = []
        for part, text in zip(parts, texts, strict=True):
            placed = _placed(part, placing, text.lines[number], text.source)
            done += placed if only_read else run_programs(placed, text.lines[number], text.source, shared)
        found.append((title, selected(done, sheet)))
    formulas = [formulas_in(blocks) for _, blocks in found]
    try:
        known = convert([one for some in formulas for one in some], shared.setdefault("formulas", {}))
    except FormulaError as error:
        number = next(number for number, some in enumerate(formulas) if error.tex in {tex for _, tex in some})
        text = next(text for text in reversed(texts) if text.source == source or _holds(text, number, error.tex))
        raise located(error, text.lines[number], text.source) from error
    return [
        Document(
            paper,
            solutions,
            sheet.title or title,
            blocks,
            {formula: known[formula] for formula in some},
            {thing.name: thing for thing in placing.things if isinstance(thing, Drawing)},
            str(form) if form else "",
            sheet,
            text_language,
            source,
        )
        for form, placing, (title, blocks), some in zip(forms, placings, found, formulas, strict=True)
    ]


@dataclass(frozen=True)
class _Text:
    """One file, filled in and read for each form."""

    source: str
    lines: Sequence[Lines]
    blocks: Sequence[Blocks]


def _own_text(own: OwnExercise, prose: Callable[..., Prose], placings: Sequence[Placing]) -> _Text:
    """Fill in and read a lecturer's own exercise; its Div has the name under which its numbers vary."""
    filled = [prose(one.functions_of(own)).render_lines(own.text, own.source) for one in placings]
    found: list[Blocks] = []
    for blocks, lines in zip(read(filled, own.source), filled, strict=True):
        content = _own_content(blocks, own, lines)
        if not content or content[0]["t"] != "Header":
            msg = f"{own.source}:1: an exercise must begin with its title, a heading"
            raise TemplateError(msg)
        content[0]["c"][1][2].append(["vary", own.name])
        found.append([div(content, "exercise")])
    return _Text(own.source, filled, found)


def _own_content(blocks: Blocks, own: OwnExercise, lines: Lines) -> Blocks:
    """Return what an own exercise holds, which need not be a block ``exercise``, but can be all of one."""
    if len(blocks) == 1 and "exercise" in classes(blocks[0]):
        content: Blocks = blocks[0]["c"][1]
        return content
    if any("exercise" in classes(element) for element in elements(blocks)):
        msg = f"{own.source}:{begin_of_exercise(1, lines)}: the file is one exercise; leave this begin of a block out"
        raise TemplateError(msg)
    return blocks


def _holds(text: _Text, number: int, tex: str) -> bool:
    return tex in {found for _, found in formulas_in(list(text.blocks[number]))}


def _unsolved(blocks: Blocks) -> Blocks:
    out: Blocks = transform(blocks, lambda element: [] if "solution" in classes(element) else None)
    return out


def without_solutions(document: Document) -> Document:
    """Return the edition for those who are to solve the exercises."""
    blocks = _unsolved(document.blocks)
    kept = {formula: document.formulas[formula] for formula in formulas_in(blocks)}
    shown = {attribute(element, "name") for element in elements(blocks) if "drawing" in classes(element)}
    drawings = {name: drawing for name, drawing in document.drawings.items() if name in shown}
    return replace(document, solutions=False, blocks=blocks, formulas=kept, drawings=drawings)


def _file(paper: Paper, wanted: Language, kind: str) -> tuple[Traversable, Language]:
    """Return the text in the language wanted if there is one, otherwise the English one."""
    translated = paper.folder() / f"{kind}.{wanted.tag}.md"
    return (translated, wanted) if translated.is_file() else (paper.folder() / f"{kind}.md", language("en"))


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

    return text_of(blocks[0]["c"][2]), transform(blocks[1:], raised, texts=False)


def _placed(blocks: Blocks, placing: Placing, lines: Lines, source: str) -> Blocks:
    """Put tables and figures where their marks are; the rest of the paragraph is the caption.

    Raises
    ------
    TemplateError
        If one stands elsewhere than at the begin of a paragraph; with its line.
    """

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
        return [div([thing.table, *caption], "exhibit", name=thing.exhibit)]

    placed: Blocks = transform(blocks, changed, texts=False)
    if lost := _MARK.search(json.dumps(placed, ensure_ascii=False)):
        line = next((number for text, number in lines if lost[0] in text), 1)
        msg = f"{source}:{line}: a figure or table must begin a paragraph of its own; leave a line blank before it"
        raise TemplateError(msg)
    return placed


def _with_legend(words: list[Element], thing: Placed) -> list[Element]:
    if not thing.legend:
        return words
    return [*words, *([{"t": "Space"}] if words else []), *thing.legend]

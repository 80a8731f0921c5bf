"""Read the Markdown of handouts into pandoc's tree, many texts in one call; what could read files is refused."""

from __future__ import annotations

import json
import re
import tempfile
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

from replicate.display.numbers import minus_signs
from replicate.display.pandoc import PandocError, convert
from replicate.display.safe_html import strays
from replicate.errors import TemplateError
from replicate.handout.formulas import line_of
from replicate.handout.tree import Blocks, Element, classes, elements, string

Lines = Sequence[tuple[str, int]]  # of a text, each with the line of the source that it stems from

# "(5) and (6) give ..." is a sentence about equations, not item 5 of a list, and "<" is a less-than sign.
# What is raw is read as such, so that it can be refused with its line: the text says what, not how in one format.
_FORMAT = (
    "markdown-auto_identifiers-implicit_figures-yaml_metadata_block-fancy_lists-example_lists-citations"
    "+raw_html+raw_tex+raw_attribute-native_divs-native_spans-markdown_in_html_blocks"
)
_OPTIONS = ("--fail-if-warnings", "--columns=10000")
_LIMIT_ALONE = 30.0  # seconds for one text
_FOREIGN = {
    "RawInline": "raw text for one format",
    "RawBlock": "raw text for one format",
    "Image": "an image from a file",
}
BLOCKS = ("exercise", "key", "lead", "solution")  # what a text may begin with ``:::``
EXERCISE = re.compile(r"^:{3,}[ \t]*(?:exercise\b|\{[^}\n]*\.exercise\b)", re.MULTILINE)  # the begin of its block
_MARK = "\ue007"  # between two texts
_FENCE = ":::"
_WORD_FENCE = '"c":":::'  # in pandoc's JSON: the begin of a block that it took for words of the paragraph before


def read(texts: Sequence[Lines], source: str) -> list[Blocks]:
    """Read texts, each as if it were alone.

    Parameters
    ----------
    source
        What messages call the file that all of them stem from.

    Raises
    ------
    TemplateError
        If pandoc cannot read one, or it holds what no handout may; with its line.
    """
    if len(texts) == 1:
        return [_read(texts[0], source)]
    with tempfile.TemporaryDirectory() as folder:
        files = []
        for number, lines in enumerate(texts):
            files.append(Path(folder) / f"{number:05}.md")
            content = "\n".join([_MARK, "", *(line for line, _ in lines)])
            files[-1].write_text(content, encoding="utf-8", newline="\n")
        try:
            tree = convert(files, "json", _FORMAT, *_OPTIONS, "--file-scope")
        except PandocError:
            tree = ""
        if not tree or _WORD_FENCE in tree:
            return [_read(lines, source) for lines in texts]  # one of them says where
    found: list[Blocks] = []
    for block in _typeset(json.loads(tree)["blocks"]):
        if block["t"] == "Para" and block["c"] == [{"t": "Str", "c": _MARK}]:
            found.append([])
        else:
            found[-1].append(block)
    for blocks, lines in zip(found, texts, strict=True):
        _check(blocks, lines, source)
    return found


def _read(lines: Lines, source: str) -> Blocks:
    """Read Markdown into pandoc's tree."""
    text = "\n".join(line for line, _ in lines)
    try:
        tree = convert(text, "json", _FORMAT, *_OPTIONS, limit=_LIMIT_ALONE)
    except PandocError as error:
        words = " ".join(str(error).split())
        found = re.search(r"\[WARNING\] (.*?)(?: Failing because|$)", words)
        at = re.search(r"line (\d+)", words)
        line = lines[min(int(at[1]), len(lines)) - 1][1] if at else 1
        msg = f"{source}:{line}: pandoc cannot read the text: {found[1] if found else words}"
        raise TemplateError(msg) from error
    if _WORD_FENCE in tree:  # a solution that is no block would be on the sheet of those who are to find it
        place = f"{source}:{_joined_fence(lines)}"
        msg = f"{place}: '{_FENCE}' is part of a paragraph; leave a line blank before a block begins"
        raise TemplateError(msg)
    blocks: Blocks = _typeset(json.loads(tree)["blocks"])
    _check(blocks, lines, source)
    return blocks


def _typeset(node: Any) -> Any:
    """Return a tree whose numbers have minus signs, and stay on one line with a "%" after them."""
    if isinstance(node, dict):
        return {**node, "c": _typeset(node["c"])} if isinstance(node.get("c"), list) else node
    if not isinstance(node, list):
        return node
    out: list[Any] = []
    for child in node:
        if not (isinstance(child, dict) and child.get("t") == "Str"):
            out.append(_typeset(child))
            continue
        text = minus_signs(child["c"])
        match out[-2:]:
            case [{"t": "Str", "c": number}, {"t": "Space" | "SoftBreak"}] if (
                text.startswith("%") and number[-1].isdigit()
            ):
                out[-2:] = [string(f"{number}\N{NO-BREAK SPACE}{text}")]
            case _:
                out.append(string(text))
    return out


def _joined_fence(lines: Lines) -> int:
    """Return the line of the first block that begins right below a text; 1 if there is none."""
    found = (
        number
        for (before, _), (line, number) in pairwise(lines)
        if line.lstrip().startswith(_FENCE) and line.strip(" :") and before.strip() and not before.startswith(_FENCE)
    )
    return next(found, 1)


def begin_of_exercise(number: int, lines: Lines) -> int:
    """Return the line in which the block of an exercise begins, counted from one; 1 if there are fewer."""
    found = [line for text, line in lines if EXERCISE.match(text)]
    return found[number - 1] if number <= len(found) else 1


def _check(blocks: Blocks, lines: Lines, source: str) -> None:
    number = 0
    for element in elements(blocks):
        if element["t"] in _FOREIGN:
            raise _refused(element, lines, source)
        if element["t"] == "Link" and strays(address := element["c"][2][0]):
            msg = f"{source}:{line_of(address, lines)}: the link leads to {address}, allowed: http, https, mailto, doi"
            raise TemplateError(msg)
        if element["t"] == "Div" and not set(BLOCKS).intersection(classes(element)):
            name = " ".join(classes(element))
            line = next((number for text, number in lines if re.match(rf":::.*\b{re.escape(name)}\b", text)), 1)
            msg = f"{source}:{line}: no block '{name}'; allowed: {', '.join(BLOCKS)}"
            raise TemplateError(msg)
        if "exercise" in classes(element):
            number += 1
            if any("exercise" in classes(inside) for inside in elements(element["c"][1])):
                line = begin_of_exercise(number + 1, lines)
                msg = f"{source}:{line}: an exercise begins inside another; end that first"
                raise TemplateError(msg)


def _refused(element: Element, lines: Lines, source: str) -> TemplateError:
    """Return an error about something that a handout must not hold: it could read files, or differ by format."""
    text = element["c"][2][0] if element["t"] == "Image" else element["c"][1]
    shown = " ".join(text.split())[:60]
    instead = "figures are placed with figure(...)" if element["t"] == "Image" else r"write \< or \\ for the sign"
    msg = f"{source}:{line_of(text, lines)}: {_FOREIGN[element['t']]} is not allowed: {shown}; {instead}"
    return TemplateError(msg)

"""The key of a class set as CSV and PDF: what each student is to find, and what is accepted."""

from __future__ import annotations

import csv
import io
import json
import re
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, fields, replace
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_EVEN, Context, Decimal
from pathlib import Path

import typst

from replicate.errors import TemplateError
from replicate.exhibits import Paper
from replicate.exhibits.variants import Answer, Variation
from replicate.handout.form import Form
from replicate.handout.key_figures import KeyFigure
from replicate.handout.letters import FAMILIES, can_be_set, fonts
from replicate.resources import templates_dir

TEMPLATE = "handout_key.typ"
_FORMULA = ("=", "+", "-", "@")  # how one begins in a spreadsheet
_NUMBER = re.compile(r"[-+]?\d+(\.\d+)?")
_DIGITS = 7  # of the key's numbers, more than any answer is stated with


@dataclass(frozen=True)
class KeyRow:
    """One answer of one student; numbers as text, the ends of the interval rounded outwards."""

    student: str
    exercise: str
    part: str
    answer: str
    lower: str
    upper: str
    unit: str
    form: str


def key_rows(variations: Mapping[str, Variation], student: str, form: Form) -> list[KeyRow]:
    """Return the answers of a student.

    Raises
    ------
    PaperDefinitionError
        If no draw satisfies what an exercise requires, or an answer does not exist.
    """
    rows = []
    for name, variation in variations.items():
        for part, answer in variation.answers(variation.drawn(form.draw)).items():
            numbers = plain_decimals(answer.value), *accepted_ends(answer)
            rows.append(KeyRow(student, name, part, *numbers, answer.unit, str(form)))
    return rows


def key_csv(rows: Sequence[KeyRow]) -> bytes:
    """Return the key as CSV, one answer a line; a text that a spreadsheet would run has an apostrophe before it."""
    shown = [{name: _not_run(text) for name, text in asdict(row).items()} for row in rows]
    return _csv(shown)


def _csv(rows: Iterable[dict[str, str]]) -> bytes:
    text = io.StringIO(newline="")
    writer = csv.DictWriter(text, [field.name for field in fields(KeyRow)], lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue().encode()


def _not_run(text: str) -> str:
    """Return a text so that no spreadsheet takes it for a formula; a number stays one.

    Examples
    --------
    >>> [_not_run(text) for text in ("=1+1", "@ada", "-1.5", "+1", "a=b")]
    ["'=1+1", "'@ada", '-1.5', '+1', 'a=b']
    """
    return f"'{text}" if text.startswith(_FORMULA) and not _NUMBER.fullmatch(text) else text


def key_pdf(rows: Sequence[KeyRow], paper: Paper, seed: str, figures: Iterable[KeyFigure] = ()) -> bytes:
    """Return the key as PDF; a student whose name no font at hand can show stands there by the key of the form.

    Parameters
    ----------
    figures
        Behind the table.

    Raises
    ------
    TemplateError
        If it cannot be set.
    """
    names = {row.student: row.student if can_be_set(row.student) else row.form.split(":")[1] for row in rows}
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        (root / "key.csv").write_bytes(_csv(asdict(replace(row, student=names[row.student])) for row in rows))
        listed: dict[str, list[dict[str, str]]] = {}
        for number, figure in enumerate(figures):
            (root / f"{number}.svg").write_text(figure.drawing.svg, encoding="utf-8")
            about = {"file": f"{number}.svg", "student": names[figure.student], "alt": figure.drawing.alt}
            listed.setdefault(figure.heading, []).append(about)
        (root / "figures.json").write_text(json.dumps(listed), encoding="utf-8")
        (root / TEMPLATE).write_text((templates_dir() / TEMPLATE).read_text(encoding="utf-8"), encoding="utf-8")
        about_key = {"paper": paper.id, "citation": paper.citation, "seed": seed, "fonts": FAMILIES}
        try:
            compiler = typst.Compiler(str(root / TEMPLATE), root=str(root), font_paths=fonts(), sys_inputs=about_key)
            made = compiler.compile(format="pdf", pdf_standards=["ua-1"])
        except typst.TypstError as error:
            msg = f"{paper.id}: the key cannot be typeset: {error.message}"
            raise TemplateError(msg) from error
    assert isinstance(made, bytes)  # noqa: S101  -- for the type checker: one PDF, not a list of pages
    return made


def accepted_ends(answer: Answer) -> tuple[str, str]:
    """Return the ends of the accepted interval in plain decimals, rounded outwards."""
    lower, upper = answer.accepted
    return plain_decimals(lower, ROUND_FLOOR), plain_decimals(upper, ROUND_CEILING)


def plain_decimals(value: float, rounding: str = ROUND_HALF_EVEN) -> str:
    """Return a number in plain decimals, so that any spreadsheet reads it."""
    return format(Context(prec=_DIGITS, rounding=rounding).create_decimal(Decimal(value)).normalize(), "f")

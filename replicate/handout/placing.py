r"""The functions that only a handout's text can call: they place tables and figures and ask for answers.

``table(exhibit, columns=[...], rows=[...], readings={id: heading}, labels={key: text}, printed=True, digits=0,
transposed=False)``
    a table of the paper, each printed value beside what the readings compute;
``figure(name, width=1.0, size=None)``
    a figure of the paper or of the handout's own, as a vector drawing; with a size in inches
    it is drawn anew at that size;
``dots(exhibit, columns=[...], rows=[...], readings={id: words}, labels={key: text}, printed="as printed",
axis="", log=False, transposed=False, size=(6.2, 2.8))``
    a table as a figure: for each row a ring for what is printed and a dot for what each reading computes;
``inputs(name)``
    the numbers of an exercise whose numbers vary, by their names;
``stated(name)``
    how its answers are to be rounded, on the sheets of a class; nothing on the handout that all share;
``answer(name)``
    what a function in the paper's ``handout.py`` computes for an exercise, by the names of its values;
``try_it(table, row)``
    a link to the page on which the row's loop can be tried out; on paper its name and the row's;
``tex(number, digits=3)``, ``fixed(number, decimals)``, ``percent(number, digits=2)``
    a number for use in a formula, say ``4.2 \cdot 10^{-5}``; with fixed decimals; times 100.

A table or figure leaves a mark in the text, a paragraph of its own; what follows the call in the same
paragraph is the caption.
"""

from __future__ import annotations

import importlib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from importlib.resources.abc import Traversable
from types import ModuleType
from typing import Any

from replicate.display.addresses import TRIALS, trial_address, trial_label
from replicate.display.inline_svg import description
from replicate.display.tables import TableView, table_view
from replicate.errors import PaperDefinitionError, TemplateError, listed
from replicate.exhibits import Figure, Paper, Table
from replicate.exhibits.exercises import Exercises, Values
from replicate.exhibits.results import FigureResult, Results, TableResult, errors_of
from replicate.exhibits.variants import Inputs, Variation
from replicate.handout.dots import DotChoice, dot_figure
from replicate.handout.drawings import Drawing, DrawnLater, Wanted, pictures_of, said_by, undrawn
from replicate.handout.formula_numbers import fixed, percent, tex
from replicate.handout.key_table import Choice, key_table, legend, transposed_view
from replicate.handout.own_code import OwnCode
from replicate.handout.own_exercises import OwnExercise, with_own
from replicate.handout.tree import Element
from replicate.verdicts.rows import VerdictRow

TEXT_WIDTH = 6.3  # inches between the margins of the printed page

OPEN, CLOSE = "\ue002", "\ue003"


@dataclass(frozen=True)
class Placed:
    """A table to be placed, with the meaning of its signs."""

    exhibit: str
    table: Element
    legend: list[Element]


@dataclass
class Placing:
    """Collects what the text places, by the number in its mark.

    Parameters
    ----------
    paper, results, verdicts
        What the handout is about.
    form
        The key of the form whose numbers are drawn; empty for the numbers that all share.
    shared
        Drawings and answers that no form changes; one dict for all the sheets of a class.
    own
        Exercises of a lecturer's own.
    only_read
        Whether figures that the run has not drawn are left for later.
    """

    paper: Paper
    results: Results
    verdicts: Sequence[VerdictRow]
    form: str = ""
    shared: dict[str, Any] = field(default_factory=dict)
    own: tuple[OwnExercise, ...] = ()
    only_read: bool = False
    things: list[Drawing | Placed] = field(default_factory=list)
    _answers: dict[str, Values] = field(default_factory=dict)

    def functions(self) -> dict[str, Any]:
        """Return the functions by the names that the text uses."""
        return {
            "table": self.table,
            "figure": self.figure,
            "dots": self.dots,
            "answer": self.answer,
            "inputs": self.inputs,
            "stated": self.stated,
            "try_it": self.try_it,
            "tex": tex,
            "fixed": fixed,
            "percent": percent,
        }

    @cached_property
    def exercises(self) -> Exercises:
        """The answers and figures of the handout."""
        return with_own(exercises_of(self.paper), self.own)

    def __post_init__(self) -> None:
        """Compute the answers of a form before its text is filled in, which traces each call of a function."""
        if not self.form:
            return
        for name in self.exercises.variations:
            with suppress(Exception):  # the text that asks for it says where
                self.answer(name)

    def functions_of(self, own: OwnExercise) -> dict[str, Any]:
        """Return the fields that the text of a lecturer's own exercise has; what is its own needs no name."""
        with said_by("answers(inputs)"):
            fields = {"inputs": self.inputs(own.name), "answer": self.answer(own.name), "stated": self.stated(own.name)}
        return {**fields, "figure": self.figure, "tex": tex, "fixed": fixed, "percent": percent}

    def answer(self, name: str) -> Values:
        """Return the answer of that name; it is computed once."""
        variation = self.exercises.variations.get(name)
        if variation is None and name not in self.exercises.answers:
            known = [*self.exercises.answers, *self.exercises.variations]
            msg = f"answer('{name}'): no such answer; allowed: {listed(known)}"
            raise TemplateError(msg)
        kept = self.shared if variation is None else self._answers
        if name not in kept:
            with said_by(f"answer('{name}')"):
                if variation is None:
                    kept[name] = self.exercises.answers[name]()
                else:
                    drawn = self.inputs(name)
                    found = {key: answer.value for key, answer in variation.answers(drawn).items()}
                    kept[name] = {**variation.shown(drawn), **found}
        values: Values = kept[name]
        return values

    def inputs(self, name: str) -> Inputs:
        """Return the numbers of an exercise on this form."""
        variation = self._variation("inputs", name)
        return dict(variation.drawn(self.form) if self.form else variation.original)

    def stated(self, name: str) -> str:
        """Return how the answers to an exercise are to be rounded, with a space before it, on a form only."""
        variation = self._variation("stated", name)
        return f" {variation.stated}" if self.form and variation.stated else ""

    def try_it(self, table: str, row: str, case: str = "") -> str:
        """Return a link, in Markdown, to the page that holds the loop of a table's row, or of one case of it."""
        result = self.results.get((self.paper.id, table))
        trials = result.trials.declared if isinstance(result, TableResult) else ()
        for trial in trials:
            if (trial.row, trial.case) == (row, case):
                label = trial_label(self.paper, table, row, case)
                return f"[{TRIALS} ({label})]({trial_address(trial.plant, trial.controller)})"
        asked, *allowed = (
            "', '".join(filter(None, names)) for names in ((table, row, case), *(one[:2] for one in trials))
        )
        failed = "; ".join(errors_of(result).values()) if isinstance(result, TableResult) else ""
        msg = f"try_it('{asked}'): {failed or f'no loop to try out; allowed: {listed(allowed)}'}"
        raise TemplateError(msg)

    def _variation(self, function: str, name: str) -> Variation:
        if name not in self.exercises.variations:
            msg = f"{function}('{name}'): no such exercise; allowed: {listed(self.exercises.variations)}"
            raise TemplateError(msg)
        return self.exercises.variations[name]

    def table(
        self,
        exhibit: str,
        columns: Sequence[str] = (),
        rows: Sequence[str] = (),
        readings: Mapping[str, str] | None = None,
        labels: Mapping[str, str] | None = None,
        printed: bool = True,
        digits: int = 0,
        transposed: bool = False,
    ) -> str:
        """Place a table of the paper; it is the same on all sheets."""
        choice = Choice(columns, rows, readings, labels, printed, digits, transposed)
        key = f"table {exhibit} {choice}"
        if key not in self.shared:
            self.shared[key] = self._table(exhibit, choice)
        return self._mark(self.shared[key])

    def _table(self, exhibit: str, choice: Choice) -> Placed:
        view = self._view("table", exhibit)
        with _refused_by(f"table('{exhibit}')"):
            placed = key_table(view, choice)
        return Placed(exhibit, placed, legend(view, choice) if choice.printed else [])

    def dots(
        self,
        exhibit: str,
        columns: Sequence[str] = (),
        rows: Sequence[str] = (),
        readings: Mapping[str, str] | None = None,
        labels: Mapping[str, str] | None = None,
        printed: str = "as printed",
        axis: str = "",
        log: bool = False,
        transposed: bool = False,
        size: tuple[float, float] = (6.2, 2.8),
    ) -> str:
        """Place a table of the paper as a figure; it is the same on all sheets."""
        choice = DotChoice(columns, rows, readings or {}, labels or {}, printed, axis, log)
        key, name = f"dots {exhibit} {choice} {transposed} {size}", f"dots-{len(self.things)}"
        if key not in self.shared:
            view = self._view("dots", exhibit)
            view = transposed_view(view) if transposed else view
            with _refused_by(f"dots('{exhibit}')"):
                drawn = dot_figure(view, choice, name, size)
            if self.only_read:
                return self._mark(undrawn(drawn, 1.0))
            self.shared[key] = pictures_of(f"dots('{exhibit}')", self.paper.id, drawn)
        svg, png, alt = self.shared[key]
        return self._mark(Drawing(name, svg, png, alt, min(1.0, size[0] / TEXT_WIDTH)))

    def _view(self, function: str, exhibit: str) -> TableView:
        found, result = self.paper.exhibits.get(exhibit), self.results.get((self.paper.id, exhibit))
        if not isinstance(found, Table) or not isinstance(result, TableResult):
            known = [id for id, other in self.paper.exhibits.items() if isinstance(other, Table)]
            msg = f"{function}('{exhibit}'): no such table was computed; the paper has: {listed(known)}"
            raise TemplateError(msg)
        if result.errors:
            reading, why = next(iter(result.errors.items()))
            msg = f"{function}('{exhibit}'): the reading '{reading}' failed: {why}"
            raise TemplateError(msg)
        verdicts = [row for row in self.verdicts if row.paper == self.paper.id and row.exhibit == exhibit]
        return table_view(found, result, verdicts)

    def figure(self, name: str, width: float = 1.0, size: tuple[float, float] | None = None) -> str:
        """Place a figure of the handout's own, or else one of the paper."""
        own, found = self.exercises.figures.get(name), self.paper.exhibits.get(name)
        varied = self._varied(name, min(1.0, size[0] / TEXT_WIDTH) if size else width, size)
        if varied is not None:
            return self._mark(varied)
        if own is not None or (size is not None and isinstance(found, Figure)):
            drawn = own or found
            assert isinstance(drawn, Figure)  # noqa: S101  -- for the type checker
            if size is not None:
                drawn, width = replace(drawn, size=size), min(1.0, size[0] / TEXT_WIDTH)
            if self.only_read:
                return self._mark(undrawn(drawn, width))
            drawing_key = f"figure {name} {size}"
            if drawing_key not in self.shared:
                self.shared[drawing_key] = pictures_of(f"figure('{name}')", self.paper.id, drawn)
            svg, png, alt = self.shared[drawing_key]
            return self._mark(Drawing(name, svg, png, alt, width))
        known = self.results.get((self.paper.id, name))
        if not isinstance(found, Figure) or not isinstance(known, FigureResult):
            figures = [id for id, other in self.paper.exhibits.items() if isinstance(other, Figure)]
            varied_names = [one for variation in self.exercises.variations.values() for one in variation.figures]
            known_names = listed([*self.exercises.figures, *varied_names, *figures])
            msg = f"figure('{name}'): no such figure; allowed: {known_names}"
            raise TemplateError(msg)
        if known.error:
            msg = f"figure('{name}'): could not be drawn: {known.error}"
            raise TemplateError(msg)
        return self._mark(Drawing(name, known.svg, known.png, description(found.alt, known.axes), width))

    def _varied(self, name: str, width: float, size: tuple[float, float] | None) -> DrawnLater | None:
        """Return a figure that shows the numbers of this form."""
        for variation in self.exercises.variations.values():
            figure = variation.figures.get(name)
            if figure is not None:
                owner = f"{self.paper.id}-handout"
                wanted = Wanted(owner, name, variation.name, name, self.form, figure.title, size or figure.size)
                return DrawnLater(wanted, figure.alt, width, self.exercises.variations)
        return None

    def _mark(self, thing: Drawing | Placed) -> str:
        self.things.append(thing)
        return f"{OPEN}{len(self.things) - 1}{CLOSE}"


def code_of(paper: Paper) -> Traversable:
    """Return where the functions of a paper's handout lie, if it has any."""
    return paper.folder() / "handout.py"


def exercises_of(paper: Paper) -> Exercises:
    """Return what a paper's handout computes and draws; nothing if its package has no module for it.

    Raises
    ------
    PaperDefinitionError
        If the module fails, or defines no `Exercises`.
    """
    file = code_of(paper)
    if not file.is_file():
        return Exercises()
    with OwnCode(str(file), f"{paper.id}/handout.py").running("the module"):
        module = importlib.import_module(f"{paper.package}.handout")
    return _exercises_in(module, paper.id)


@cache
def _exercises_in(module: ModuleType, paper: str) -> Exercises:
    found = getattr(module, "exercises", None)
    if not isinstance(found, Exercises):
        msg = f"{paper}/handout.py: defines no 'exercises' that is a replicate.exhibits.exercises.Exercises"
        raise PaperDefinitionError(msg)
    return OwnCode(str(module.__file__), f"{paper}/handout.py").exercises(found)


@contextmanager
def _refused_by(call: str) -> Iterator[None]:
    """Say which call of a text asks for what there is not."""
    try:
        yield
    except TemplateError as error:
        msg = f"{call}: {error}"
        raise TemplateError(msg) from error

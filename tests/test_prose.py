from __future__ import annotations

from collections.abc import Callable

import pytest
import synthetic

from replicate.errors import TemplateError
from replicate.verdicts.inputs import Inputs
from replicate.verdicts.judge import judge
from replicate.verdicts.ledger import Ledger, LedgerEntry
from replicate.verdicts.prose import Prose

COMPUTED = "computed: 'table-1', 'fig-1', 'claims'"
VERDICTS = (
    "reproduced, consistent, reconstructed, near, misprint, damaged, discrepant, unexplained, not-computable, "
    "holds, holds-partly, undecided, fails"
)


def prose(functions: dict[str, Callable[..., object]] | None = None, **errors: str) -> Prose:
    """Prose of a paper where A x holds, A y is a misprint and B x is reconstructed."""
    paper = synthetic.paper()
    run = synthetic.results(
        as_written=synthetic.frame(ax=1.0, ay=2 / 3, bx=9.0, by=float("nan")),
        authors=synthetic.frame(ay=1234567.891),
        errors={key.replace("_", "-"): text for key, text in errors.items()},
    )
    ledger = Ledger((LedgerEntry("table-1", ("A",), ("y",), "misprint", "Why."),))
    judgement = judge(paper, run, Inputs(synthetic.printed(ay="6.67"), ledger))
    return Prose(paper, run, judgement.verdicts, functions)


@pytest.mark.parametrize(
    ("template", "text"),
    [
        ("{{ value('table-1', 'A', 'y') }}", "0.666667"),
        ("{{ value('table-1', 'A', 'y', digits=3) }}", "0.667"),
        ("{{ value('table-1', 'A', 'y', 'authors', digits=9) }}", "1234567.89"),
        ("{{ value('table-1', 'A', 'x') }}", "1"),
        ("{{ (number('table-1', 'B', 'x') / 7) | digits(4) }}", "1.286"),
        ("{{ -0.0 | digits }}", "0"),
        ("{{ printed('table-1', 'A', 'y') }}", "6.67"),
        ("{{ printed('claims', 'big', 'claim') }}", "2.5"),
        ("{{ verdict('table-1', 'A', 'y') }}", "misprint"),
        ("{{ verdict('claims', 'smooth') }}", "fails"),
        ("{{ count() }}", "4"),
        ("{{ count('table-1') }}", "4"),
        ("{{ count(verdict='reconstructed') }}", "2"),
        ("{{ count('table-1', 'reproduced') }}", "1"),
        ("{{ count('claims') }}", "2"),
        ("{{ count(verdict='holds') }}", "1"),
        ("{{ claim('big').value | digits(2) }} {{ claim('big').verdict }}", "3.1 holds"),
        ("# Title {#id}\n\n$e^{{'{'}}-s}$ & <b>\n", "# Title {#id}\n\n$e^{-s}$ & <b>\n"),
        ("a<!--# not shown #-->b", "ab"),
    ],
)
def test_pulls_results(template: str, text: str) -> None:
    assert prose().render(template, "toy/notes.md") == text


@pytest.mark.parametrize(
    ("template", "message"),
    [
        (
            "{{ value('table-1', 'C', 'x') }}",
            "value('table-1', 'C', 'x', 'as-written'): row 'C' is missing; rows: 'A', 'B'; columns: 'x', 'y'",
        ),
        (
            "{{ value('table-1', 'B', 'y') }}",
            "value('table-1', 'B', 'y', 'as-written'): nothing is computed there",
        ),
        (
            "{{ value('table-1', 'A', 'x', 'ours') }}",
            "value('table-1', 'A', 'x', 'ours'): no such reading; allowed: 'as-written', 'authors'",
        ),
        (
            "{{ value('table-9', 'A', 'x') }}",
            f"value('table-9', 'A', 'x', 'as-written'): 'table-9' is not an exhibit; {COMPUTED}",
        ),
        (
            "{{ value('fig-2', 'A', 'x') }}",
            f"value('fig-2', 'A', 'x', 'as-written'): 'fig-2' was not computed; {COMPUTED}",
        ),
        (
            "{{ value('fig-1', 'A', 'x') }}",
            "value('fig-1', 'A', 'x', 'as-written'): 'fig-1' is not a table; allowed: 'table-1'",
        ),
        (
            "{{ printed('table-1', 'A', 'z') }}",
            "printed('table-1', 'A', 'z'): the paper prints no value there; columns in that row: 'x', 'y'",
        ),
        (
            "{{ verdict('claims', 'huge') }}",
            "verdict('claims', 'huge', 'claim'): the paper prints no value there; rows: 'big', 'smooth'",
        ),
        (
            "{{ count(verdict='right') }}",
            f"count: 'right' is not a verdict; allowed: {VERDICTS}",
        ),
        (
            "{{ count('table-9') }}",
            f"count('table-9'): 'table-9' is not an exhibit; {COMPUTED}",
        ),
        ("{{ claim('huge') }}", "claim('huge', 'claims'): no such claim; allowed: 'big', 'smooth'"),
        (
            "{{ claim('big', 'table-1') }}",
            "claim('big', 'table-1'): 'table-1' holds no claims; allowed: 'claims'",
        ),
        (
            "{{ valeu('table-1', 'A', 'x') }}",
            "'valeu' is undefined; known: claim, count, lower, number, printed, upper, value, verdict",
        ),
        ("{{ claim('big').vlaue }}", "'replicate.exhibits.claims.Finding object' has no attribute 'vlaue'"),
        ("{{ number('table-1', 'A', 'x') / 0 }}", "float division by zero"),
        (
            "{{ value('table-1') }}",
            "Prose._value() missing 2 required positional arguments: 'row' and 'column'",
        ),
        ("{{ value('table-1', }", "unexpected '}', expected ')'"),
    ],
)
@pytest.mark.parametrize("lines_before", [0, 2])
def test_what_does_not_exist_is_an_error_with_its_line(template: str, message: str, lines_before: int) -> None:
    text = "Prose.\n" * lines_before + template + "\nMore."
    with pytest.raises(TemplateError) as caught:
        prose().render(text, "toy/notes.md", first_line=10)
    assert str(caught.value) == f"toy/notes.md:{10 + lines_before}: {message}"


def test_a_reading_that_failed_says_so() -> None:
    with pytest.raises(TemplateError, match=r"^toy/notes\.md:1: value\(.*'authors'\): the reading failed: no grid$"):
        prose(authors="no grid").render("{{ value('table-1', 'A', 'x', 'authors') }}", "toy/notes.md")


def test_more_functions() -> None:
    def place(id: str) -> str:
        if id != "table-1":
            msg = f"exhibit('{id}') does not exist"
            raise TemplateError(msg)
        return f"<{id}>"

    made = prose({"exhibit": place})
    assert made.render("{{ exhibit('table-1') }}", "toy/notes.md") == "<table-1>"
    with pytest.raises(TemplateError, match=r"^toy/notes\.md:2: exhibit\('x'\) does not exist$"):
        made.render("\n{{ exhibit('x') }}", "toy/notes.md")

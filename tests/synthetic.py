"""A tiny paper made up for tests: one table, one figure, two claims, one exhibit that cannot be computed."""

from __future__ import annotations

from collections.abc import Mapping
from decimal import Decimal
from pathlib import Path

import pandas as pd

from replicate.exhibits import Finding, Paper
from replicate.exhibits.printed import Key, PrintedValue
from replicate.exhibits.results import ClaimsResult, FigureResult, Result, TableResult

ROWS = ("A", "B")
COLUMNS = ("x", "y")


class FolderPaper(Paper):
    """A paper whose data files lie in a folder of the test, not in a package."""

    data_folder: Path

    def folder(self) -> Path:
        return self.data_folder


def never() -> pd.DataFrame:
    """Stand in for a reading: judging must not compute anything."""
    msg = "judging called a reading"
    raise AssertionError(msg)


def never_checked() -> Finding:
    msg = "judging called a check"
    raise AssertionError(msg)


def paper(folder: Path | None = None, *, significant_digits: int | None = None) -> Paper:
    """Make the paper; nothing in it is ever computed, tests hand in the results."""
    made = FolderPaper("toy", "toy", "Toy", ("N. N.",), "Toy (2000)", 2000, (), ("table-1", "fig-1", "fig-2"))
    if folder is not None:
        made.data_folder = folder
    table = made.table("table-1", "Numbers", rows=ROWS, columns=COLUMNS, significant_digits=significant_digits)
    table.reading("as-written", "As written")(never)
    table.reading("authors", "As the authors computed")(never)

    @made.figure("fig-1", "Curves")
    def _draw(fig: object) -> None:
        msg = f"judging drew {fig}"
        raise AssertionError(msg)

    claims = made.claims()
    claims.claim("big", "x is above 2.5", printed="2.5")(never_checked)
    claims.claim("smooth", "y is smooth")(never_checked)
    made.not_computable("fig-2", "A photograph", "It shows the plant.")
    return made


FINDINGS = {
    "big": Finding("holds", 3.1, "The smallest is 3.1."),
    "smooth": Finding("fails", 0.2, "It jumps."),
}


def frame(ax: object = 1.0, ay: object = 2.0, bx: object = 3.0, by: object = 4.0) -> pd.DataFrame:
    return pd.DataFrame([[ax, ay], [bx, by]], index=list(ROWS), columns=list(COLUMNS))


def results(
    as_written: pd.DataFrame | None = None,
    authors: pd.DataFrame | None = None,
    errors: Mapping[str, str] | None = None,
    findings: Mapping[str, Finding] | None = None,
) -> dict[tuple[str, str], Result]:
    """Results of a run; a reading that is not given agrees with `frame`, one with an error has no frame."""
    errors = dict(errors or {})
    given = {"as-written": as_written, "authors": authors}
    frames = {id: frame() if made is None else made for id, made in given.items() if id not in errors}
    nothing = pd.DataFrame(columns=["panel", "curve", "x", "y"])
    return {
        ("toy", "table-1"): TableResult("toy", "table-1", frames, errors),
        ("toy", "fig-1"): FigureResult("toy", "fig-1", "<svg/>", b"png", nothing, []),
        ("toy", "claims"): ClaimsResult("toy", "claims", dict(findings or FINDINGS)),
    }


def printed(
    ax: str = "1.0", ay: str = "2.0", bx: str = "3.0", by: str = "4.0", significant_digits: int | None = None
) -> dict[str, dict[Key, PrintedValue]]:
    """The printed table; an empty text is a blank cell."""
    texts = {("A", "x"): ax, ("A", "y"): ay, ("B", "x"): bx, ("B", "y"): by}
    return {
        "table-1": {
            key: PrintedValue(text, *key, significant_digits=significant_digits) for key, text in texts.items() if text
        }
    }


def decimal_text(digits: int, exponent: int) -> str:
    """Write digits * 10**exponent the way a paper prints it, without an exponent."""
    return f"{Decimal(digits).scaleb(exponent):f}"

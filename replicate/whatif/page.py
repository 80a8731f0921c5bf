"""Put the page together: one file that opens from the file system and fetches nothing."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Any

from markupsafe import Markup

import replicate
from replicate.display.addresses import TRIALS
from replicate.display.rendering import html_environment
from replicate.display.safe_html import policy
from replicate.exhibits import Paper
from replicate.figures.style import dark_curves
from replicate.resources import templates_dir
from replicate.whatif.rows import Row, rows_of

NAME = TRIALS

#: Constants of the browser's kernel: degree of a piece, pieces at most, fastest pole times length of a piece, and up to
#: which angle of the dead time, in radians, a frequency response is looked at.
CONSTANTS = {"nodes": 24, "mostPieces": 12000, "decayPerPiece": 8, "mostTurns": 2000}

#: Rooms of the framework whose code computes what stands on the page, and what they use.
ROOMS = ("display", "errors", "exhibits", "figures", "loops", "resources", "whatif")
DISTRIBUTIONS = ("matplotlib", "numpy", "scipy")

Keep = Callable[[str, Callable[[], str]], str]
"""Returns the text that an earlier run kept under a name that says all it depends on, or has it made."""

_SCRIPTS = ("kernel.js", "notation.js", "measures.js", "charts.js", "plane.js", "views.js", "page.js")


def _made(_name: str, make: Callable[[], str]) -> str:
    return make()


def whatif_page(rows: Sequence[Row], title: str = "What if?", back: str = "", keep: Keep = _made) -> str:
    """Return the page.

    Parameters
    ----------
    rows
        Loops to choose from, at least one; the page opens with the first.
    back
        Address of the overview, if the page belongs to a report.
    keep
        Keeps what takes long to compute; nothing by default.

    Raises
    ------
    LoopError
        If a plant or controller is not understood; the message names the column.
    """
    folder = templates_dir() / "whatif"
    style, *scripts = (folder.joinpath(name).read_text(encoding="utf-8") for name in ("whatif.css", *_SCRIPTS))
    style += dark_curves()
    script = f"const CONSTANTS = {json.dumps(CONSTANTS)};\n" + "\n".join(scripts)
    data = {"rows": [asdict(row) for row in rows], "markers": _markers(rows, keep), "reference": _reference(keep)}
    text = json.dumps(data, ensure_ascii=False, allow_nan=False).replace("<", "\\u003c")
    drawing = _still(rows[0], keep)
    styles = [style, *_style_elements(drawing)]
    return (
        html_environment()
        .get_template(f"whatif/{NAME}")
        .render(
            title=title,
            back=back,
            rows=rows,
            policy=policy(styles, [script]),
            style=Markup(style),  # noqa: S704 -- the project's own
            script=Markup(script),  # noqa: S704
            data=Markup(text),  # noqa: S704 -- JSON without "<"
            still=Markup(drawing),  # noqa: S704 -- drawn here; its texts are escaped
            version=replicate.__version__,
        )
    )


def write_whatif(papers: Iterable[Paper], folder: Path, back: str = "", keep: Keep = _made) -> list[Path]:
    """Write the page of the papers' rows into a folder; return the file, or nothing where no paper declares a row."""
    rows = rows_of(papers)
    if not rows:
        return []
    (folder / NAME).write_bytes(whatif_page(rows, back=back, keep=keep).encode())
    return [folder / NAME]


def _markers(rows: Sequence[Row], keep: Keep) -> dict[str, Any]:
    """Return where the tuning rules that apply put their controllers, by the text of the plant."""

    def made(plant: str) -> str:
        from replicate.whatif.reference import markers

        return json.dumps(markers(plant))

    return {
        plant: json.loads(keep(f"what if: tuning rules for {plant}", partial(made, plant)))
        for plant in dict.fromkeys(row.plant for row in rows)
    }


def _reference(keep: Keep) -> Any:
    """Return the loop of the page's self-test."""

    def made() -> str:
        from replicate.whatif.reference import reference

        return json.dumps(reference())

    return json.loads(keep("what if: the self-test", made))


def _still(row: Row, keep: Keep) -> str:
    """Return the picture that stands where no script runs."""

    def made() -> str:
        from replicate.whatif.still import still

        return still(row)

    return keep(f"what if: the picture of {row.label}, {row.plant} with {row.controller}", made)


def _style_elements(svg: str) -> list[str]:
    """Return the texts of the style elements inside a drawing."""
    return [part.partition(">")[2].partition("</style>")[0] for part in svg.split("<style")[1:]]

"""Put the page together: one file that opens from the file system and fetches nothing."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Any

from markupsafe import Markup

import replicate
from replicate.display.addresses import TRIALS
from replicate.display.keeping import Keep, made_anew
from replicate.display.rendering import html_environment
from replicate.display.safe_html import policy
from replicate.exhibits import Paper
from replicate.exhibits.results import Results
from replicate.figures.style import dark_curves
from replicate.loops.errors import LoopError
from replicate.loops.tune import marked_rules
from replicate.resources import templates_dir
from replicate.whatif.rows import FAR_APART, MOST_GAIN, Row, rows_of, why_not_drawn
from replicate.whatif.script import script

NAME = TRIALS

#: Constants of the script: degree of a piece, fastest pole times length of the first piece, last coefficients of a
#: smooth piece, dead times after which jumps are too smooth to be seen, up to which angle of the dead time, in radians,
#: a frequency response is looked at, what the page draws (`replicate.whatif.rows`); then the sensitivity peaks whose
#: contours are drawn, and the settling band. Last, for a loop at rest and one that is moved: what is left of a response
#: at its end, its pieces at most, and the steps of a limited response.
CONSTANTS = {
    "nodes": 24,
    "decayPerPiece": 8,
    "rounding": 1e-13,
    "laps": 16,
    "mostTurns": 2000,
    "mostGain": MOST_GAIN,
    "farApart": FAR_APART,
    "levels": [1.2, 1.4, 1.6, 2.0],
    "band": 0.02,
    "atRest": {"settle": 1e-11, "pieces": 12000, "steps": 12000},
    "moving": {"settle": 1e-6, "pieces": 300, "steps": 3000},
}

#: What the page gives to copy; `PLANT` and `CONTROLLER` are put in there.
PYTHON = """from replicate.loops import Loop
from replicate.loops.notation import parse_controller, parse_plant

loop = Loop(parse_plant(PLANT), parse_controller(CONTROLLER))
y, u, d, m = loop.step(), loop.respond().control, loop.load_step(), loop.margins()
print(f"overshoot {100 * y.overshoot():.4g} %, settling time {y.settling_time():.4g}, rise time {y.rise_time():.4g}")
print(f"IAE {y.iae():.4g} (set point), {d.iae():.4g} (load), total variation of u {u.total_variation():.4g}")
print(f"Ms {loop.sensitivity_peak().value:.4g}, margins: gain {m.gain:.4g}, phase {m.phase:.4g}, delay {m.delay:.4g}")
"""

#: Rooms of the framework whose code computes what stands on the page, and what they use.
ROOMS = ("display", "errors", "exhibits", "figures", "loops", "plain_text", "resources", "whatif")
DISTRIBUTIONS = ("matplotlib", "numpy", "scipy")


def whatif_page(rows: Sequence[Row], title: str = "What if?", back: str = "", keep: Keep = made_anew) -> str:
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
        If a plant or controller is not understood; the message names the column. If the page cannot draw the loop.
    """
    for reason in map(why_not_drawn, rows):
        if reason:
            raise LoopError(reason)
    style = (templates_dir() / "whatif" / "whatif.css").read_text(encoding="utf-8") + dark_curves()
    data = {
        "rows": [_with_names(row) for row in rows],
        "rules": marked_rules(),
        "optimal": _optimal(rows, keep),
        "reference": _reference(keep),
        "python": PYTHON,
        "constants": CONSTANTS,
    }
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
            policy=policy(styles, [script()]),
            style=Markup(style),  # noqa: S704 -- the project's own
            script=Markup(script()),  # noqa: S704
            data=Markup(text),  # noqa: S704 -- JSON without "<"
            still=Markup(drawing),  # noqa: S704 -- drawn here; its texts are escaped
            version=replicate.__version__,
        )
    )


def write_whatif(
    papers: Iterable[Paper], results: Results, folder: Path, back: str = "", keep: Keep = made_anew
) -> list[Path]:
    """Write the page of the papers' rows into a folder; return the file, or nothing where no paper declares a row."""
    rows = [row for row in rows_of(papers, results) if not why_not_drawn(row)]
    if not rows:
        return []
    (folder / NAME).write_bytes(whatif_page(rows, back=back, keep=keep).encode())
    return [folder / NAME]


def _with_names(row: Row) -> dict[str, str]:
    """Return a row with the names of its table and of itself, by which the gain plane marks it."""
    return {**asdict(row), "table": row.table or row.label, "name": row.name}


def _optimal(rows: Sequence[Row], keep: Keep) -> dict[str, Any]:
    """Return the controllers of largest integral gain, by the text of the plant."""

    def made(plant: str) -> str:
        from replicate.whatif.reference import optimal

        return json.dumps(optimal(plant))

    return {
        plant: json.loads(keep(f"what if: optimal controllers for {plant}", partial(made, plant)))
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

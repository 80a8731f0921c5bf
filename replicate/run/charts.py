"""Charts for parameters of the reader's choice: ``replicate chart PAPER --NAME VALUE``."""

from __future__ import annotations

import inspect
import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from replicate.errors import OutputError, ReplicateError, UnknownPaperError
from replicate.exhibits import Chart, Figure, Paper
from replicate.exhibits.file_names import display_name
from replicate.run.guarded import GuardedProcess, Place, watched
from replicate.run.limits import CHART_TIMEOUT
from replicate.run.units import loaded

FORMATS = (".svg", ".png")


def find_chart(paper: Paper, id: str | None = None) -> Chart:
    """Return a chart of a loaded paper, by default its first.

    Raises
    ------
    UnknownPaperError
        If the paper has no charts, or none of this name; the message lists those it has.
    """
    if not paper.charts:
        msg = f"{paper.id} has no charts"
        raise UnknownPaperError(msg)
    if id is None:
        return next(iter(paper.charts.values()))
    if id not in paper.charts:
        msg = f"{paper.id} has no chart '{id}'; known: {', '.join(paper.charts)}"
        raise UnknownPaperError(msg)
    return paper.charts[id]


def read_parameters(chart: Chart, arguments: Sequence[str]) -> dict[str, float]:
    """Read ``--name value`` and ``--name=value``, every parameter of the chart once.

    Raises
    ------
    ReplicateError
        If a parameter is missing, unknown, given twice or not a finite number.

    Examples
    --------
    >>> chart = Chart("nyquist", "A diagram", lambda fig, gain: None, {"gain": "loop gain"})
    >>> read_parameters(chart, ["--gain", "2.5"])
    {'gain': 2.5}
    """
    found: dict[str, float] = {}
    rest = list(arguments)
    while rest:
        name, is_joined, value = rest.pop(0).partition("=")
        key = name.removeprefix("--")
        if not name.startswith("--") or key not in chart.parameters:
            msg = f"'{name}' is not a parameter of chart '{chart.id}'; it has: {_usage(chart)}"
            raise ReplicateError(msg)
        if key in found:
            msg = f"--{key} is given twice"
            raise ReplicateError(msg)
        if not is_joined:
            if not rest:
                msg = f"--{key} needs a value: {chart.parameters[key]}"
                raise ReplicateError(msg)
            value = rest.pop(0)
        found[key] = _number(key, value)
    missing = [key for key in chart.parameters if key not in found]
    if missing:
        msg = f"chart '{chart.id}' needs --{missing[0]}: {chart.parameters[missing[0]]}"
        raise ReplicateError(msg)
    return found


def _usage(chart: Chart) -> str:
    return ", ".join(f"--{key} ({meaning})" for key, meaning in chart.parameters.items())


def _number(key: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        msg = f"--{key}: '{text}' is not a number"
        raise ReplicateError(msg)
    return value


def file_name(paper: Paper, chart: Chart, values: Mapping[str, float]) -> str:
    """Return a name made of paper, chart and parameters, for example ``lab-nyquist-gain-2.5.svg``."""
    # All digits: charts of two values must not go by one name.
    settings = "".join(f"-{key}-{repr(values[key]).removesuffix('.0')}" for key in chart.parameters)
    return f"{paper.id}-{chart.id}{settings}.svg"


def guarded_chart(paper: Paper, chart: Chart, values: Mapping[str, float], path: Path) -> bytes:
    """Return what `draw_chart` does in a process of its own, which is ended if it takes too long.

    Raises
    ------
    ReplicateError
        As `draw_chart`, and if the chart does not end, or ends the process; with file and line.
    """
    with GuardedProcess(CHART_TIMEOUT) as process:
        (content,) = process.stream(_draw, paper.package, chart.id, values, path)
    drawn: bytes = content
    return drawn


def _draw(package: str, id: str, values: Mapping[str, float], path: Path) -> Iterator[bytes]:
    paper = loaded(package)
    yield draw_chart(paper, paper.charts[id], values, path)


def draw_chart(paper: Paper, chart: Chart, values: Mapping[str, float], path: Path) -> bytes:
    """Draw a chart and return the content of a file, SVG or PNG after its name.

    Raises
    ------
    ReplicateError
        If a value makes no sense to the chart.
    OutputError
        If the file's name does not tell one of the two formats.
    """
    from replicate.run.drawing import drawn_as

    if path.suffix.lower() not in FORMATS:
        msg = f"{path}: the name must end in {' or '.join(FORMATS)}"
        raise OutputError(msg)
    figure = Figure(chart.id, "figure", chart.title, lambda fig: chart.draw(fig, **values), size=chart.size)
    code = inspect.unwrap(chart.draw).__code__
    place = Place(code.co_filename, display_name(Path(code.co_filename)), f"chart '{chart.id}'", code.co_firstlineno)
    try:
        with watched(place):
            (content,) = drawn_as(paper.id, figure, ("png" if path.suffix.lower() == ".png" else "svg",))
    except ValueError as error:
        msg = f"chart '{chart.id}': {error}"
        raise ReplicateError(msg) from error
    return content

"""Records of figures: written, read back, refused when damaged, and the same whatever fonts and layouts do."""

from __future__ import annotations

import contextlib
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
from gallery import GALLERY, T
from matplotlib.figure import Figure

from replicate.baselines.store import Store
from replicate.errors import FigureError, FigureRecordError
from replicate.figures import Record, capture, compare


def drawn(name: str, **settings: Any) -> Figure:
    figure = Figure(**settings)
    GALLERY[name](figure)
    return figure


def test_a_record_reads_back_as_it_was() -> None:
    record = capture(drawn("two_legends"))
    again = Record.from_json(record.to_json())
    assert again.to_json() == record.to_json()
    assert compare(record, again).changes == []
    assert json.loads(record.to_json())["version"] == 2


@pytest.mark.parametrize("name", ["lines", "texts", "table", "anchored", "panels", "tight", "solid_lines", "polar"])
@pytest.mark.parametrize("font", [{"font.family": "serif"}, {"font.family": "monospace", "mathtext.fontset": "cm"}])
def test_other_fonts_do_not_show(name: str, font: Any) -> None:
    accepted = capture(drawn(name))
    with mpl.rc_context(font):
        assert compare(accepted, capture(drawn(name))).changes == []


@pytest.mark.parametrize("name", ["constrained", "panels", "sub_figures"])
@pytest.mark.parametrize("layout", ["constrained", "tight"])
def test_a_figure_that_was_drawn_before_is_the_same(name: str, layout: Any) -> None:
    def laid_out() -> Figure:
        figure = Figure()
        GALLERY[name](figure)
        if name != "constrained":
            figure.set_layout_engine(layout)
        return figure

    fresh, used = laid_out(), laid_out()
    with mpl.rc_context({"font.family": "monospace"}):
        used.savefig("/dev/null", format="png", dpi=60)
    assert capture(fresh).to_json() == capture(used).to_json()


def test_capturing_leaves_the_figure_as_it_was(tmp_path: Any) -> None:
    figure, other = drawn("constrained"), drawn("constrained")
    capture(figure)
    for name, one in (("a.png", figure), ("b.png", other)):
        one.savefig(tmp_path / name, metadata={"Software": None})
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()
    assert not [artist for artist in figure.findobj() if "draw" in vars(artist)]


def test_rounding_and_other_samples_do_not_show() -> None:
    def sampled(count: int, factor: float = 1.0) -> Record:
        figure = Figure()
        t = np.linspace(0.0, 10.0, count)
        figure.subplots().plot(t, np.sin(T[-1] * t) * factor)
        return capture(figure)

    assert compare(sampled(4001), sampled(9001)).changes == []
    assert compare(sampled(4001), sampled(4001, 1.0 + 1e-10)).changes == []

    def fast(count: int) -> Record:
        figure = Figure()
        t = np.linspace(0.0, 1.0, count)
        figure.subplots().plot(t, np.sin(2.0 * np.pi * 700.0 * t))
        return capture(figure)

    assert compare(fast(150_000), fast(220_000)).changes == []


def test_an_opaque_image_is_one_with_or_without_opacity() -> None:
    def shown(*opacity: float) -> Record:
        figure = Figure()
        grey = np.linspace(0.0, 1.0, 60).reshape(6, 10)
        figure.subplots().imshow(np.dstack([grey, grey, grey, *(np.full_like(grey, part) for part in opacity)]))
        return capture(figure)

    assert compare(shown(), shown(1.0)).changes == []
    assert compare(shown(), shown(0.5)).changes


@pytest.mark.parametrize("name", ["image_large", "scatter_many", "noise", "quiver", "solid_surface", "hexbin"])
def test_a_perturbation_of_1e_10_does_not_show(name: str) -> None:
    figure = drawn(name)
    axes: Any = figure.axes[0]
    for line in axes.lines:
        line.set_ydata(np.asarray(line.get_ydata()) * (1.0 + 1e-10))
    for artist in (*axes.images, *axes.collections):
        if artist.get_array() is not None:
            artist.set_array(artist.get_array() * (1.0 + 1e-10))
    for collection in axes.collections:
        if len(collection.get_offsets()) > 1:
            collection.set_offsets(collection.get_offsets() * (1.0 + 1e-10))
    assert compare(capture(drawn(name)), capture(figure)).changes == []


def test_the_first_version_is_read() -> None:
    panels = [
        {"panel": "p", "title": "", "xlabel": "", "ylabel": "", "xlim": [0, 1], "ylim": [0, 1], "xscale": "linear"}
    ]
    record = Record.from_json(json.dumps(panels))
    assert record.version == 1
    figure = Figure()
    axes = figure.subplots()
    axes.set(xlim=(0, 2), title="p")
    assert any("x axis now ends at 2" in text for text in compare(record, capture(figure)).changes)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "is not valid JSON"),
        ("{}", "is not a record of a figure"),
        ('{"format": "figure record", "version": 3}', "was written by a newer version: its format is 3"),
        ('{"format": "figure record", "version": 2, "figure": {}, "panels": {}}', "expected: a list of objects"),
        ('{"format": "figure record", "version": 2, "figure": [], "panels": []}', "'figure' must be an object"),
        ('{"format": "figure record", "version": 2, "figure": {"parts": [1]}, "panels": []}', "parts of the figure"),
        ("[" * 100_000, "is not valid JSON: too many brackets"),
        (f"[{'9' * 400}]", r"is not valid JSON: 9+ is beyond the largest number"),
        ("[1e999]", "1e999 is beyond the largest number"),
        ('["\\ud800"]', "is not valid JSON: .*surrogates"),
    ],
)
def test_damage_is_said_in_one_line(text: str, said: str) -> None:
    with pytest.raises(FigureRecordError, match=said) as error:
        Record.from_json(text)
    assert "\n" not in str(error.value)


def test_every_damaged_value_of_a_record_is_refused_or_compared() -> None:
    whole = capture(drawn("two_legends"))
    content = json.loads(whole.to_json())

    def places(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
        below = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
        return [path, *(place for key, part in below for place in places(part, (*path, key)))]

    noise = np.random.default_rng(1)
    every = places(content)[1:]
    for number in noise.choice(len(every), 150, replace=False):
        damaged = json.loads(whole.to_json())
        *above, last = every[number]
        owner = damaged
        for key in above:
            owner = owner[key]
        owner[last] = [None, "x", -1, 10**400, [], {}][int(noise.integers(6))]
        with contextlib.suppress(FigureRecordError):  # and no other error
            compare(Record.from_json(json.dumps(damaged)), whole)
            compare(whole, Record.from_json(json.dumps(damaged)))


@pytest.mark.parametrize("wrong", [None, "figure.png", 3, Figure().subplots()])
def test_what_is_no_figure_is_refused(wrong: Any) -> None:
    with pytest.raises(FigureError, match="a matplotlib figure is needed"):
        capture(wrong)


def test_importing_it_is_light() -> None:
    script = (
        "import sys, matplotlib; before = set(sys.modules); import replicate.figures\n"
        "added = {name.partition('.')[0] for name in set(sys.modules) - before} - sys.stdlib_module_names\n"
        "print(sorted(added), {'replicate.loops', 'replicate.papers'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True)
    assert done.stdout == "['numpy', 'replicate'] set()\n"


def test_an_accepted_figure_that_cannot_be_read_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(path: Path) -> bool:
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr(Path, "is_file", refuse)
    for look in (Store(tmp_path).read, Store(tmp_path).digest):
        with pytest.raises(FigureRecordError, match=r"step-1\.json: cannot be read: Permission denied"):
            look("step-1")

"""Which line of a drawing is which curve: names come from legends of the axes or of the figure."""

from __future__ import annotations

import io
from collections.abc import Callable
from xml.etree import ElementTree as ET

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure

from replicate.display.live_curves import mark_curves
from replicate.figures.curve_labels import label_curves
from replicate.figures.describe import describe
from replicate.figures.style import style

X = np.linspace(0.0, 1.0, 5)


def named(draw: Callable[[Figure], None]) -> list[str]:
    """Return the names of the curves of a figure in the order in which they are drawn."""
    with style("live"):
        fig = Figure()
        draw(fig)
        out = io.BytesIO()
        fig.savefig(out, format="svg")
    parser = ET.XMLParser(target=ET.TreeBuilder(insert_comments=True))  # noqa: S314 -- drawn above
    root = ET.fromstring(out.getvalue(), parser=parser)  # noqa: S314
    mark_curves(root, [describe(str(place), axes) for place, axes in enumerate(fig.axes)])
    return [str(element.get("data-curve")) for element in root.iter() if element.get("data-curve") is not None]


def test_curves_that_look_alike_have_their_own_names() -> None:
    def forty(fig: Figure) -> None:
        axes = fig.subplots()
        for number in range(40):
            axes.plot(X, X + number, label=f"curve {number}")
        axes.legend(ncols=4)

    assert named(forty) == [f"curve {number}" for number in range(40)]


def test_a_legend_beside_the_axes_names_the_curves_of_all() -> None:
    def shared(fig: Figure) -> None:
        for axes in fig.subplots(1, 2):
            for name in ("PA", "ZN"):
                axes.plot(X, X, label=name)
        fig.legend(*fig.axes[0].get_legend_handles_labels(), loc="outside lower center")

    assert named(shared) == ["PA", "ZN"] * 2


def test_a_name_beside_its_curve_is_its_own() -> None:
    def labelled(fig: Figure) -> None:
        axes = fig.subplots()
        for name, slope in (("up", 1.0), ("down", -1.0)):
            axes.plot(X, slope * X, color="C0", linestyle="-", label=name)
        assert label_curves(axes)

    assert named(labelled) == ["up", "down"]


@pytest.mark.parametrize(("legend", "names"), [(["a"], ["a", "a"]), (["a", "b", "c"], ["", ""])])
def test_one_name_is_for_all_that_look_alike_and_too_many_are_for_none(legend: list[str], names: list[str]) -> None:
    def bundle(fig: Figure) -> None:
        axes = fig.subplots()
        lines = [line for shift in (0.0, 1.0) for line in axes.plot(X, X + shift, color="C0", linestyle="-")]
        axes.legend([lines[0]] * len(legend), legend)

    assert named(bundle) == names
    assert mpl.rcParams["svg.fonttype"] == "path"  # the style's settings end with it

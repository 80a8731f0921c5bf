"""Names beside curves: near their own, clear of the others, all or none."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from replicate.figures.curve_labels import label_curves
from replicate.figures.style import style

X = np.linspace(0.0, 1.0, 200)


def boxes(axes: Axes) -> dict[str, Bbox]:
    """Return where names really stand, as matplotlib lays them out, in pixels."""
    figure = axes.figure
    assert isinstance(figure, Figure)
    figure.draw_without_rendering()
    return {text.get_text(): text.get_window_extent() for text in axes.texts}


def apart(axes: Axes, box: Bbox) -> dict[str, float]:
    """Return how far curves are from a box, in pixels."""
    found = {}
    for line in axes.get_lines():
        x, y = line.get_transform().transform(np.asarray(line.get_xydata())).T
        dx = np.maximum(np.maximum(box.x0 - x, x - box.x1), 0.0)
        dy = np.maximum(np.maximum(box.y0 - y, y - box.y1), 0.0)
        found[str(line.get_label())] = float(np.hypot(dx, dy).min())
    return found


@given(st.lists(st.floats(0.2, 9.0), min_size=1, max_size=5, unique_by=lambda rate: round(rate, 1)))
def test_each_name_is_nearest_to_its_own_curve(rates: list[float]) -> None:
    with style("names"):
        axes = Figure().subplots()
        for rate in rates:
            axes.plot(X, 1.0 - np.exp(-rate * X), label=f"rate {rate:.2f}")
        if not label_curves(axes):
            assert len(axes.texts) == 0
            return
        found = boxes(axes)
        assert set(found) == {f"rate {rate:.2f}" for rate in rates}
        for name, box in found.items():
            distances = apart(axes, box)
            assert min(distances, key=distances.__getitem__) == name
            assert axes.bbox.containsx(box.x0)
            assert axes.bbox.containsx(box.x1)
        together = list(found.values())
        assert not any(one.overlaps(other) for place, one in enumerate(together) for other in together[:place])


def test_curves_that_coincide_get_no_names() -> None:
    axes = Figure().subplots()
    axes.plot(X, X, label="one")
    axes.plot(X, X, label="other")
    axes.plot(X, 1.0 - X, label="third")
    assert not label_curves(axes)
    assert len(axes.texts) == 0


@pytest.mark.parametrize("scale", ["linear", "log"])
def test_curves_without_a_label_are_avoided_but_not_named(scale: str) -> None:
    with style("names"):
        axes = Figure().subplots()
        axes.plot(X + 0.1, X + 0.1, label="$\\tau = 1$")
        axes.plot(X + 0.1, X + 0.3)
        axes.set_yscale(scale)
        axes.set_ylim(0.05, 2.0)
        assert label_curves(axes)
        (box,) = boxes(axes).values()
        assert sorted(apart(axes, box).values())[1] > 1.0


@pytest.mark.parametrize("values", [[], [0.5], [np.nan] * 5, [0.2, np.nan, 0.4, np.inf, 0.5], [0.3] * 5])
def test_curves_of_few_or_no_points_raise_nothing(values: list[float]) -> None:
    axes = Figure().subplots()
    axes.plot(range(len(values)), values, label="curve")
    assert label_curves(axes) == (len(axes.texts) == 1)

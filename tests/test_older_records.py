"""Records of an earlier release: an upgrade alone says nothing, and what both releases know is compared.

``older_records/revision-1.json`` is what the release before revisions wrote of `drawn()`.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from matplotlib.figure import Figure
from matplotlib.patheffects import Normal, SimpleLineShadow, Stroke, withStroke

from replicate.baselines.outcomes import accept, compared, draw
from replicate.baselines.store import Store
from replicate.figures import Record, capture, compare

OLD = (Path(__file__).parent / "older_records" / "revision-1.json").read_text(encoding="utf-8")


def drawn() -> Figure:
    """Texts, lines and legends whose records say more since."""
    halo = [withStroke(linewidth=3, foreground="white")]
    figure = Figure()
    figure.suptitle("whole", path_effects=halo)
    left, right = figure.subplots(1, 2)
    space = figure.add_axes((0.4, 0.1, 0.2, 0.2), projection="3d")
    left.plot([0, 1], label="a", path_effects=[Stroke(linewidth=5, foreground="black"), Normal()])
    left.plot([1, 0], label=" ", path_effects=[SimpleLineShadow(offset=(4, -4)), Normal()])
    left.text(0.2, 0.3, "halo", color="red", path_effects=halo)
    left.text(0.6, 0.3, "  ")
    left.annotate("note", (0.2, 0.2), (0.5, 0.7), arrowprops={"arrowstyle": "->"}, path_effects=halo)
    left.set_title("left", path_effects=halo)
    left.set_xlabel(" ")
    left.set_xticks([0.0, 0.5, 1.0], ["zero", " ", "one"], path_effects=halo)
    legend = left.legend(title="kinds", alignment="left", fancybox=False, loc="upper left")
    legend.get_texts()[0].set_path_effects(halo)
    right.semilogy([0, 1, 2, 3, 4], [0, 1, 10, -1, 100], "o-", label="b")
    right.plot([1, 2, 9], [2.0, float("nan"), 3.0], "s", label="c")
    right.set(title=" ", xlim=(0.0, 5.0), ylim=(0.1, 1000.0))
    right.legend(title=" ", frameon=False, loc="upper left")
    space.plot([0, 1], [0, 1], [0, 1])
    return figure


def test_an_upgrade_says_nothing_of_what_is_the_same() -> None:
    older, newer = Record.from_json(OLD), capture(drawn())
    assert older.figure != newer.figure
    assert compare(older, newer).changes == []
    assert compare(newer, older).changes == []
    assert older.outdated
    assert not newer.outdated


def _left(change: Callable[[Any], Any]) -> Callable[[Figure], Any]:
    return lambda figure: change(figure.axes[0])


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (_left(lambda axes: axes.texts[0].set_path_effects([])), "path effects of text 'halo'"),
        (_left(lambda axes: axes.texts[0].set_position((0.5, 0.3))), "text 'halo'"),
        (_left(lambda axes: axes.texts[1].set_text("now")), "text 'now'"),
        (_left(lambda axes: axes.set_title("")), "title is now nothing"),
        (_left(lambda axes: axes.lines[0].set_path_effects([])), "path effects of curve 'a'"),
        (_left(lambda axes: axes.lines[1].set_path_effects([SimpleLineShadow(offset=(9, -4)), Normal()])), "(9, -4)"),
        (_left(lambda axes: axes.set_xticks([0.0, 0.5, 1.0], ["zero", "half", "one"])), "tick labels of the x axis"),
        (_left(lambda axes: axes.get_legend().set_title("sorts")), "title of the legend"),
        (_left(lambda axes: axes.get_legend().set_frame_on(False)), "frame of legend"),
        (lambda figure: figure.axes[1].set_title("right"), "right"),
        (lambda figure: figure.suptitle("part"), "part"),
        (lambda figure: figure.axes[2].view_init(elev=50), "view"),
    ],
)
def test_what_both_releases_know_is_compared(change: Callable[[Figure], Any], said: str) -> None:
    figure = drawn()
    change(figure)
    changes = compare(Record.from_json(OLD), capture(figure)).changes
    assert any(said in text for text in changes), changes


def test_the_present_revision_compares_what_the_earlier_one_did_not_know() -> None:
    figure = drawn()
    left, _, space = figure.axes
    legend: Any = left.get_legend()
    legend.set_alignment("right")
    space.set(proj_type="ortho")
    other = capture(figure)
    assert not any("alignment" in text for text in compare(Record.from_json(OLD), other).changes)
    changes = compare(capture(drawn()), other).changes
    assert any("alignment of legend is now right (was left)" in text for text in changes)
    assert any("projection in space is now 'orthographic'" in text for text in changes)


def test_accepting_writes_an_outdated_state_anew_and_once(tmp_path: Path) -> None:
    store, shown = Store(tmp_path), draw(drawn())
    store.write("mixed", OLD, b"", "first", [])
    outcome = compared(store, "mixed", shown)
    assert outcome.status == "same"
    assert accept(store, outcome, shown, "new release").status == "accepted"
    written = store.read("mixed")
    assert written is not None
    assert not written.record.outdated
    before = store.path("mixed", ".log").read_bytes()
    assert accept(store, compared(store, "mixed", shown), shown, "again").status == "same"
    assert store.path("mixed", ".log").read_bytes() == before

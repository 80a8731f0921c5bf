"""Figures of plain plotting scripts: run off-screen, named by script and number, compared and accepted."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from replicate.baselines import scripts as baselines

Run = Callable[..., tuple[int, str, str]]

SCRIPTS = {
    "plot_saved.py": """
import matplotlib.pyplot as plt
fig, ax = plt.subplots()
ax.plot([0, 1, 2], [0, 1, 0], label="ZN")
fig.savefig("saved.png")
fig.savefig("saved.pdf")
fig.canvas.print_figure("saved.svg")
plt.close(fig)
""",
    "plot_shown.py": """
import matplotlib
matplotlib.use("TkAgg")
import matplotlib.pyplot as plt
for last in (4, 3, 2):
    plt.cla()
    plt.plot([1, last])
    plt.pause(9)
plt.show()
plt.plot([2, 1])
""",
    "plot_ended.py": """
import sys
import matplotlib.pyplot as plt
if __name__ == "__main__":
    plt.plot([3, 1])
    plt.savefig("ended.png")
    sys.exit()
""",
    "plot_forked.py": """
import os
import matplotlib.pyplot as plt
plt.figure(figsize=(900, 900))
plt.plot([1, 3])
if os.fork() == 0:
    plt.figure()
    plt.plot([9, 9])
else:
    os.wait()
""",
}
FIGURES = [
    "plots/plot_ended-1",
    "plots/plot_forked-1",
    "plots/plot_saved-1",
    "plots/plot_shown-1",
    "plots/plot_shown-2",
]


class Folder:
    def __init__(self, path: Path, command_line: Run) -> None:
        self.path, self._command_line = path, command_line
        (path / "plots").mkdir()
        for name, text in SCRIPTS.items():
            self.write(name, text)

    def write(self, name: str, text: str) -> None:
        (self.path / "plots" / name).write_text(text)

    def run(self, *arguments: str) -> tuple[int, str, str]:
        return self._command_line("figures", *arguments)

    def accepted(self) -> list[str]:
        folder = self.path / "figures"
        return sorted(path.relative_to(folder).with_suffix("").as_posix() for path in folder.rglob("*.json"))


@pytest.fixture
def folder(tmp_path: Path, command_line: Run, monkeypatch: pytest.MonkeyPatch) -> Folder:
    monkeypatch.chdir(tmp_path)
    return Folder(tmp_path, command_line)


def test_accept_compare_change(folder: Folder, monkeypatch: pytest.MonkeyPatch) -> None:
    status, out, _ = folder.run("diff", "plots")
    assert status == 1
    assert "plots/plot_saved-1: has no accepted state" in out
    assert folder.run("accept", "plots")[0] == 2
    status, out, err = folder.run("accept", "plots", "--reason", "first")
    assert (status, folder.accepted()) == (0, FIGURES), err
    status, out, _ = folder.run("diff", "plots/*.py")
    assert (status, out.splitlines()[0]) == (0, "nothing differs from the accepted state; figures compared: 5")

    folder.write("plot_saved.py", SCRIPTS["plot_saved.py"].replace("label", "color='orange', label"))
    folder.write("plot_shown.py", SCRIPTS["plot_shown.py"].replace("plt.plot([2, 1])", ""))
    summary = folder.path / "summary.md"
    with monkeypatch.context() as patch:
        patch.setenv("GITHUB_STEP_SUMMARY", str(summary))
        status, out, _ = folder.run("diff", "plots", "--comment", "comment.md")
    assert status == 1
    assert "plots/plot_saved-1: colour of curve 'ZN' changed from blue to orange" in out
    assert "plots/plot_shown-2: was accepted, but is not drawn any more" in out
    assert "2 of 5 figures differ" in summary.read_text()
    comment = (folder.path / "comment.md").read_text()
    assert comment.startswith("<!-- replicate-figures -->\n## 🔴 Figures\n")
    page = (folder.path / "build/figures-diff/index.html").read_text()
    assert "replicate figures accept plots/plot_saved.py --only plots/plot_saved-1=" in page
    assert "http" not in page.replace("http-equiv", "")

    log = folder.path / "figures/plots/plot_saved-1.log"
    digest = json.loads(log.read_text())["accepted"]
    stale = folder.run("accept", "plots/plot_saved.py", "--only", "plots/plot_saved-1=0", "--reason", "x")
    assert (stale[0], len(log.read_text().splitlines())) == (2, 1)
    assert folder.run("accept", "plots", "--only", f"plots/plot_saved-1={digest}", "--reason", "orange")[0] == 0
    assert json.loads(log.read_text().splitlines()[-1])["replaces"] == digest
    assert folder.run("accept", "plots", "--reason", "one is enough")[0] == 0
    assert folder.accepted() == FIGURES[:-1]
    status, out, _ = folder.run("diff", "plots", "--comment", "comment.md")
    assert status == 0
    assert (folder.path / "comment.md").read_text().startswith("<!-- replicate-figures -->\n## 🟢 Figures\n")


CANVAS = """
import matplotlib.animation
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_ps import FigureCanvasPS
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
fig = Figure()
curve, = fig.subplots().plot([2, 1, 0])
FigureCanvasAgg(fig).print_png("canvas.png")
FigureCanvasSVG(fig).print_svg("canvas.svg")
curve.set_color("red")
FigureCanvasPS(fig).print_eps("canvas.eps")
canvas = FigureCanvasAgg(fig)
curve.set_color("green")
canvas.draw()
pixels = bytes(canvas.buffer_rgba())
assert (bytes(canvas.buffer_rgba()), len(canvas.tostring_argb())) == (pixels, len(pixels))
film = matplotlib.animation.FuncAnimation(fig, lambda frame: curve.set_ydata([frame, 2, 0]), frames=3)
film.save("film.gif", writer="pillow", dpi=20)
other = Figure()
other.add_artist(matplotlib.lines.Line2D([0, 1], [0, 1]))
matplotlib.animation.FuncAnimation(other, lambda frame: None, frames=2).save("other.gif", writer="pillow", dpi=20)
"""


PIXELS = """
import numpy
import matplotlib.pyplot as plt
from matplotlib.patches import Rectangle
fig, ax = plt.subplots()
patch = ax.add_patch(Rectangle((0, 0), 1, 1))
patch.set_agg_filter(lambda pixels, dpi: (pixels, 0, 0))  # matplotlib itself reads pixels while it draws this
fig.canvas.draw()
before = numpy.array(fig.canvas.renderer.buffer_rgba())
patch.set_color("red")
fig.canvas.draw()
assert (numpy.asarray(fig.canvas.get_renderer().buffer_rgba()) != before).any()
plt.close(fig)
"""
EXIT = """
import atexit
import matplotlib.pyplot as plt
fig, ax = plt.subplots()
line, = ax.plot([0, 1])
plt.close(fig)
atexit.register(fig.savefig, "last.png")
@atexit.register
def thick():
    line.set_linewidth(7)
    fig.savefig("thick.png")
@atexit.register
def never():
    raise ValueError
atexit.unregister(never)
"""


def test_what_a_renderer_hands_out_and_what_is_saved_at_exit_is_captured(folder: Folder) -> None:
    folder.write("plot_pixels.py", PIXELS)
    folder.write("plot_exit.py", EXIT)
    status, _, err = folder.run("accept", "plots/plot_pixels.py", "plots/plot_exit.py", "--reason", "first")
    assert (status, folder.accepted()) == (0, ["plots/plot_exit-1", "plots/plot_pixels-1", "plots/plot_pixels-2"]), err
    assert (folder.path / "plots/last.png").is_file()
    assert '"width": 7.0' in (folder.path / "figures/plots/plot_exit-1.json").read_text()


def test_what_a_canvas_writes_or_hands_out_is_captured_once_and_the_frames_of_films_are_not(folder: Folder) -> None:
    folder.write("plot_canvas.py", CANVAS)
    status, _, err = folder.run("accept", "plots/plot_canvas.py", "--reason", "first")
    assert (status, folder.accepted()) == (0, [f"plots/plot_canvas-{number}" for number in (1, 2, 3, 4)]), err


def test_a_figure_whose_script_is_gone_is_noticed_and_its_absence_can_be_accepted(folder: Folder) -> None:
    for name in ("plot_shown.py", "plot_forked.py"):
        (folder.path / "plots" / name).unlink()
    assert folder.run("accept", "plots", "--reason", "first")[0] == 0
    (folder.path / "plots/plot_ended.py").unlink()
    status, out, _ = folder.run("diff", "plots")
    assert (status, out.splitlines()[0]) == (1, "plots/plot_ended-1: was accepted, but its script is no longer there")
    page = (folder.path / "build/figures-diff/index.html").read_text()
    assert "replicate figures accept plots --only plots/plot_ended-1=" in page
    assert folder.run("diff", "plots/plot_saved.py")[0] == 0
    assert folder.run("accept", "plots", "--only", "plots/plot_ended-1", "--reason", "nobody needs it")[0] == 0
    assert folder.run("diff", "plots")[0] == 0


FAILING = [
    ("x = 1\nraise ValueError('no\\nway')\n", ":2: ValueError: no way"),
    ("x = (\n", ":1: SyntaxError:"),
    ("import sys\nsys.exit(3)\n", ":2: ended with sys.exit(3)"),
    ("import atexit\nimport matplotlib.pyplot as plt\nplt.plot([1])\natexit.register(lambda: 1 / 0)\n", ":4: Zero"),
    ("import os\nos._exit(7)\n", ": ended before its end, with status 7"),
    ("import os\nos.abort()\n", ": ended before its end, with status -6"),
    ("import matplotlib.pyplot as plt\nplt.plot([1])\nplt.close()\n", ": draws nothing"),
    (
        "import matplotlib.pyplot as plt\nplt.plot([1])\nplt.gca().draw = lambda *_: 1 / [].index('a\\nb')\n",
        ": a figure cannot be drawn: ValueError: 'a",
    ),
    (
        "import matplotlib.pyplot as plt\nplt.plot([1])\n(place,) = plt.ginput(1)\n",
        ":3: ValueError: not enough values to unpack",
    ),
]
SLEEPING = ("import time\ntime.sleep(99)\n", ": is stopped, it took longer than 2 seconds")


@pytest.mark.parametrize(("scripts", "options"), [(FAILING, ()), ([SLEEPING], ("--timeout", "2"))])
def test_scripts_that_fail_are_named_and_take_nothing_else_down(
    folder: Folder, monkeypatch: pytest.MonkeyPatch, scripts: list[tuple[str, str]], options: tuple[str, ...]
) -> None:
    def patient(script: Path, base: str, timeout: float) -> baselines.ScriptRun:
        return run(script, base, timeout if "bad" in script.name else 300.0)  # how long others take is not the point

    run = baselines._run
    monkeypatch.setattr(baselines, "_run", patient)
    for name in ("plot_shown.py", "plot_ended.py", "plot_forked.py"):
        (folder.path / "plots" / name).unlink()
    assert folder.run("accept", "plots", "--reason", "first")[0] == 0
    for number, (text, _) in enumerate(scripts):
        folder.write(f"plot_bad{number}.py", text)
    status, out, err = folder.run("diff", "plots", *options)
    assert status == 2
    for number, (_, said) in enumerate(scripts):
        assert [line for line in err.splitlines() if line.startswith(f"plots/plot_bad{number}.py{said}")], err
    assert f"failed: {len(scripts)}" in out
    assert "plot_saved-1" not in out
    status, _, err = folder.run("accept", "plots", "--reason", "second", *options)
    assert status == 2
    assert err.splitlines()[-1].startswith("replicate: nothing is accepted, because a script failed")


def test_bad_names_and_folders(folder: Folder) -> None:
    assert folder.run("diff", "nowhere/*.py")[0] == 2
    other = folder.path / "other"
    other.mkdir()
    (other / "plots").symlink_to(folder.path / "plots", target_is_directory=True)
    for name in ("plot_a.b.py", "plot_a-b.py", "plot_a b.py"):
        folder.write(name, SCRIPTS["plot_saved.py"])
    status, out, _ = folder.run(
        "diff", "plots/plot_a*.py", "other/plots/plot_a*.py", str(folder.path / "plots/plot_a b.py")
    )
    names = sorted(line.partition(":")[0] for line in out.splitlines() if "has no accepted state" in line)
    assert (status, len(names), "plots/plot_a-b-1" in names) == (1, 3, True)
    twin = folder.path.parent / "plots"
    twin.mkdir()
    (twin / "plot_a-b.py").write_text(SCRIPTS["plot_saved.py"])
    status, _, err = folder.run("diff", "plots/plot_a-b.py", "../plots/plot_a-b.py")
    assert status == 2
    assert err.startswith("replicate: two figures of one name:")
    (folder.path / "blocked").write_text("a file")
    status, _, err = folder.run("accept", "plots", "--reason", "first", "--accepted", "blocked")
    assert status == 2
    assert "blocked" in err.splitlines()[-1]
    assert "Traceback" not in err

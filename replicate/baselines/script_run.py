"""Run one plotting script off-screen and keep every figure that it saves or leaves open.

Started as a process of its own: ``python -m replicate.baselines.script_run SCRIPT FOLDER``. In FOLDER it leaves
``1.json`` and ``1.png``, ... and, at the very end, ``status.json``.
"""

from __future__ import annotations

import atexit
import json
import os
import runpy
import sys
import textwrap
import traceback
from collections.abc import Callable
from functools import partial, partialmethod, wraps
from pathlib import Path
from typing import Any

from replicate.baselines.outcomes import draw
from replicate.errors import FigureError

#: Methods of canvases that hand the pixels to the script, which may write them as it likes.
_PIXELS = ("buffer_rgba", "tostring_argb", "tostring_rgb")

#: What a renderer knows the figure by that is drawn with it.
_DRAWN = "_figure_of_the_script"

_LONGEST = 300


class Keeper:
    """Keeps the states of figures in the order in which they were saved or left open."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.process = os.getpid()
        self.count = 0
        self.problems: list[str] = []
        self._last: dict[int, tuple[Any, str]] = {}
        self._busy = False
        self._saving: set[int] = set()
        self._films: list[Any] = []

    def keep(self, figure: Any) -> None:
        """Keep the present state of a figure, unless it is the one that was kept last."""
        if os.getpid() != self.process or self._busy:
            return
        self._busy = True  # drawing the picture saves the figure, too
        try:
            drawn = draw(figure)
        except FigureError:
            return  # nothing is on it
        except Exception as error:  # noqa: BLE001  -- whatever an artist raises while it is drawn
            problem = f"a figure cannot be drawn: {_one_line(error)}"
            self.problems += [problem] if problem not in self.problems else []
            return
        finally:
            self._busy = False
        kept = self._last.get(id(figure))
        if kept is not None and kept[1] == drawn.record:
            return
        # The figure is kept alive, so that no other one gets its identity.
        self._last[id(figure)] = (figure, drawn.record)
        self.count += 1
        (self.folder / f"{self.count}.json").write_text(drawn.record, encoding="utf-8", newline="\n")
        (self.folder / f"{self.count}.png").write_bytes(drawn.picture)

    def saving(self, original: Callable[..., Any]) -> Callable[..., Any]:
        """Return a method of figures or canvases that saves, and keeps the figure when it has; saving calls saving."""

        @wraps(original)
        def save(owner: Any, *arguments: Any, **options: Any) -> Any:
            figure = getattr(owner, "figure", owner)
            # A film saves each of its frames.
            film = _caller().startswith("matplotlib.animation")
            if id(figure) in self._saving:
                return original(owner, *arguments, **options)
            self._saving.add(id(figure))
            try:
                result = original(owner, *arguments, **options)
            finally:
                self._saving.discard(id(figure))
            self._films.append(figure) if film else self.keep(figure)
            return result

        return save

    def watch(self, canvas: type) -> None:
        """Keep what the methods ``print_png``, ``print_figure``, ``buffer_rgba``, ... of a class of canvases yield."""
        for name, method in list(vars(canvas).items()):
            if not name.startswith(("print_", *_PIXELS)):
                continue
            if isinstance(method, partialmethod):
                again = partialmethod(self.saving(method.func), *method.args, **method.keywords)
                setattr(canvas, name, again)
            elif callable(method):
                setattr(canvas, name, self.saving(method))

    def reading(self, original: Callable[..., Any]) -> Callable[..., Any]:
        """Return a method of renderers that hands over pixels, and keeps the figure if the script asks for them."""

        @wraps(original)
        def read(renderer: Any) -> Any:
            result = original(renderer)
            figure = getattr(renderer, _DRAWN, None)
            if figure is not None and not _caller().startswith("matplotlib"):  # which asks while it draws
                self.keep(figure)
            return result

        return read

    def keep_open(self) -> None:
        """Keep every figure that pyplot has open, and those of films of which nothing else was kept."""
        plt: Any = sys.modules.get("matplotlib.pyplot")
        for number in plt.get_fignums() if plt else ():
            self.keep(plt.figure(number))
        for figure in self._films:
            if id(figure) not in self._last:
                self.keep(figure)


def _caller() -> str:
    """Return the name of the module that called the function that asks."""
    return str(sys._getframe(2).f_globals.get("__name__", ""))  # noqa: SLF001


def _watch(keeper: Keeper) -> None:
    """Stand between the script and the screen."""
    import matplotlib as mpl
    import matplotlib.pyplot as plt
    from matplotlib.backend_bases import FigureCanvasBase
    from matplotlib.backends.backend_agg import FigureCanvasAgg, RendererAgg
    from matplotlib.figure import Figure

    plt.switch_backend("agg")
    mpl.use = lambda *_, **__: None
    plt.switch_backend = lambda *_, **__: None

    def begin(canvas: Any, **options: Any) -> None:  # those of other formats are imported when they are needed
        super(FigureCanvasBase, canvas).__init_subclass__(**options)
        keeper.watch(canvas)

    def show(*_: Any, block: bool | None = None, **__: Any) -> None:
        keeper.keep_open()
        if block is not False:  # who looks at a window closes it
            plt.close("all")

    Figure.savefig = keeper.saving(Figure.savefig)  # type: ignore[method-assign]
    for canvas in (FigureCanvasBase, *_below(FigureCanvasBase)):
        keeper.watch(canvas)
    FigureCanvasBase.__init_subclass__ = classmethod(begin)  # type: ignore[arg-type, assignment]
    renderer_of: Any = FigureCanvasAgg.get_renderer

    def get_renderer(canvas: Any) -> Any:
        renderer = renderer_of(canvas)
        setattr(renderer, _DRAWN, canvas.figure)
        return renderer

    FigureCanvasAgg.get_renderer = get_renderer  # type: ignore[method-assign]
    for name in _PIXELS:
        if hasattr(RendererAgg, name):
            setattr(RendererAgg, name, keeper.reading(getattr(RendererAgg, name)))
    # Nobody clicks, and what is shown during a pause is a frame of a film.
    FigureCanvasBase.start_event_loop = lambda *_, **__: None  # type: ignore[method-assign]
    plt.pause = lambda *_, **__: None
    plt.show = show
    Figure.show = lambda figure, *_, **__: keeper.keep(figure)  # type: ignore[method-assign]


def _below(kind: type) -> list[type]:
    direct: list[type] = kind.__subclasses__()
    return [found for below in direct for found in (below, *_below(below))]


def _late() -> list[partial[Any]]:
    """Return the list of what the script will have registered for its exit; this process ends before it would run."""
    found: list[partial[Any]] = []
    register, unregister = atexit.register, atexit.unregister

    def keep(function: Any, *arguments: Any, **options: Any) -> Any:
        if _caller() != "__main__":
            return register(function, *arguments, **options)
        found.append(partial(function, *arguments, **options))
        return function

    def drop(function: Any) -> None:
        found[:] = [one for one in found if one.func != function]
        unregister(function)

    atexit.register, atexit.unregister = keep, drop  # type: ignore[assignment]
    return found


def run(script: Path, keeper: Keeper) -> str:
    """Run a script as Python would, to its exit; return what went wrong, in one line, or nothing."""
    late = _late()
    problem = _problem(lambda: runpy.run_path(str(script), run_name="__main__"), script)
    if os.getpid() != keeper.process:
        return problem
    if not problem:
        keeper.keep_open()
    while late:
        said = _problem(late.pop(), script)
        problem = problem or said
    return problem


def _problem(function: Callable[[], object], script: Path) -> str:
    """Call a function of the script; return what went wrong, in one line, or nothing."""
    try:
        function()
    except SystemExit as end:
        if end.code not in {None, 0}:
            return f"{script.name}:{_line(end, script)}: ended with sys.exit({end.code!r})"
    except KeyboardInterrupt:
        raise
    except SyntaxError as error:
        return f"{script.name}:{error.lineno or 1}: {type(error).__name__}: {error.msg}"
    except BaseException as error:  # noqa: BLE001  -- whatever the script raises is its own
        return f"{script.name}:{_line(error, script)}: {_one_line(error)}"
    return ""


def _one_line(error: BaseException) -> str:
    """Return kind and words of an error, the first of very many."""
    return textwrap.shorten(f"{type(error).__name__}: {error}", _LONGEST, placeholder=" …")


def _line(error: BaseException, script: Path) -> int:
    """Return the line of the script in which something happened."""
    frames = traceback.extract_tb(error.__traceback__)
    return next((frame.lineno or 1 for frame in reversed(frames) if Path(frame.filename).name == script.name), 1)


def main() -> None:
    """Run the script that the command line names."""
    script, folder = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    keeper = Keeper(folder)
    _watch(keeper)
    os.chdir(script.parent)
    sys.argv = [str(script)]
    sys.path[0] = str(script.parent)
    problem = run(script, keeper)
    if os.getpid() != keeper.process:  # the script has forked, and this is the copy
        os._exit(0)
    if not problem:
        keeper.keep_open()
    problem = problem or "; ".join(f"{script.name}: {what}" for what in keeper.problems)
    status = json.dumps({"figures": keeper.count, "problem": problem})
    (folder / "status.json").write_text(status, encoding="utf-8")
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)  # whatever threads the script has left behind


if __name__ == "__main__":
    main()

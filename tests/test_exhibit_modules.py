"""An exhibit depends on the modules that it may use, and on no other: a wrong result is worse than one made again."""

from __future__ import annotations

import importlib
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from replicate.run.exhibit_modules import PaperModules
from replicate.run.library import Library

Written = Callable[..., set[str]]

PAPER = """
from replicate.exhibits import Paper

paper = Paper(
    "plots", __name__, title="T", authors=("A",), citation="C", year=2000, modules=("one", "two"), numbered=()
)
"""
FIGURE = """
from plots import paper


@paper.figure("fig-{name}", "Title")
def _draw(figure):
    figure.add_subplot()
"""
SHARED = """
import numpy as np

NUMBERS = []


def register(number):
    NUMBERS.append(number)


def called(number):
    helper(number)


def helper(number):
    register(number)


def figures(paper, ids):
    for id in ids:

        @paper.figure(id, "Title")
        def _draw(figure):
            figure.add_subplot().plot(NUMBERS)
"""


@pytest.fixture
def written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Written]:
    """Write a paper of two modules, a figure in each, and return which modules a figure does not use."""

    def write(one: str = "", two: str = "", exhibit: str = "fig-two") -> set[str]:
        folder = tmp_path / "plots"
        folder.mkdir()
        (tmp_path / "beside.py").write_text("import plots.one as one\n")
        files = {
            "__init__": PAPER,
            "shared": SHARED,
            "one": FIGURE.format(name="one") + one,
            "two": FIGURE.format(name="two") + two,
        }
        for name, text in files.items():
            (folder / f"{name}.py").write_text(text)
        monkeypatch.syspath_prepend(str(tmp_path))
        paper = importlib.import_module("plots").paper.load()
        names = [name for name in sys.modules if name.partition(".")[0] in {"plots", "beside"}]
        return PaperModules("plots", names).unused(paper.exhibits[exhibit])

    yield write
    for name in [name for name in sys.modules if name.partition(".")[0] in {"plots", "beside"}]:
        del sys.modules[name]


def test_a_figure_uses_its_own_module(written: Written) -> None:
    assert written() == {"plots.one"}


@pytest.mark.parametrize(
    "one",
    [
        "from plots import shared\nCOUNT = len(shared.NUMBERS)",
        "from functools import cache\n@cache\ndef f():\n    from plots import shared\n    shared.NUMBERS.append(1)",
        "from plots.shared import figures\nfigures(paper, ['fig-3', 'fig-4'])",
        "NUMBERS = []\nNUMBERS.append(1)\nNUMBERS[0] = 2\nclass C:\n    x = 1\nC.x = 2",
        "import numpy as np\n@np.vectorize\ndef f(x):\n    return x",
        "def helper(x):\n    NUMBERS.append(x)\nNUMBERS = []\nhelper(1)",
        "TABLE = paper.table('table-1', 'T', printed=False)\n@TABLE.reading('as-written', 'R')\ndef f():\n    return 1",
    ],
)
def test_what_another_module_keeps_to_itself_does_not_count(written: Written, one: str) -> None:
    assert "plots.one" in written(one)


@pytest.mark.parametrize(
    "one",
    [
        "from plots import shared\nshared.NUMBERS.append(1)",
        "from plots import shared\nshared.NUMBERS[:] = [1]",
        "from plots import shared\nshared.LIMIT = 2",
        "from plots.shared import NUMBERS\nNUMBERS += [1]",
        "from plots.shared import NUMBERS\nfor number in range(3):\n    NUMBERS.append(number)",
        "from plots.shared import register\nregister(1)",
        "from plots.shared import called\nif True:\n    RESULT = called(1)",
        "from plots.shared import register\n@register\ndef f():\n    pass",
        "from plots import shared\n@shared.NUMBERS.append\ndef f():\n    pass",
        "def mine():\n    from plots.shared import register\n    register(1)\nmine()",
        "import matplotlib as mpl\nmpl.rcParams['lines.linewidth'] = 3",
        "from numpy.random import seed\nseed(1)",
        "import os\nos.environ.update(HERE='1')",
        "import warnings\nwith warnings.catch_warnings():\n    pass",
        "from plots.shared import *\nregister(1)",
    ],
)
def test_a_module_that_changes_something_else_counts_everywhere(written: Written, one: str) -> None:
    assert "plots.one" not in written(one)


@pytest.mark.parametrize(
    "two",
    [
        "from plots import one",
        "from plots.one import _draw",
        "from . import one",
        "def f():\n    from plots import one",
        "import beside",
        "import plots\ndef f():\n    return plots.one",
        "import importlib\ndef f():\n    return importlib.import_module('plots.' + 'one')",
        "import sys\ndef f():\n    return sys.modules['plots.one']",
        "def f():\n    return paper.exhibits['fig-one']",
        "def f():\n    return eval('1')",
    ],
)
def test_a_module_that_may_be_reached_counts(written: Written, two: str) -> None:
    assert "plots.one" not in written(two=two)


def test_readings_and_claims_count_with_their_modules(written: Written) -> None:
    one = "from plots.two import TABLE\n@TABLE.reading('other', 'R')\ndef f():\n    return 1"
    two = (
        "TABLE = paper.table('table-1', 'T', printed=False)\n@TABLE.reading('as-written', 'R')\ndef f():\n    return 1"
    )
    assert written(one, two, exhibit="table-1") == set()


@pytest.mark.parametrize("id", ["khan", "krajewski", "bayhan", "ali", "panagopoulos"])
def test_what_python_imports_for_an_exhibit_is_used(id: str) -> None:
    """Python's own import system is asked, in a process that imports the module of one exhibit after the other."""
    paper = Library(bundled=True).paper(id)
    package = paper.package
    homes = sorted({exhibit.module for exhibit in paper.exhibits.values()})
    code = (
        "import importlib, sys\n"
        f"for home in {homes!r}:\n"
        f"    for name in [name for name in sys.modules if name.startswith({package!r})]:\n"
        "        del sys.modules[name]\n"
        "    importlib.import_module(home)\n"
        f"    print(home, *(name for name in sys.modules if name.startswith({package!r})))\n"
    )
    lines = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.splitlines()
    needed = {home: set(names) for home, *names in map(str.split, lines)}
    own = {name for name in sys.modules if name == package or name.startswith(f"{package}.")}
    modules = PaperModules(package, own)
    some_unused = False
    for exhibit in paper.exhibits.values():
        unused = modules.unused(exhibit)
        some_unused |= bool(unused)
        assert not unused & needed[exhibit.module], exhibit.id
    assert some_unused

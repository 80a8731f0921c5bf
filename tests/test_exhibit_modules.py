"""An exhibit depends on the modules that it may use, and on no other: a wrong result is worse than one made again."""

from __future__ import annotations

import importlib
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from textwrap import indent

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
"""


USES = "from plots import shared\nfrom plots.shared import NUMBERS, called, register\n"


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
        "import numpy as np\n@np.vectorize\ndef f(x):\n    return x",
        "def helper(x):\n    total = [x * y for y in range(3)]\n    return tuple(total)\nHERE = helper(2)",
        "from dataclasses import dataclass\n@dataclass\nclass A:\n    x: int\nHERE = A(1)",
        "import numpy as np\nHERE = np.exp(np.linspace(0.0, 1.0, 5))",
        "from replicate.loops import Plant\nHERE = {n: Plant.foptd(1.0, n, 1.0) for n in (1.0, 2.0)}",
        "for id in ('fig-3', 'fig-4'):\n    paper.figure(id, 'Title')(lambda figure: figure.add_subplot())",
        "TABLE = paper.table('table-1', 'T', printed=False)\n@TABLE.reading('as-written', 'R')\ndef f():\n    return 1",
    ],
)
def test_what_another_module_keeps_to_itself_does_not_count(written: Written, one: str) -> None:
    assert "plots.one" in written(USES + one)


@pytest.mark.parametrize(
    "one",
    [
        "shared.NUMBERS.append(1)",
        "shared.NUMBERS[:] = [1]",
        "shared.LIMIT = 2",
        "shared.LIMIT: int = 2",
        "(shared.LIMIT, b) = 1, 2",
        "for shared.LIMIT in [1]:\n    pass",
        "with open(__file__) as shared.FILE:\n    pass",
        "setattr(shared, 'LIMIT', 1)",
        "vars(shared).update(LIMIT=1)",
        "mine = shared\nmine.LIMIT = 3",
        "import plots.shared\nplots.shared.LIMIT = 1",
        "from plots import paper\npaper.extra = 1",
        "NUMBERS += [1]",
        "mine = NUMBERS\nmine += [1]",
        "mine = NUMBERS\nmine.append(1)",
        "add = NUMBERS.append\nadd(1)",
        "del NUMBERS[:]",
        "for number in range(3):\n    NUMBERS.append(number)",
        "[NUMBERS.append(x) for x in range(3)]",
        "OLD = NUMBERS.append(1)",
        "OLD = NUMBERS.pop() if NUMBERS else 1",
        "OLD = {1: (NUMBERS.append(1), f'{NUMBERS.clear()}')}",
        "OLD = NUMBERS.sort()",
        "OLD = NUMBERS.__iadd__([1])",
        "OLD = list.append(NUMBERS, 1)",
        "OLD = sorted([1], key=NUMBERS.append)",
        "OLD = list(map(NUMBERS.append, [1, 2]))",
        "OLD = NUMBERS[NUMBERS.append(1) or 0 :]",
        "OLD: int = NUMBERS.append(1)",
        "OLD = lambda a=NUMBERS.append(1): a",
        "OLD = (lambda: NUMBERS.append(1))()",
        "if NUMBERS.append(1) is None:\n    pass",
        "if old := NUMBERS.append(1):\n    pass",
        "while register(1):\n    pass",
        "assert NUMBERS.append(1) is None",
        "match 1:\n    case 1:\n        NUMBERS.append(1)",
        "try:\n    x = 1\nfinally:\n    NUMBERS.append(1)",
        "import contextlib\nwith contextlib.suppress(ValueError):\n    register(1)",
        "import bisect\nbisect.insort(NUMBERS, 4)",
        "from bisect import insort\nOLD = insort(NUMBERS, 4)",
        "import operator\nOLD = operator.iadd(NUMBERS, [1])",
        "import numpy as np\nX = np.ones(2)\nY = np.multiply(X, 2.0, out=X)",
        "import numpy as np\nX = np.vectorize(register)([1])",
        "import threading\nthreading.Thread(target=NUMBERS.append, args=(1,)).start()",
        "register(1)",
        "if True:\n    RESULT = called(1)",
        "RESULT = list(map(register, [1]))",
        "RESULT = sorted([1, 2], key=lambda n: register(n) or n)",
        "RESULT = [f([1]) for f in (register, len)]",
        "for f in (register, len):\n    f([1])",
        "class A:\n    len = register\n    x = len([1])",
        "f = lambda: register(1)\nf()",
        "from functools import partial\nf = partial(register)\nf(1)",
        "from functools import partial\nRESULT = partial(register)(1)",
        "from replicate.loops import Plant\nG = Plant.from_function(lambda s: register(1) or 1 / (s + 1))",
        "def mine():\n    from plots.shared import register\n    register(1)\nmine()",
        "def mine(numbers):\n    numbers.append(1)\nmine(NUMBERS)",
        "def mine():\n    NUMBERS.append(1)\n    yield 1\nRESULT = list(mine())",
        "def mine(a=NUMBERS.append(1)):\n    pass",
        "def mine(f):\n    NUMBERS.append(1)\n    return f\n@mine\ndef f():\n    pass",
        "@register\ndef f():\n    pass",
        "@shared.NUMBERS.append\ndef f():\n    pass",
        "from functools import partial\n@partial(register)\ndef f():\n    pass",
        "from functools import cache\n@cache(register)\ndef f():\n    pass",
        "class A:\n    NUMBERS.append(1)",
        "class A:\n    def __init__(self):\n        NUMBERS.append(1)\nHERE = A()",
        "class A:\n    @staticmethod\n    def make():\n        NUMBERS.append(1)\nHERE = A.make()",
        "class M(type):\n    def __init__(cls, *args):\n        NUMBERS.append(1)\nclass A(metaclass=M):\n    pass",
        "class B:\n    def __init_subclass__(cls):\n        NUMBERS.append(1)\nclass A(B):\n    pass",
        "class D:\n    def __set_name__(self, *args):\n        NUMBERS.append(1)\nclass A:\n    d = D()",
        (
            "from dataclasses import dataclass\n@dataclass\nclass A:\n"
            "    x: int = 0\n    def __post_init__(self):\n        register(1)\nHERE = A()"
        ),
        (
            "from dataclasses import dataclass, field\n@dataclass\nclass A:\n"
            "    x: list = field(default_factory=lambda: [register(1)])\nHERE = A()"
        ),
        "from plots.shared import *\nregister(1)",
    ],
)
def test_a_module_that_may_change_something_else_counts_everywhere(written: Written, one: str) -> None:
    assert "plots.one" not in written(USES + one)


@pytest.mark.parametrize(
    "one",
    [
        "mpl.rcParams['lines.linewidth'] = 3",
        "old = mpl.rcParams.update({'lines.linewidth': 3})",
        "mpl.style.use('ggplot')",
        "seed(1)",
        "x = np.random.random()",
        "x = np.seterr(all='ignore')",
        "np.set_printoptions(precision=3)",
        "x = random.random()",
        "os.environ['HERE'] = '1'",
        "os.environ.update(HERE='1')",
        "x = os.chdir('/')",
        "x = sys.setrecursionlimit(3000)",
        "x = warnings.filterwarnings('ignore')",
        "with warnings.catch_warnings():\n    pass",
        "decimal.getcontext().prec = 5",
        "x = decimal.setcontext(decimal.Context(prec=5))",
        "mpmath.mp.dps = 30",
        "builtins.print = len",
        "x = atexit.register(len)",
        "x = locale.setlocale(locale.LC_ALL, 'C')",
        "x = open('somewhere', 'w')",
    ],
)
def test_a_module_that_may_change_python_or_a_library_counts_everywhere(written: Written, one: str) -> None:
    """The statement stands where it is not carried out."""
    uses = (
        "import atexit, builtins, decimal, locale, os, random, sys, warnings\nimport matplotlib as mpl\nimport mpmath\n"
        "import numpy as np\nfrom numpy.random import seed\nif NUMBERS:\n"
    )
    assert "plots.one" not in written(USES + uses + indent(one, "    "))


def test_what_is_imported_for_that_is_quiet(written: Written) -> None:
    assert "plots.one" in written(USES + "import atexit, os, sys\nimport numpy as np\nif NUMBERS:\n    x = 1")


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
        "from sys import modules\ndef f():\n    return modules['plots.one']",
        "import sys\ndef f():\n    return getattr(sys, 'mod' + 'ules')['plots.one']",
        "import sys as system\ndef f():\n    return system.modules['plots.one']",
        "import pickle\ndef f():\n    return pickle.loads(b'cplots.one\\n_draw\\n.')",
        "import pydoc\ndef f():\n    return pydoc.locate('plots.one')",
        "from pathlib import Path\ndef f():\n    return Path(__file__).with_name('one.py').read_text()",
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

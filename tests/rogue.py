"""A paper whose units do what no unit should: leave, loop, break, write, change what surrounds them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import installed_paper

_INIT = """
from replicate.exhibits import Paper

paper = Paper(
    id="rogue", package=__name__, title="Rogue", authors=("N. N.",), citation="N. N., Rogue, 2001.", year=2001,
    modules=("exhibits",), numbered=(),
)
"""

_HEAD = """
import os, sys, time
import numpy as np
import pandas as pd
from rogue_paper import paper
from replicate.exhibits import Finding


def good(value=1.0):
    return pd.DataFrame({"x": [value]}, index=["a"])


table = paper.table("table-1", "Numbers", rows=("a",), columns=(), printed=False)


@table.reading("as-written", "As written")
def _as_written():
    return good()

"""

#: What a reading does, by its name; each is the body of a function.
READINGS: dict[str, str] = {
    "exit-0": "sys.exit(0)",
    "exit-3": "sys.exit(3)",
    "os-exit": "os._exit(0)",
    "base-exception": "class Odd(BaseException): pass\nraise Odd('odd')",
    "interrupt": "raise KeyboardInterrupt",
    "crash": "import ctypes\nctypes.string_at(0)",
    "abort": "os.abort()",
    "killed": "import signal\nos.kill(os.getpid(), signal.SIGKILL)",
    "recursion": "def f(): return f()\nreturn f()",
    "memory": "raise MemoryError",
    "lambda": "return pd.DataFrame({'x': [lambda: 1]}, index=['a'])",
    "huge-integer": "return good(10**400)",
    "complex": "return good(1j)",
    "text-of-error": "class Bad(Exception):\n    def __str__(self): raise ValueError('no text')\nraise Bad",
    "long-error": "raise ValueError('x' * 10**6)",
    "escape": "raise ValueError('a' + chr(27) + '[2Jb' + chr(0) + chr(0x202e))",
    "generator-exit": "raise GeneratorExit",
    "closes-everything": "os.closerange(3, 256)\nreturn good()",
    "stop-iteration": "raise StopIteration",
    "pipe": "for n in range(3, 64):\n    try: os.write(n, b'garbage')\n    except OSError: pass\ntime.sleep(60)",
}

#: Units that hurt nobody if they are held apart: they must succeed.
HARMLESS: dict[str, str] = {
    "prints": "print('hello from a unit')\nos.write(1, b'raw\\n')\nos.write(2, b'error\\n')\nreturn good()",
    "closes-stdout": "sys.stdout.close()\nos.close(1)\nreturn good()",
    "redirects": "import io\nsys.stdout = io.StringIO()\nprint('lost')\nreturn good()",
    "reads-stdin": "assert sys.stdin.read() == ''\nreturn good()",
    "changes-folder": "os.chdir('/')\nreturn good()",
    "forks": "os.fork()\nreturn good()",
    "thread": "import threading\nthreading.Thread(target=time.sleep, args=(9,), name='sleeper').start()\nreturn good()",
    "atexit": "import atexit\natexit.register(os._exit, 7)\nreturn good()",
    "environment": "os.environ['LANG'] = 'xx'\nos.environ.pop('PATH', None)\nreturn good()",
    "random": "np.random.seed(5)\nreturn good(np.random.rand())",
    "warns": "import warnings\nwarnings.warn('careful')\nreturn good()",
    "child": "import subprocess\nsubprocess.Popen(['sleep', '300'])\nreturn good()",
    "signals": "import signal\nsignal.signal(signal.SIGTERM, signal.SIG_IGN)\nreturn good()",
}

LOOP = "while True: pass"
#: Holds the lock of the interpreter: no thread of the process runs, and no handler of a signal.
HELD_LOOP = "import re\nre.match('(a+)+$', 'a' * 60 + 'b')\nreturn good()"


def reading(name: str, body: str) -> str:
    function = "_" + name.replace("-", "_")
    lines = "\n".join(f"    {line}" for line in body.splitlines())
    return f'@table.reading("{name}", "{name}")\ndef {function}():\n{lines}\n\n\n'


def source(readings: Mapping[str, str], more: str = "") -> str:
    return _HEAD + "".join(reading(name, body) for name, body in readings.items()) + more


@contextmanager
def installed(site: Path, readings: Mapping[str, str], more: str = "", init: str = _INIT) -> Iterator[Path]:
    """Write the paper as an installed distribution and make it importable; yield its folder."""
    files = {
        "rogue_paper/__init__.py": init,
        "rogue_paper/exhibits.py": source(readings, more),
        "rogue_paper/notes.md": "Nothing.\n",
        "rogue_paper-1.0.dist-info/METADATA": "Metadata-Version: 2.1\nName: rogue-paper\nVersion: 1.0\n",
        "rogue_paper-1.0.dist-info/entry_points.txt": "[replicate.papers]\nrogue = rogue_paper:paper\n",
    }
    with installed_paper.importable(site, "rogue_paper", files) as folder:
        yield folder

"""Units that change what surrounds them, workers that are killed at any moment: the others never notice."""

from __future__ import annotations

import os
import signal
import threading
from pathlib import Path

import pytest
import rogue
from attack import Attack

from replicate.exhibits.results import TableResult
from replicate.run.library import Library
from replicate.run.parallel import Progress, run

#: Looks at everything around it and returns it as numbers.
OBSERVER = """import decimal, hashlib, locale, math, random, resource, signal, threading, warnings
import matplotlib as mpl
seen = {
    "folder": os.getcwd(), "environment": sorted(os.environ.items()), "path": sys.path,
    "limit": sys.getrecursionlimit(), "random": random.random(), "numpy": np.random.rand(),
    "locale": locale.setlocale(locale.LC_ALL),
    "decimal": str(decimal.getcontext()), "filters": str(warnings.filters), "errors": str(np.geterr()),
    "print": str(np.get_printoptions()), "rc": sorted((key, str(value)) for key, value in mpl.rcParams.items()),
    "umask": os.umask(0o22), "signals": str([signal.getsignal(n) for n in sorted(signal.valid_signals())]),
    "stdout": sys.stdout.fileno(), "closed": sys.stdout.closed, "alarm": signal.alarm(0),
    "threads": sorted(thread.name for thread in threading.enumerate()),
    "limits": [resource.getrlimit(limit) for limit in range(8)],
    "blocked": signal.pthread_sigmask(signal.SIG_BLOCK, []),
    "new decimal": str(decimal.Context()), "digits": sys.get_int_max_str_digits(),
    "tracing": [sys.gettrace(), threading.gettrace()], "profiling": [sys.getprofile(), threading.getprofile()],
    "functions": [sum([1, 2]), math.sin(1), math.exp(1), np.sin(1.0), np.linalg.solve([[2.0]], [1.0]), pd.isna(1)],
}
time.sleep(0.1)
numbers = [int(hashlib.sha256(str(value).encode()).hexdigest()[:12], 16) for value in seen.values()]
return pd.DataFrame([numbers], index=["a"], columns=list(seen))"""

CHANGES = {
    "folder": "os.chdir('/')",
    "folder that is gone": "import tempfile\nos.chdir(tempfile.mkdtemp())\nos.rmdir(os.getcwd())",
    "environment": "os.environ.clear()",
    "time zone": "os.environ['TZ'] = 'Pacific/Apia'\ntime.tzset()",
    "path": "sys.path.insert(0, '/nowhere')",
    "path emptied": "sys.path.clear()",
    "recursion limit": "sys.setrecursionlimit(5000)",
    "random": "import random\nrandom.seed(5)",
    "numpy's random": "np.random.seed(5)",
    "numbers drawn": "np.random.rand(1000)",
    "locale": "import locale\nlocale.setlocale(locale.LC_ALL, 'C')",
    "decimal": "import decimal\ndecimal.getcontext().prec = 3\ndecimal.getcontext().traps[decimal.Inexact] = True",
    "warnings as errors": "import warnings\nwarnings.simplefilter('error')",
    "numpy raises": "np.seterr(all='raise')",
    "numpy prints": "np.set_printoptions(precision=2)",
    "rcParams": "import matplotlib as mpl\nmpl.rcParams['lines.linewidth'] = 9\nmpl.rcParams['svg.hashsalt'] = 'x'",
    "style": "import matplotlib.pyplot as plt\nplt.style.use('dark_background')\nplt.figure()",
    "umask": "os.umask(0o777)",
    "handlers": "import signal\nsignal.signal(signal.SIGTERM, signal.SIG_IGN)\nsignal.signal(signal.SIGUSR1, print)",
    "alarm": "import signal\nsignal.alarm(1)",
    "output": "sys.stdout.close()\nsys.stderr = None",
    "descriptors": "os.close(1)\nos.close(2)\nos.close(0)",
    "soft limits": "import resource\nresource.setrlimit(resource.RLIMIT_NOFILE, (64, 128))",
    "hard limits": "import resource\nresource.setrlimit(resource.RLIMIT_CPU, (600, 600))",
    "blocked signals": "import signal\nsignal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGTERM])",
    "timer": "import signal\nsignal.setitimer(signal.ITIMER_PROF, 0.05, 0.05)",
    "new contexts": "import decimal\ndecimal.DefaultContext.prec = 3\ndecimal.setcontext(decimal.Context())",
    "digits": "sys.set_int_max_str_digits(640)",
    "builtins": "import builtins\nbuiltins.sum = max",
    "mathematics": "import math\nmath.sin = math.cos\ndel math.exp",
    "numpy's functions": "np.sin, np.linalg.solve = np.cos, None",
    "pandas' functions": "pd.isna = len",
    "tracing": "import threading\ndef traced(*_): return traced\nsys.settrace(traced)\nthreading.settrace(traced)",
    "profiling": "import threading\nsys.setprofile(lambda *_: None)\nthreading.setprofile(print)",
    "threads": "import threading\nthreading.Thread(target=time.sleep, args=(5,)).start()",
}


Seen = dict[str, dict[str, float]]


def observed(folder: Path, readings: dict[str, str]) -> Seen:
    """Run readings one after the other in one worker, and return what the observers among them saw."""
    with rogue.installed(folder, readings):
        results = run([Library().paper("rogue")], jobs=1, cache_dir=None)
    table = results["rogue", "table-1"]
    assert isinstance(table, TableResult)
    assert not table.errors, table.errors
    seen = {id: frame.iloc[0] for id, frame in table.frames.items() if id.startswith("observer")}
    return {id: {str(key): float(value) for key, value in row.items()} for id, row in seen.items()}


def test_what_a_unit_sees_does_not_depend_on_what_ran_before(
    attack: Attack, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    costs = tmp_path / "replicate" / "costs.json"
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    alone = observed(tmp_path / "site", {"observer": OBSERVER})["observer"]

    def try_one(name: str) -> str:
        costs.unlink(missing_ok=True)  # none known: in the order of the table
        change = f"{CHANGES[name]}\nreturn good()"
        seen = observed(tmp_path / "site", {"change": change, "observer": OBSERVER, "observer-2": OBSERVER})
        differs = {key for values in seen.values() for key in alone if values[key] != alone[key]}
        return f"the next unit sees another {', '.join(sorted(differs))}" if differs else ""

    attack("what a unit leaves changed is unseen by the next", list(CHANGES), try_one, short=6)


def test_a_worker_killed_at_any_moment_loses_the_unit_it_was_at(attack: Attack, tmp_path: Path) -> None:
    readings = {f"r{i}": f"time.sleep(0.05)\nreturn good({i}.5)" for i in range(6)}

    def try_one(delay: float) -> str:
        steps: list[Progress] = []
        killer = threading.Timer(delay, _kill_a_worker)

        def progress(step: Progress) -> None:
            if not steps:
                killer.start()  # both workers are at work
            steps.append(step)

        with rogue.installed(tmp_path / str(delay), readings):
            result = run([Library().paper("rogue")], jobs=2, cache_dir=None, progress=progress)["rogue", "table-1"]
            killer.join()
        assert isinstance(result, TableResult)
        if {*result.frames, *result.errors} != {"as-written", *readings}:
            return "a unit is missing"
        wrong = [
            id for id, frame in result.frames.items() if id in readings and frame.iloc[0, 0] != float(id[1:]) + 0.5
        ]
        if wrong or len(steps) != len(readings) + 1:
            return f"wrong: {wrong}, reported {len(steps)}"
        odd = [why for why in result.errors.values() if "worker process was ended by SIGKILL" not in why]
        return f"said: {odd}" if odd or len(result.errors) > 1 else ""

    attack("a worker is killed at any moment", [i * 0.003 for i in range(60)], try_one, short=3)


def _kill_a_worker() -> None:
    """Kill the first worker; a browser of other tests is a child of this process' children, too."""
    children = Path(f"/proc/{os.getpid()}/task").glob("*/children")
    for child in " ".join(path.read_text() for path in children).split():
        try:
            if b"multiprocessing.forkserver" not in Path(f"/proc/{child}/cmdline").read_bytes():
                continue
            workers = Path(f"/proc/{child}/task/{child}/children").read_text().split()
        except OSError:
            continue
        for worker in workers[:1]:
            try:
                os.kill(int(worker), signal.SIGKILL)
            except ProcessLookupError:
                continue
            return

"""What surrounds a test: no test may find it as another has left it."""

from __future__ import annotations

import locale
import os
import signal
import sys

from replicate.run import paper_folders

#: What pytest, libraries and the command set once for the whole process.
_OF_THE_PROCESS = {"PYTEST_CURRENT_TEST", "KMP_DUPLICATE_LIB_OK", "KMP_INIT_AT_FORK", "MPLBACKEND", "SOURCE_DATE_EPOCH"}


def surroundings() -> dict[str, object]:
    """Return what a test can change for those after it; of libraries only where they are imported."""
    mask = os.umask(0o077)
    os.umask(mask)
    found: dict[str, object] = {
        "environment": {name: value for name, value in os.environ.items() if name not in _OF_THE_PROCESS},
        "folder": os.getcwd(),  # noqa: PTH109  -- the quicker one
        "umask": mask,
        "path": [place for place in sys.path if place not in paper_folders._added],  # forgotten when it is in the way
        "signals": {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGALRM)},
        "program": sys.modules["__main__"],
        "locale": locale.setlocale(locale.LC_ALL),
    }
    if numpy := sys.modules.get("numpy"):
        state = numpy.random.get_state()
        found["numpy"] = (state[1].tobytes(), state[2:], numpy.geterr())
    if matplotlib := sys.modules.get("matplotlib"):
        settings = dict.items(matplotlib.rcParams)  # not through its getter, which chooses a backend
        found["matplotlib"] = {name: value for name, value in settings if name != "backend"}
    return found


def changed(before: dict[str, object], after: dict[str, object]) -> list[str]:
    """Return what differs, each with the values before and after."""
    found = []
    for name, old in before.items():
        new = after[name]
        if isinstance(old, dict) and isinstance(new, dict):
            keys = [key for key in old | new if old.get(key) != new.get(key)]
            found += [f"{name}, {key}: {old.get(key)!r}, {new.get(key)!r}" for key in keys]
        elif old != new:
            found.append(name if name == "numpy" else f"{name}: {old!r}, {new!r}")
    return found

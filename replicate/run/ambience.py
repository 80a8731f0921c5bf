"""What surrounds a unit of work: random numbers, settings, folder, locale. The same for every unit.

A result must not depend on what ran before in the same process. So everything that code can change without returning
it is set before each unit, and looked at after it: a unit that leaves something changed is named.
"""

from __future__ import annotations

import contextlib
import decimal
import locale
import os
import random
import signal
import sys
import threading
import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

from replicate.run.replaced_functions import MODULES, functions_now, put_back

if sys.platform != "win32":
    import resource

SEED = 0

_OF_DECIMAL = ("prec", "rounding", "Emin", "Emax", "capitals", "clamp")
_TOOLS = range(6)  # of `sys.monitoring`
_TIMERS = ("ITIMER_REAL", "ITIMER_VIRTUAL", "ITIMER_PROF")


@dataclass(frozen=True)
class _Aspect:
    """One thing that code can change: how it is read, and how it is set to what was read."""

    name: str
    read: Callable[[], Any]
    set: Callable[[Any], object]
    module: str = ""  # only if this module has been imported


def _environment() -> dict[str, str]:
    return dict(os.environ)


def _set_environment(variables: dict[str, str]) -> None:
    if dict(os.environ) != variables:
        os.environ.clear()
        os.environ.update(variables)
        if hasattr(time, "tzset"):
            time.tzset()


def _umask() -> int:
    mask = os.umask(0o077)
    os.umask(mask)
    return mask


def _folder() -> str:
    try:
        return os.getcwd()  # noqa: PTH109  -- the plain text; the folder may be gone
    except FileNotFoundError:
        return "(removed)"


def _set_locale() -> None:
    """Take the locale of no country, in which files are UTF-8 where the system knows that."""
    locale.setlocale(locale.LC_ALL, "C")
    for name in ("C.UTF-8", "UTF-8"):
        with contextlib.suppress(locale.Error):
            locale.setlocale(locale.LC_CTYPE, name)
            return


def _set_warnings() -> None:
    warnings.resetwarnings()
    warnings.simplefilter("default")


def _handlers() -> dict[int, Any]:
    return {number: signal.getsignal(number) for number in signal.valid_signals()}


def _set_handlers(handlers: dict[int, Any]) -> None:
    for number, handler in handlers.items():
        if handler is not None and signal.getsignal(number) != handler:
            signal.signal(number, handler)


def _contexts() -> list[decimal.Context]:
    """Return the context of decimal, and the one that new ones take their values from."""
    return [decimal.getcontext(), decimal.DefaultContext]


def _decimal() -> list[tuple[Any, ...]]:
    return [(*(getattr(context, name) for name in _OF_DECIMAL), tuple(_traps(context))) for context in _contexts()]


def _traps(context: decimal.Context) -> list[str]:
    return sorted(trap.__name__ for trap, is_set in context.traps.items() if is_set)


def _set_decimal(wanted: list[tuple[Any, ...]]) -> None:
    for context, (*values, traps) in zip(_contexts(), wanted, strict=True):
        for name, value in zip(_OF_DECIMAL, values, strict=True):
            setattr(context, name, value)
        context.clear_flags()
        context.clear_traps()
        for name in traps:
            context.traps[getattr(decimal, name)] = True


def _limits() -> dict[int, tuple[int, int]]:
    """Return what the system lets this process use: memory, open files, processor time."""
    if sys.platform == "win32":
        return {}
    limits = [getattr(resource, name) for name in dir(resource) if name.startswith("RLIMIT_")]
    return {limit: resource.getrlimit(limit) for limit in limits}


def _set_limits(limits: dict[int, tuple[int, int]]) -> None:
    if sys.platform == "win32":
        return
    for limit, values in limits.items():
        with contextlib.suppress(OSError, ValueError):  # a hard limit that was lowered stays
            resource.setrlimit(limit, values)


def _traced() -> tuple[Any, ...]:
    return sys.gettrace(), threading.gettrace()


def _set_traced(functions: tuple[Any, ...]) -> None:
    here, in_threads = functions
    sys.settrace(here)
    threading.settrace(in_threads)


def _profiled() -> tuple[Any, ...]:
    tools: list[str | None] = []
    if sys.version_info >= (3, 12):
        tools = [sys.monitoring.get_tool(tool) for tool in _TOOLS]
    return sys.getprofile(), threading.getprofile(), tools


def _set_profiled(functions: tuple[Any, ...]) -> None:
    here, in_threads, tools = functions
    sys.setprofile(here)
    threading.setprofile(in_threads)
    if sys.version_info >= (3, 12):
        for tool, name in zip(_TOOLS, tools, strict=True):
            if name is None and sys.monitoring.get_tool(tool) is not None:
                sys.monitoring.set_events(tool, 0)
                sys.monitoring.free_tool_id(tool)


def _blocked() -> set[int]:
    return set(signal.pthread_sigmask(signal.SIG_BLOCK, ())) if hasattr(signal, "pthread_sigmask") else set()


def _timers() -> bool:
    """Stop the timers of this process; return whether one was running."""
    running = [signal.setitimer(getattr(signal, name), 0) for name in _TIMERS if hasattr(signal, name)]
    return any(any(timer) for timer in running)


def _numpy() -> Any:
    return sys.modules["numpy"]


def _random_state() -> tuple[Any, ...]:
    name, keys, *rest = _numpy().random.get_state()
    return (name, keys.tobytes(), *rest)


def _pandas_options() -> dict[str, Any]:
    """Return every option of pandas by its full name."""
    import pandas as pd

    found: dict[str, Any] = {}
    waiting = [("", pd.options)]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # some options are deprecated
        while waiting:
            prefix, group = waiting.pop()
            for name in dir(group):
                value = getattr(group, name)
                if isinstance(value, type(pd.options)):
                    waiting.append((f"{prefix}{name}.", value))
                else:
                    found[f"{prefix}{name}"] = value
    return found


def _set_pandas_options(options: dict[str, Any]) -> None:
    import pandas as pd

    now = _pandas_options()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for name, value in options.items():
            if now[name] != value:
                pd.set_option(name, value)


def _matplotlib() -> Any:
    return sys.modules["matplotlib"]


def _pyplot() -> Any:
    return sys.modules["matplotlib.pyplot"]


def _set_rc(settings: dict[str, Any]) -> None:
    dict.update(_matplotlib().rcParams, settings)  # not through its setter, which complains of deprecated settings


_ASPECTS = (
    _Aspect("functions that trace", _traced, _set_traced),  # first: they see whatever else is done here
    _Aspect("functions that profile", _profiled, _set_profiled),
    _Aspect("the current folder", _folder, os.chdir),
    _Aspect("environment variables", _environment, _set_environment),
    _Aspect("the mask of new files (umask)", _umask, os.umask),
    _Aspect("the search path of modules", lambda: list(sys.path), lambda path: sys.path.__setitem__(slice(None), path)),
    _Aspect("the recursion limit", sys.getrecursionlimit, sys.setrecursionlimit),
    _Aspect("handlers of signals", _handlers, _set_handlers),
    _Aspect("Python's random state", random.getstate, random.setstate),
    _Aspect("the locale", lambda: locale.setlocale(locale.LC_ALL), lambda name: locale.setlocale(locale.LC_ALL, name)),
    _Aspect("the context of decimal", _decimal, _set_decimal),
    _Aspect("the limits of the process", _limits, _set_limits),
    _Aspect("blocked signals", _blocked, lambda mask: signal.pthread_sigmask(signal.SIG_SETMASK, mask)),
    _Aspect("the most digits of integers", sys.get_int_max_str_digits, sys.set_int_max_str_digits),
    _Aspect(
        "the filters of warnings",
        lambda: [str(entry) for entry in warnings.filters],
        lambda _: _set_warnings(),
    ),
    _Aspect("numpy's random state", _random_state, lambda _: _numpy().random.seed(SEED), "numpy"),
    _Aspect("numpy's handling of errors", lambda: _numpy().geterr(), lambda how: _numpy().seterr(**how), "numpy"),
    _Aspect(
        "numpy's print options",
        lambda: _numpy().get_printoptions(),
        lambda options: _numpy().set_printoptions(**options),
        "numpy",
    ),
    _Aspect("pandas' options", _pandas_options, _set_pandas_options, "pandas"),
    _Aspect("matplotlib's rcParams", lambda: dict(_matplotlib().rcParams), _set_rc, "matplotlib"),
    _Aspect(
        "figures of pyplot",
        lambda: list(_pyplot().get_fignums()),
        lambda _: _pyplot().close("all"),
        "matplotlib.pyplot",
    ),
    *(
        _Aspect(f"functions of {module}", partial(functions_now, module), partial(put_back, module), module)
        for module in MODULES
    ),
)


class Ambience:
    """Sets what surrounds a unit, and says what a unit has left changed.

    Made once in a process, before any code of a paper runs there.

    Attributes
    ----------
    spoilt
        Whether something could not be set back.
    """

    def __init__(self) -> None:
        random.seed(SEED)
        _set_locale()
        decimal.setcontext(decimal.Context())
        _set_warnings()
        self.spoilt = False
        self._wanted: dict[str, Any] = {}
        self._threads = set(threading.enumerate())
        self._look()

    def _look(self) -> None:
        """Read the aspects of modules that were imported since; the first look is the one that counts."""
        for aspect in _ASPECTS:
            if aspect.name not in self._wanted and (not aspect.module or aspect.module in sys.modules):
                if aspect.module == "numpy":
                    _numpy().random.seed(SEED)
                elif aspect.module == "matplotlib":
                    _matplotlib().rcdefaults()
                elif aspect.module == "matplotlib.pyplot":
                    self._wanted[aspect.name] = []
                    continue
                self._wanted[aspect.name] = aspect.read()

    def set(self) -> list[str]:
        """Set everything as it was at first, and return the names of what had been changed."""
        changed = []
        self._look()
        for aspect in _ASPECTS:
            if aspect.name in self._wanted and aspect.read() != self._wanted[aspect.name]:
                changed.append(aspect.name)
                aspect.set(self._wanted[aspect.name])
                self.spoilt |= aspect.read() != self._wanted[aspect.name]
        if _timers():
            changed.append("an alarm that has not rung")
        return changed

    def threads(self) -> list[str]:
        """Return the names of threads that still run, which nothing can stop from outside."""
        return [thread.name for thread in threading.enumerate() if thread not in self._threads and thread.is_alive()]

"""Pictures of a class set, drawn in a process of its own while sheets are set in this one."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path
from types import TracebackType

from replicate.exhibits.variants import Variation
from replicate.handout.drawings import Wanted
from replicate.handout.own_code import LONGEST_RUN
from replicate.handout.own_exercises import own_exercises, with_own
from replicate.handout.placing import exercises_of
from replicate.run.guarded import GuardedProcess
from replicate.run.units import loaded


class Artist:
    """Draws what is ordered, in that order, until the ``with`` block ends.

    Parameters
    ----------
    package, folders
        Of the paper, and of exercises of a lecturer's own.
    """

    def __init__(self, package: str, folders: tuple[Path, ...]) -> None:
        self._from = package, folders
        self._process = GuardedProcess(LONGEST_RUN)
        self._thread = ThreadPoolExecutor(1)  # waits for the process

    def __enter__(self) -> Artist:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._thread.shutdown(wait=False, cancel_futures=True)
        self._process.__exit__(kind, error, trace)
        self._thread.shutdown()

    def order(self, wanted: Sequence[Wanted]) -> Callable[[Wanted], tuple[bytes, ...]]:
        """Have pictures drawn, and return at once what gives those of one figure when they are done.

        The function returned raises `ReplicateError` if a picture cannot be drawn.
        """
        under_way = self._thread.submit(self._drawn, list(dict.fromkeys(wanted)))
        return lambda one: under_way.result()[one]

    def _drawn(self, wanted: Sequence[Wanted]) -> dict[Wanted, tuple[bytes, ...]]:
        return dict(zip(wanted, self._process.stream(pictures, *self._from, wanted), strict=True))


def pictures(package: str, folders: tuple[Path, ...], wanted: Sequence[Wanted]) -> Iterator[tuple[bytes, ...]]:
    """Yield pictures of the exercises of a paper and of folders."""
    variations = _variations(package, folders)
    return (one.drawn(variations) for one in wanted)


@cache
def _variations(package: str, folders: tuple[Path, ...]) -> Mapping[str, Variation]:
    own = tuple(one for folder in folders for one in own_exercises(folder))
    return with_own(exercises_of(loaded(package)), own).variations

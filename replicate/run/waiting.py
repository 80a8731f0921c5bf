"""Which unit a worker does next: one of the folder of code whose units it has done before, where there is any.

Exhibits of one folder build on each other: a figure draws the designs of a table, claims judge them. What their modules
keep in memory (`functools.cache`) is there for as long as the process lives, so that one worker computes it once where
two would compute it twice.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Mapping, Sequence

from replicate.exhibits import Exhibit
from replicate.run.units import Unit
from replicate.run.worker import Task


class Waiting:
    """Tasks that wait, by the folder of the module that defines their exhibit.

    Parameters
    ----------
    units
        In the order in which they are best begun.
    """

    def __init__(self, units: Mapping[Unit, Exhibit]) -> None:
        self._folder = {unit: exhibit.module.rpartition(".")[0] for unit, exhibit in units.items()}
        self._tasks: dict[str, deque[Task]] = {folder: deque() for folder in self._folder.values()}
        for unit, folder in self._folder.items():
            self._tasks[folder].append(Task(unit))

    def __len__(self) -> int:
        """Return how many tasks wait."""
        return sum(map(len, self._tasks.values()))

    def folder(self, task: Task) -> str:
        """Return the folder to which a task belongs."""
        return self._folder[task.unit]

    def take(self, known: Sequence[str], taken: Collection[str]) -> Task:
        """Return a task that waits no longer; there must be one.

        Parameters
        ----------
        known
            Folders of which the worker has done units, the latest last.
        taken
            Folders at which other workers are: their units are taken when there are no others, from the folder in which
            most are left.
        """
        left = [folder for folder, tasks in self._tasks.items() if tasks]
        mine = [folder for folder in reversed(known) if folder in left]
        free = [folder for folder in left if folder not in taken]
        folder = next(iter([*mine, *free]), None) or max(left, key=lambda folder: len(self._tasks[folder]))
        return self._tasks[folder].popleft()

    def put_back(self, task: Task) -> None:
        """Have a task wait again, as the next of its folder."""
        self._tasks[self.folder(task)].appendleft(task)

"""One unit done in this process: its result, what it cost and depends on, and what it left changed."""

from __future__ import annotations

import gc
import json
import time
from collections.abc import Callable, Collection
from dataclasses import dataclass, field, replace

from replicate.exhibits import Paper
from replicate.exhibits.results import ClaimsResult, Result
from replicate.run.ambience import Ambience
from replicate.run.dependencies import Dependencies, Looked
from replicate.run.garbage import staying
from replicate.run.modules import modules_of, read_imports
from replicate.run.storage import from_text, to_text
from replicate.run.units import Unit, compute, failed, loaded, reason


@dataclass(frozen=True)
class Performance:
    """What a worker sends back.

    Attributes
    ----------
    seconds
        From the beginning of the unit to its end.
    dependencies
        What the result depends on; empty if nothing is known of it, so that the result cannot be kept.
    changed
        Names of what the unit left changed around it (random state, folder, settings); it has been set back.
    is_last
        Whether the process should do no more, because something in it cannot be set back.
    output
        What the unit wrote to standard output and error.
    text
        The result as the unit's process has written it; empty if it was lost there, or is another now.
    """

    result: Result
    dependencies: Dependencies
    seconds: float = 0.0
    changed: tuple[str, ...] = ()
    is_last: bool = False
    output: str = ""
    text: str = ""

    def to_bytes(self) -> bytes:
        """Return this as two lines of JSON; the output travels otherwise, since it must outlive the process."""
        head = {
            "dependencies": self.dependencies,
            "seconds": self.seconds,
            "changed": self.changed,
            "is_last": self.is_last,
        }
        return f"{json.dumps(head)}\n{self.text or to_text(self.result)}".encode()

    @classmethod
    def from_bytes(cls, content: bytes, output: str = "") -> Performance:
        """Return what `to_bytes` wrote."""
        head, text = content.split(b"\n", 1)
        given = json.loads(head)
        return cls(
            from_text(text),
            given["dependencies"],
            given["seconds"],
            tuple(given["changed"]),
            given["is_last"],
            output,
            text.decode(),
        )


@dataclass
class Performer:
    """Does units one after the other in this process, each in the same surroundings."""

    ambience: Ambience = field(default_factory=Ambience)
    _loaded: dict[str, Paper] = field(default_factory=dict)
    _looked: Looked = field(default_factory=Looked)
    _begun: float = field(default_factory=time.time)

    def perform(
        self, unit: Unit, without: Collection[str] = (), before: Callable[[str], object] = lambda _: None
    ) -> Performance:
        """Do one unit; nothing that it raises leaves here.

        Parameters
        ----------
        without, before
            As for `replicate.run.units.compute`.
        """
        begun = time.monotonic()
        changed = []
        if unit.package not in self._loaded:
            # Before anything is set: what a module changes when it is imported must not depend on which unit is first.
            gc.collect()  # what earlier units have left does not stay
            with staying():
                self._loaded[unit.package] = loaded(unit.package)
                read_imports(unit.package)
            changed += [f"{name} (when {unit.paper} is imported)" for name in self.ambience.set()]
        paper = self._loaded[unit.package]
        self.ambience.set()
        result, text = _written(unit, paper, compute(unit, without, before))
        changed += self.ambience.set()
        threads = self.ambience.threads()
        if threads:
            changed.append(f"a thread that still runs ({', '.join(threads)})")
        is_last = bool(threads) or self.ambience.spoilt
        dependencies = self._looked.record(paper, paper.exhibits[unit.exhibit], modules_of(unit.package, self._loaded))
        if self._looked.newest > self._begun:
            dependencies = {}  # a file was written after this process began, which may have loaded it as it was before
        seconds = time.monotonic() - begun
        return Performance(result, dependencies, seconds, tuple(changed), is_last, text=text)


def _written(unit: Unit, paper: Paper, result: Result) -> tuple[Result, str]:
    """Return a result with its text, or in its place the reason why it cannot be written."""
    try:
        return result, to_text(result)
    except (TypeError, ValueError) as error:
        result = failed(unit, paper.exhibits[unit.exhibit], reason(error))
        return result, to_text(result)


def with_errors(result: Result, errors: dict[str, str]) -> Result:
    """Return the claims of a result with those that could not be checked."""
    return replace(result, errors={**result.errors, **errors}) if isinstance(result, ClaimsResult) else result

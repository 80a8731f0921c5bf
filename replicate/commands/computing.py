"""What all commands that compute share: the options, given to the command as one argument."""

from __future__ import annotations

import functools
import inspect
import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar, get_type_hints

import typer

from replicate.commands.options import Backend, Bundled, Jobs, Out, PapersDir, Scheduler, library, output_folder
from replicate.run.limits import UNIT_TIMEOUT

if TYPE_CHECKING:
    from replicate.exhibits import Paper
    from replicate.run.kept_texts import KeptTexts
    from replicate.run.library import Library
    from replicate.run.outcome import Outcome, Selection
    from replicate.run.parallel import Executor
    from replicate.run.units import Unit

Returned = TypeVar("Returned")


@dataclass(frozen=True)
class Computing:
    """How a command computes, as its options say.

    Attributes
    ----------
    within
        The papers within reach.
    folder
        Where what the command makes goes; kept results lie in its folder ``cache``.
    jobs
        Number of processes; one per core if ``None``.
    no_cache
        Recompute everything and keep nothing.
    unit_timeout
        Seconds after which a reading, figure or claim is stopped.
    verbose
        Show why each result is recomputed.
    executor
        Does the units; processes on this machine if ``None``.
    """

    within: Library
    folder: Path
    jobs: int | None
    no_cache: bool
    unit_timeout: float
    verbose: bool
    executor: Executor | None = None

    def recompute(self, papers: list[Paper], selection: Selection | None = None) -> Outcome:
        """Compute and judge with progress on standard error."""
        from replicate.run.outcome import recompute
        from replicate.terminal.console import console
        from replicate.terminal.progress import progress_on

        with progress_on(console(stderr=True), verbose=self.verbose) as progress:
            return recompute(
                papers,
                selection,
                jobs=self.jobs,
                cache_dir=None if self.no_cache else self.folder / "cache",
                progress=progress,
                unit_timeout=self.unit_timeout,
                executor=self.executor,
            )

    def tell_kept(self, units: Sequence[Unit]) -> None:
        """Say on standard error that every result was kept, as `recompute` does."""
        from replicate.run.parallel import Progress
        from replicate.terminal.console import console
        from replicate.terminal.progress import progress_on

        with progress_on(console(stderr=True), verbose=self.verbose) as progress:
            for done, unit in enumerate(units, start=1):
                progress(Progress(done, len(units), unit, from_cache=True))

    def kept_texts(self, rooms: Sequence[str], distributions: Sequence[str]) -> KeptTexts:
        """Return what keeps texts that rooms of the framework compute, beside the results of the papers."""
        from replicate.run.kept_texts import KeptTexts
        from replicate.terminal.console import console

        def report(name: str, why: str) -> None:
            if self.verbose:
                lines = console(stderr=True)
                lines.print(f"computed {name}\n    because {why}", markup=False, highlight=False, soft_wrap=True)

        return KeptTexts(None if self.no_cache else self.folder / "cache", rooms, distributions, report)

    def distributions(self, packages: Iterable[str]) -> set[str]:
        """Return the distributions that packages of papers use."""
        from replicate.run.modules import distributions_used, imports_of, numerical_imports

        keep = self.kept_texts(("loops",), ())

        @functools.cache
        def core() -> dict[str, list[str]]:
            """Return what its modules import: it is large, and the same for all papers that use it."""
            found: dict[str, list[str]] = json.loads(
                keep("imports of the numerical core", lambda: json.dumps(numerical_imports()))
            )
            return found

        def imports(name: str) -> Sequence[str]:
            found = core().get(name) if name.startswith("replicate.loops") else None
            return imports_of(name) if found is None else found

        return distributions_used(packages, imports)


def _options(
    papers_dir: PapersDir = None,
    bundled: Bundled = False,
    jobs: Jobs = None,
    out: Out = None,
    no_cache: Annotated[bool, typer.Option("--no-cache", help="Recompute everything and keep nothing.")] = False,
    unit_timeout: Annotated[
        float,
        typer.Option("--unit-timeout", metavar="SECONDS", help="Stop a reading, figure or claim that takes longer."),
    ] = UNIT_TIMEOUT,
    verbose: Annotated[
        bool, typer.Option("--verbose", "-v", help="Show why each result is recomputed, and what its code writes.")
    ] = False,
    backend: Backend = "local",
    scheduler: Scheduler = None,
) -> Computing:
    executor = _executor(backend, scheduler, unit_timeout)
    within = library(papers_dir, bundled)
    return Computing(within, output_folder(within, out), jobs, no_cache, unit_timeout, verbose, executor)


def _executor(backend: str, scheduler: str | None, unit_timeout: float) -> Executor | None:
    from replicate.run.backends import cluster_of

    cluster = cluster_of(backend, scheduler)
    if cluster is None:
        return None
    from replicate.run.cluster import ClusterPool

    return ClusterPool(cluster, unit_timeout)


def computing(command: Callable[..., Returned]) -> Callable[..., Returned]:
    """Return a command with the options of all that compute, in place of its first argument."""
    first, *own = _with_types(command)
    return _with_options(command, first.name, _options, [*own, *_with_types(_options)])


def taking(options: type) -> Callable[[Callable[..., Returned]], Callable[..., Returned]]:
    """Return a decorator for a command that takes an object of options: each attribute becomes an option.

    Parameters
    ----------
    options
        A dataclass whose fields are annotated as typer's options are; one argument of the command is of it.
    """

    def decorated(command: Callable[..., Returned]) -> Callable[..., Returned]:
        own = _with_types(command)
        place, name = next((place, one.name) for place, one in enumerate(own) if one.annotation is options)
        return _with_options(command, name, options, [*own[:place], *_with_types(options), *own[place + 1 :]])

    return decorated


def _with_options(
    command: Callable[..., Returned], name: str, make: Callable[..., Any], parameters: list[inspect.Parameter]
) -> Callable[..., Returned]:
    """Return a command with the parameters given, one of whose arguments is made of some of them."""
    options = [one.name for one in _with_types(make)]

    @functools.wraps(command)
    def with_options(**values: Any) -> Returned:
        made = make(**{option: values.pop(option) for option in options})
        return command(**{name: made}, **values)

    parameters = [one.replace(kind=inspect.Parameter.KEYWORD_ONLY) for one in parameters]
    with_options.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    with_options.__annotations__ = {one.name: one.annotation for one in parameters}
    return with_options


def _with_types(function: Callable[..., Any]) -> list[inspect.Parameter]:
    """Return the parameters of a function, their annotations evaluated."""
    hints = get_type_hints(function, include_extras=True)
    return [
        one.replace(annotation=hints.get(one.name, one.annotation))
        for one in inspect.signature(function).parameters.values()
    ]

"""Compute many loops from a file, block by block."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from replicate.commands.options import Backend, Jobs, Out, Scheduler, library, output_folder
from replicate.terminal.streams import echo


def sweep(
    file: Annotated[Path, typer.Argument(metavar="FILE.toml", help="Plants, controllers and metrics.")],
    file_format: Annotated[str, typer.Option("--format", metavar="csv|parquet", help="Format of the blocks.")] = "csv",
    jobs: Jobs = None,
    out: Out = None,
    backend: Backend = "local",
    scheduler: Scheduler = None,
) -> None:
    """Compute the metrics of a grid of control loops.

    Blocks that an earlier run has written are kept, so that an interrupted sweep goes on where it was.
    """
    from replicate.run.backends import backend_of
    from replicate.sweeps import read_sweep_file, run_sweep
    from replicate.sweeps.blocks import checked_format
    from replicate.terminal.console import console
    from replicate.terminal.counted_progress import counted_progress_on

    asked = read_sweep_file(file)
    folder = output_folder(library(), out) / "sweeps" / asked.name
    with counted_progress_on(console(stderr=True), "loops") as report:
        computed = run_sweep(
            asked,
            folder,
            checked_format(file_format),
            backend_of(backend, scheduler, jobs),
            lambda step: report(step.done, step.total, step.kept),
        )
    echo(f"sweep: {asked.loops} loops in {folder}; blocks computed: {computed}")

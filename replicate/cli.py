"""The command line.

Exit status: 0 = as accepted, 1 = something differs or is not explained, 2 = the run itself is broken. Errors
are one line on standard error; ``--debug`` shows where they come from. Everything heavy is imported inside
the commands, so that ``replicate --help`` answers at once.
"""

from __future__ import annotations

import io
import os
import signal
import sys
import threading
import traceback
from types import FrameType
from typing import Annotated, NoReturn

import typer

from replicate.commands import (
    accepted,
    beginnings,
    cache,
    figures,
    handouts,
    papers,
    printed,
    report,
    schemas,
    sweeps,
    whatif,
)
from replicate.commands.options import BROKEN
from replicate.errors import TERMINATED, ReplicateError
from replicate.run.exits import only_ours
from replicate.run.isolation import isolate_matplotlib
from replicate.terminal.streams import lost_output, say, whole_output

_LONGEST = 2000  # characters of a message

app = typer.Typer(
    name="replicate",
    help="Recompute the numbers that papers print, compare them, and explain the differences.",
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)


def main() -> None:
    """Run the command line; this is the console script ``replicate``."""
    with whole_output(BROKEN):
        _run()


def _run() -> NoReturn:
    arguments = sys.argv[1:]
    debug = "--debug" in arguments
    _prepare()
    try:
        with only_ours():
            status = app(
                args=[argument for argument in arguments if argument != "--debug"],
                prog_name="replicate",
                standalone_mode=False,
            )
    except SystemExit as error:
        if error.code == TERMINATED:
            raise
        if debug:
            traceback.print_exc()
        if lost_output(sys.stdout) is None:  # otherwise that is the reason
            say(f"replicate: code of a paper tries to end the program, with status {error.code}")
        sys.exit(BROKEN)
    except Exception as error:
        if debug:
            raise
        if lost_output(sys.stdout) is None:  # otherwise that is the error
            say(f"replicate: {_shortened(_one_line(error))}")
        sys.exit(BROKEN)
    sys.exit(status or 0)


def _prepare() -> None:
    """Let a terminal without Unicode show what it can, and a terminated run tidy up first."""
    isolate_matplotlib()
    os.environ.pop("SOURCE_DATE_EPOCH", None)  # numpy reads a number in it; nothing of ours has a date
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGTERM, _end)


def _end(number: int, _: FrameType | None) -> NoReturn:
    """Tidy up and end; whoever asks again asks for what is being done."""
    signal.signal(number, signal.SIG_IGN)
    sys.exit(TERMINATED)


def _shortened(line: str) -> str:
    """Return a line that a damaged file cannot make endless: its middle is left out."""
    return line if len(line) <= _LONGEST else f"{line[: _LONGEST // 2]} ... {line[-_LONGEST // 2 :]}"


def _one_line(error: Exception) -> str:
    text = " ".join(str(error).split())
    if isinstance(error, ReplicateError):
        return text
    usage = getattr(error, "format_message", None)  # a wrong option or argument
    if usage is not None:
        context = getattr(error, "ctx", None)
        hint = f" ({context.command_path} --help shows what is allowed)" if context else ""
        return f"{' '.join(usage().split()).rstrip('.')}{hint}"
    if isinstance(error, OSError) and error.filename:
        return f"{error.filename}: {error.strerror or type(error).__name__}"
    return f"unexpected {type(error).__name__}: {text} (--debug shows where)"


@app.callback(invoke_without_command=True)
def _options(
    context: typer.Context,
    debug: Annotated[bool, typer.Option("--debug", help="Show the traceback of an error.")] = False,  # noqa: ARG001  -- see below
    version: Annotated[bool, typer.Option("--version", help="Show the version and exit.")] = False,
) -> None:
    # `--debug` is taken out by `main`, wherever it stands; it is here for the help.
    if version:
        import replicate

        typer.echo(f"replicate {replicate.__version__}")
        raise typer.Exit
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())
        raise typer.Exit(BROKEN)


app.command(name="list")(papers.list_)
app.command()(papers.show)
app.command(context_settings={"allow_extra_args": True, "ignore_unknown_options": True})(papers.chart)
app.command()(report.report)
app.command()(report.check)
app.command()(accepted.diff)
app.command()(accepted.accept)
app.command()(handouts.handout)
app.command()(beginnings.init)
app.command()(beginnings.new)
app.add_typer(printed.app, name="printed")
app.add_typer(figures.app, name="figures")
app.command()(cache.cache)
app.command()(schemas.schema)
app.command()(whatif.whatif)
app.command()(sweeps.sweep)

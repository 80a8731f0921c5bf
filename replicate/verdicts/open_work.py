"""What an author has marked as still to do in a paper's own files."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.resources.abc import Traversable

from replicate.exhibits import Paper
from replicate.exhibits.file_names import display_name

MARK = "TODO"

_ENDINGS = (".py", ".md", ".toml", ".csv")


def open_work(paper: Paper) -> list[str]:
    """Return one line for each place that is marked with ``TODO``: file, line, and what is to do."""
    return [line for file in _files(paper.folder()) for line in _marks(file)]


def _files(folder: Traversable) -> Iterator[Traversable]:
    for entry in sorted(folder.iterdir(), key=lambda entry: entry.name):
        if entry.is_dir() and not entry.name.startswith((".", "__")):
            yield from _files(entry)
        elif entry.is_file() and entry.name.endswith(_ENDINGS):
            yield entry


def _marks(file: Traversable) -> Iterator[str]:
    text = file.read_bytes().decode("utf-8", errors="replace")
    for number, line in enumerate(text.splitlines(), 1):
        _, mark, what = line.partition(MARK)
        if mark and not file.name.endswith(".md"):
            what = what.partition('"')[0]  # the rest is code
        if mark:
            yield f"{display_name(file)}:{number}: still to do: {what.strip(' :').strip() or 'not said what'}"

"""The languages of what is made besides the papers' own texts: a file of words for each, one's own among them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from replicate.errors import ReplicateError, listed
from replicate.plain_text import parse_toml, read_text
from replicate.resources import templates_dir

FOLDER = "languages"
_TAG = re.compile(r"[a-z]{2,3}")


@dataclass(frozen=True)
class Language:
    """The words that a sheet has besides its text.

    Attributes
    ----------
    tag
        As in the documents' metadata, say ``en``.
    region
        Say ``gb``; empty if none is meant.
    words
        By their names.
    """

    tag: str
    region: str
    words: Mapping[str, str]

    def __getitem__(self, name: str) -> str:
        """Return a word."""
        return self.words[name]

    @property
    def code(self) -> str:
        """Tag and region, as HTML has it."""
        return f"{self.tag}-{self.region.upper()}" if self.region else self.tag


def languages() -> str:
    """Return what can be said for a language, in words."""
    known = sorted(file.stem for file in (templates_dir() / FOLDER).glob("*.toml"))
    return f"{', '.join(known)}, or the path of a file like en.toml, say fr.toml"


@cache
def language(tag: str = "en", what: str = "--language") -> Language:
    """Return a language that comes with this package, or that of a file of one's own.

    Parameters
    ----------
    tag
        Its name, or the path of a file like ``en.toml`` whose name it is.
    what
        Where it is asked for, for messages.

    Raises
    ------
    ReplicateError
        If there is no such file, or it is not as ``en.toml``.
    """
    english = templates_dir() / FOLDER / "en.toml"
    path = Path(tag) if tag.endswith(".toml") else english.parent / f"{tag}.toml"
    if not _TAG.fullmatch(path.stem) or not path.is_file():
        msg = f"{what} is '{tag}', allowed: {languages()}"
        raise ReplicateError(msg)
    found = parse_toml(read_text(path, path.name, ReplicateError), path.name, ReplicateError)
    words, region = found.get("words"), found.get("region", "")
    if not isinstance(words, dict) or not isinstance(region, str):
        msg = f"{path.name}: needs a text 'region' and a table [words], as {FOLDER}/en.toml"
        raise ReplicateError(msg)
    needed = set(words if path == english else language().words)
    for names, wrong in ((needed - set(words), "lacks"), (set(words) - needed, "has an unknown")):
        if names:
            msg = f"{path.name}: [words] {wrong} {listed(sorted(names))}"
            raise ReplicateError(msg)
    for name, word in words.items():
        if not isinstance(word, str) or not word.strip():
            msg = f"{path.name}: '{name}' is {word!r}, allowed: a text"
            raise ReplicateError(msg)
    return Language(path.stem, region, words)

"""How a file of a paper's package is named in messages: short, with forward slashes, never absolute."""

from __future__ import annotations

from importlib.resources.abc import Traversable
from pathlib import PurePath


def display_name(path: Traversable | PurePath) -> str:
    """Return the path from the paper's own folder on.

    Parameters
    ----------
    path
        A data file of a paper: ``<paper>/ledger.toml``, ``<paper>/printed/<exhibit>.csv``, ...

    Returns
    -------
    str
        The last two parts of the path, three for a file in ``printed``.

    Examples
    --------
    >>> display_name(PurePath("somewhere/papers/bayhan/printed/table-2.csv"))
    'bayhan/printed/table-2.csv'
    >>> display_name(PurePath("somewhere/papers/bayhan/ledger.toml"))
    'bayhan/ledger.toml'
    """
    parts = PurePath(str(path)).parts
    keep = 3 if len(parts) > 1 and parts[-2] == "printed" else 2
    return "/".join(part for part in parts[-keep:] if part.strip("/\\"))

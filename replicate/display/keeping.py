"""Texts that take long to make: whoever makes them asks for one by its name, and an earlier run may have kept it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol


class Keep(Protocol):
    """Returns the text that an earlier run kept, or has it made."""

    def __call__(self, name: str, make: Callable[[], str], of: str = "") -> str:
        """Return the text of a name.

        Parameters
        ----------
        name, of
            Say all that it depends on besides the code: `of` is what would be too long for a name. Of each name the
            last text is kept.
        make
            Makes it.
        """


def made_anew(name: str, make: Callable[[], str], of: str = "") -> str:  # noqa: ARG001 -- those of a `Keep`
    """Return a text that nothing keeps."""
    return make()

"""The HTML report: an overview and one page per paper, readable without a network, a server or a script."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from replicate.report.pages import build_report

__all__ = ["build_report"]


def __getattr__(name: str) -> object:
    """Import what writes pages when it is asked for: a report that stands needs nothing of it."""
    if name not in __all__:
        msg = f"module {__name__!r} has no attribute {name!r}"
        raise AttributeError(msg)
    from replicate.report import pages

    return getattr(pages, name)

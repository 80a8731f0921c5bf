"""A reading: one way to understand how an exhibit was computed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeVar

from replicate.exhibits.definitions import check_function, check_id, check_texts
from replicate.exhibits.order import module_being_imported

AS_WRITTEN = "as-written"

Compute = TypeVar("Compute", bound=Callable[..., Any])


@dataclass(frozen=True)
class Reading:
    """One way to understand how an exhibit was computed.

    Attributes
    ----------
    id
        ``as-written`` for the first reading of an exhibit, a short ASCII slug for every other.
    title
        One line for table headings and the terminal.
    compute
        Returns the whole exhibit; rows and columns carry the keys of the printed CSV. With `inputs`, returns the
        quantities of one case instead: ``compute(case, given)``, where `given` has a number for each input.
    note
        What is assumed and why, in Markdown; may be empty.
    inputs
        The quantities that the reading takes from the print. Each stands for all numbers that round to it.
    inputs_of
        Those of the cases that take others.
    tried
        How many alternatives were tried for each free choice of the reading, by what was chosen.
    module
        The module in which it is defined; set by itself.
    """

    id: str
    title: str
    compute: Callable[..., Any]
    note: str = ""
    inputs: tuple[str, ...] = ()
    inputs_of: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    tried: Mapping[str, int] = field(default_factory=dict)
    module: str = field(default_factory=module_being_imported, compare=False, repr=False)

    def __post_init__(self) -> None:
        """Check the types that Python does not."""
        what = f"reading '{self.id}'"
        check_id("reading", self.id)
        check_texts(what, title=self.title, note=self.note)
        check_function(what, "what computes it", self.compute)

"""What one asks a controller to be shown as, and when two are equal."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any, cast

from replicate.loops.summary import html_table

if TYPE_CHECKING:
    from replicate.loops.controller import PID


class ControllerViews:
    """Methods of `PID` that only show what it is."""

    @property
    def _pid(self) -> PID:
        return cast("PID", self)

    def notation(self) -> str:
        """Return the controller as a text from which `replicate.loops.notation.parse_controller` gives an equal one."""
        from replicate.loops.notation import controller_notation

        return controller_notation(self._pid)

    def to_control(self) -> Any:
        """Return the feedback part, from -y to u, as a python-control transfer function."""
        from replicate.loops.to_control import controller_to_control

        return controller_to_control(self._pid)

    def _parameters(self) -> list[tuple[str, object]]:
        """Return the gains, and what differs from the default, by name."""
        found = [(field, getattr(self, field.name)) for field in fields(self._pid)]
        named = {"k", "ki"}
        return [(field.name, value) for field, value in found if field.name in named or value != field.default]

    def _identity(self) -> tuple[object, ...]:
        return tuple(getattr(self, field.name) for field in fields(self._pid))

    def __eq__(self, other: object) -> bool:
        """Compare the parameters: a PI controller is a PID controller without derivative part."""
        return self._identity() == other._identity() if isinstance(other, ControllerViews) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._identity())

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in self._parameters())})"

    def _repr_html_(self) -> str:
        return html_table(iter(self._parameters()))

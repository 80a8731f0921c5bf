"""Objects whose attributes are set once: what was computed from them stays true."""

from __future__ import annotations

from dataclasses import FrozenInstanceError
from functools import cached_property


class SetOnce:
    """Base of objects that are equal, and hashed, by what they are made of, and from which results are kept."""

    def __setattr__(self, name: str, value: object) -> None:
        if name in self.__dict__:
            msg = f"{name} of a {type(self).__name__} cannot be changed: make a new one"
            raise FrozenInstanceError(msg)
        object.__setattr__(self, name, value)

    def __delattr__(self, name: str) -> None:
        msg = f"{name} of a {type(self).__name__} cannot be deleted"
        raise FrozenInstanceError(msg)

    def __getstate__(self) -> dict[str, object]:
        """Leave out what can be computed again."""
        kinds = type(self).__mro__
        kept = {name for kind in kinds for name, value in vars(kind).items() if isinstance(value, cached_property)}
        return {name: value for name, value in vars(self).items() if name not in kept}

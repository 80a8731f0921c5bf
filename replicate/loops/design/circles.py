r"""Circles that the Nyquist curve must stay outside: center -C and radius R from Ms, from Mp, or from both.

Astrom, Panagopoulos and Hagglund, "Design of PI controllers based on non-convex optimization", Automatica 34 (1998),
eqs. (6) to (8), with the errata of the thesis for the combined circle.
"""

from __future__ import annotations

from dataclasses import dataclass

from replicate.loops import checks
from replicate.loops.errors import LoopError


@dataclass(frozen=True)
class Circle:
    """A circle with center ``-center`` on the negative real axis and radius ``radius``; it contains the point -1.

    Attributes
    ----------
    center, radius
        Distance of the centre from the origin, to the left, and radius; both positive.
    """

    center: float
    radius: float

    def __post_init__(self) -> None:
        for name in ("center", "radius"):
            object.__setattr__(self, name, checks.positive(f"the circle's {name}", getattr(self, name)))

    @classmethod
    def of(cls, ms: float | None = None, mp: float | None = None) -> Circle:
        r"""Return the circle that bounds \|S\| by ``ms``, \|T\| by ``mp``, or both at once.

        The combined circle is the smallest one on the real axis through -Mp/(Mp-1) and -(Ms-1)/Ms; it contains the two
        single circles if Ms - 1 < Mp < Ms + 1.

        Raises
        ------
        LoopError
            If neither bound is given or a bound is not finite and greater than one.
        """
        for name, bound in (("ms", ms), ("mp", mp)):
            allowed = "finite and greater than 1"
            if bound is not None and not checks.finite(name, bound, allowed=allowed) > 1.0:
                msg = f"{name} must be {allowed}, not {bound}"
                raise LoopError(msg)
        ms, mp = (None if bound is None else float(bound) for bound in (ms, mp))
        if ms is not None and mp is not None:
            left, right = mp / (mp - 1.0), (ms - 1.0) / ms
            return cls(0.5 * (left + right), 0.5 * (left - right))
        if ms is not None:
            return cls(1.0, 1.0 / ms)
        if mp is not None:
            return cls(mp**2 / (mp**2 - 1.0), mp / (mp**2 - 1.0))
        msg = "a design needs a bound: ms, mp, or both"
        raise LoopError(msg)

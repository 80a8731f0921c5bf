"""Paper I: design of PI controllers by non-convex optimisation, with its errata."""

MODULES: tuple[str, ...] = ()
NUMBERED: tuple[str, ...] = ()

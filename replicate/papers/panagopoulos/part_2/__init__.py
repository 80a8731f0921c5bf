"""Paper II and its supplement: PID design by constrained optimisation."""

MODULES: tuple[str, ...] = ()
NUMBERED: tuple[str, ...] = ()

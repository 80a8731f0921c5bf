"""Papers III to VI: loop shaping, steam generator, industrial evaluations, active damping."""

MODULES: tuple[str, ...] = ()
NUMBERED: tuple[str, ...] = ()

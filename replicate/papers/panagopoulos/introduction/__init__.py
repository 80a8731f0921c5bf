"""The introduction to the thesis: its figures and formulas, which the six papers take up."""

MODULES: tuple[str, ...] = ("sketches",)
NUMBERED: tuple[str, ...] = (*(f"fig-{number}" for number in range(1, 7)), "formula-0-1", "formula-0-2")

"""A handout for the installed paper with an exercise whose numbers vary, a figure for the key, a file for the sheet."""

from __future__ import annotations

from pathlib import Path

HANDOUT = """from replicate.exhibits.exercises import Exercises
from replicate.exhibits.variants import Answer, VariedFigure

exercises = Exercises()


def draw(fig, *, inputs):
    {in_figure}
    fig.subplots().plot([0, inputs["a"]])


@exercises.vary(
    "division",
    original={{"a": 1}},
    variant=lambda rng: {{"a": rng.randint(11, 99)}},
    requires={{}},
    files=lambda inputs: {{"{file}": "a"}},
    figures={{"line": VariedFigure("A line", "It rises.", draw, in_key=True)}},
)
def division(inputs):
    {in_answers}
    return {{"half": Answer(inputs["a"] / 2, digits=3)}}
"""
SOUND = {"in_figure": "pass", "in_answers": "pass", "file": "data.csv"}
TEXT = """# Roots

::: exercise
## Halve {vary="division"}
Halve ${{ inputs('division')['a'] }}$.

::: solution
${{ fixed(answer('division')['half'], 3) }}$

{{ figure('line') }}
:::
:::
"""


def write(folder: Path, **changes: str) -> None:
    """Write the handout into the paper's folder; changes are code or names in place of what is sound."""
    (folder / "handout.py").write_text(HANDOUT.format(**SOUND | changes), encoding="utf-8")
    (folder / "handout.md").write_text(TEXT, encoding="utf-8")

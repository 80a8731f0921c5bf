"""A tiny class set made up for tests: two exercises with numbers of one's own, one without, a figure, a program."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
import synthetic

from replicate.exhibits.exercises import Exercises
from replicate.exhibits.results import FigureResult, Results
from replicate.exhibits.variants import Answer, Answers, Inputs
from replicate.handout import ClassSet
from replicate.handout import build as build_module
from replicate.handout import class_set as class_set_module
from replicate.handout import notebook as notebook_module
from replicate.handout import placing as placing_module

SVG = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 50" width="100" height="50">'
    '<path d="M 0 50 L 100 0" stroke="#000" fill="none"/></svg>'
)
PNG = bytes.fromhex(
    "89504e470d0a1a0a0000000d4948445200000001000000010806000000" + "1f15c4890000000d49444154789c63f8ffff3f0005fe02fe"
    "a735817b0000000049454e44ae426082"
)  # one pixel

TEXT = """# A toy

## Exercises

::: exercise
## Divide {vary="division"}
Divide ${{ inputs('division')['a'] }}$ by ${{ inputs('division')['b'] }}$.{{ stated('division') }}

::: solution
It is ${{ fixed(answer('division')['quotient'], 4) }}$.
:::
:::

::: exercise
## Why $x < y$? {tool="Python"}
Explain the figure & say "why". Set $$\\frac{1}{1 + s}$$ aside.

{{ figure('fig-1', width=0.5) }}
A caption.

```{.python .run}
number = 6
```

::: solution
Because of

```{.python .run}
print(7 * number)
```
:::
:::

::: exercise
## Two parts {vary="sums"}
Add and multiply ${{ inputs('sums')['a'] }}$ and ${{ inputs('sums')['b'] }}$.

::: solution
${{ fixed(answer('sums')['sum'], 0) }}$ and ${{ fixed(answer('sums')['product'], 0) }}$.
:::
:::
"""


def exercises() -> Exercises:
    found = Exercises()

    @found.vary(
        "division",
        original={"a": 1, "b": 4},
        variant=lambda rng: {"a": rng.randint(11, 99), "b": rng.randint(3, 9)},
        requires={"a is no multiple of b": lambda inputs: float(inputs["a"]) % float(inputs["b"]) != 0},
        stated="State three digits.",
    )
    def quotient(inputs: Inputs) -> Answers:
        a, b = float(inputs["a"]), float(inputs["b"])
        carried = (a * float(f"{1 / b:.3g}"),)
        return {"quotient": Answer(a / b, digits=3, carried=carried, mistakes={"upside down": b / a})}

    @found.vary(
        "sums",
        original={"a": 2, "b": 3},
        variant=lambda rng: {"a": rng.randint(20, 40), "b": -rng.randint(3, 9)},
        requires={},
    )
    def sums(inputs: Inputs) -> Answers:
        a, b = float(inputs["a"]), float(inputs["b"])
        return {
            "sum": Answer(
                a + b, unit="kg", tolerance=0.5, mistakes={"sign # of b / ~": a - b}, asked="the sum $a + b$"
            ),
            "product": Answer(a * b, tolerance=1.0, mistakes={"sign": -a * b}),
        }

    return found


def class_set(folder: Path, patched: pytest.MonkeyPatch, text: str = TEXT, **settings: object) -> ClassSet:
    """Make the set; its paper lies in a folder of the test."""
    (folder / "toy").mkdir(exist_ok=True)
    (folder / "toy" / "handout.md").write_text(text, encoding="utf-8")
    paper = synthetic.paper(folder / "toy")
    made = exercises()
    for module in (placing_module, class_set_module, build_module, notebook_module):
        patched.setattr(module, "exercises_of", lambda _: made)
    return ClassSet(paper, results(), (), **settings)  # type: ignore[arg-type]


def results() -> Results:
    found = synthetic.results()
    figure = found["toy", "fig-1"]
    assert isinstance(figure, FigureResult)
    axes = [{"title": "", "xlabel": "t", "ylabel": "y", "xlim": [0, 1], "ylim": [0, 1], "legend": []}]
    found["toy", "fig-1"] = replace(figure, svg=SVG, png=PNG, axes=axes)
    return found

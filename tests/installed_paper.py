"""A tiny installed distribution with one paper, written into a folder: what a user's own paper looks like."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

_INIT = """
from replicate.exhibits import Paper

paper = Paper(
    id="lab",
    package=__name__,
    title="A laboratory",
    authors=("N. N.",),
    citation="N. N., A laboratory, 2000.",
    year=2000,
    modules=("exhibits",),
    numbered=("table-1", "fig-1", "fig-2"),
)
"""

_EXHIBITS = """
import math
import os

import numpy as np
import pandas as pd

from lab_paper import paper
from replicate.exhibits import Finding

table = paper.table("table-1", "Roots and logarithms", rows=("2", "3"), columns=("root", "log"))


@table.reading("as-written", "As written")
def roots():
    if os.environ.get("LAB_BREAKS"):
        raise ValueError("the kettle is empty")
    return pd.DataFrame({"root": [2**0.5, 3**0.5], "log": [math.log(2), math.log(3)]}, index=["2", "3"])


@table.reading("decimal", "Logarithms to base ten", "The paper's *log* may be decimal.")
def decimal_logarithms():
    return pd.DataFrame({"root": [2**0.5, 3**0.5], "log": [math.log10(2), math.log10(3)]}, index=["2", "3"])


@paper.figure("fig-1", "A decaying oscillation", alt="It decays.", size=(3.0, 2.0))
def draw(fig):
    axes = fig.subplots()
    t = np.linspace(0.0, 10.0, 1001)
    axes.plot(t, np.exp(-t / 3.0) * np.cos(2.0 * t), label="output")
    axes.set_xlabel("time")


paper.not_computable("fig-2", "A photograph", "It shows the laboratory.")
claims = paper.claims()


@claims.claim("root", "The root of two is below 1.5.", where="p. 1", printed="1.5")
def root():
    return Finding("holds", 2**0.5, "It is 1.41.")
"""

_HANDOUT = """# Roots

::: lead
Why?
:::

## The numbers

{{ table('table-1', readings={'as-written': 'exact'}) }}
**A table** of roots.
"""

FILES = {
    "lab_paper/__init__.py": _INIT,
    "lab_paper/exhibits.py": _EXHIBITS,
    "lab_paper/printed/table-1.csv": "number,root,log\n2,1.414,0.301\n3,1.732,0.478\n",
    "lab_paper/ledger.toml": """
[[entry]]
exhibit = "table-1"
rows = ["3"]
columns = ["log"]
cause = "misprint"
reading = "decimal"
explanation = "The last digit is wrong: {{ value('table-1', '3', 'log', 'decimal') }}."
""",
    "lab_paper/handout.md": _HANDOUT,
    "lab_paper/notes.md": "The roots hold.\n\n{{ exhibit('table-1') }}\n",
    "lab_paper-1.0.dist-info/METADATA": "Metadata-Version: 2.1\nName: lab-paper\nVersion: 1.0\n",
    "lab_paper-1.0.dist-info/entry_points.txt": "[replicate.papers]\nlab = lab_paper:paper\n",
}


@contextmanager
def installed(site: Path) -> Iterator[Path]:
    """Write the distribution into a folder and make it importable; yield the paper's own folder."""
    with importable(site, "lab_paper", FILES) as folder:
        yield folder


@contextmanager
def importable(site: Path, package: str, files: Mapping[str, str]) -> Iterator[Path]:
    """Write files into a folder from which a package can be imported; yield the package's folder."""
    for name, text in files.items():
        path = site / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    _forget(package)
    sys.path.insert(0, str(site))
    try:
        yield site / package
    finally:
        sys.path.remove(str(site))
        _forget(package)


def _forget(package: str) -> None:
    for name in [name for name in sys.modules if name.split(".")[0] == package]:
        del sys.modules[name]


def contents(folder: Path) -> dict[Path, bytes]:
    """Return what a run left behind, without what it keeps for the next one."""
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file() and "cache" not in path.parts}

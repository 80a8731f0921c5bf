"""Measure speed and error of the numerical core beside other tools, in one run; print the tables and keep them.

With ``--report`` also what a report of all papers costs, which takes minutes.
"""

from __future__ import annotations

import platform
import sys

import control
import numpy as np
import scipy

from benchmarks import reports, single_loops, sweeps
from benchmarks.common import REPORT

INTRODUCTION = """# Benchmarks

Processor time on one core; every ratio was measured in this run, every error is against the exact solution.
An aim is the ratio that the project asks of itself.
"""


def main() -> None:
    """Write the report."""
    arguments = sys.argv[1:]
    if set(arguments) - {"--report"}:
        sys.exit(f"benchmarks: allowed is --report, not {' '.join(arguments)}")
    tables = [*single_loops.tables(), *sweeps.tables(), *(reports.tables() if arguments else ())]
    versions = f"Python {platform.python_version()}, numpy {np.__version__}, scipy {scipy.__version__}"
    made_with = f"{versions}, python-control {control.__version__}.\n"
    REPORT.parent.mkdir(parents=True, exist_ok=True)
    REPORT.write_text(
        "\n".join([INTRODUCTION, made_with, *(table.to_markdown() for table in tables)]), encoding="utf-8"
    )
    print(f"\nwritten: {REPORT.parent.name}/{REPORT.name}")


if __name__ == "__main__":
    main()

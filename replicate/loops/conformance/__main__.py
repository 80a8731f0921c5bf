"""Measure a library against the exact values and print how many digits are right.

``python -m replicate.loops.conformance --library python-control`` shows an overview, ``--loops`` one line for each loop
as well, and ``--library replicate --require 9`` fails if a value of this library has fewer than nine right digits.
"""

from __future__ import annotations

import argparse
import importlib
import sys

from replicate.loops.conformance.goldens import goldens
from replicate.loops.conformance.library import Library, measure
from replicate.loops.conformance.report import each_loop, overview

#: Name on the command line and module of the adapter.
LIBRARIES = {"replicate": "replicate_loops", "python-control": "python_control"}


def main(arguments: list[str] | None = None) -> int:
    """Return 0, or 1 if a value has fewer right digits than ``--require`` demands."""
    parser = argparse.ArgumentParser(prog="python -m replicate.loops.conformance", description=__doc__.splitlines()[0])
    parser.add_argument("--library", choices=sorted(LIBRARIES), default="replicate", help="what to measure")
    parser.add_argument("--only", metavar="TEXT", default="", help="loops whose name or kind contains the text")
    parser.add_argument("--loops", action="store_true", help="one line for each loop, too")
    parser.add_argument("--require", metavar="DIGITS", type=float, default=0.0, help="fail if a value has fewer")
    chosen = parser.parse_args(arguments)
    module = importlib.import_module(f"replicate.loops.conformance.adapters.{LIBRARIES[chosen.library]}")
    library: Library = module.library()
    loops = [golden for golden in goldens() if chosen.only in golden.id or chosen.only in golden.kind]
    if not loops:
        sys.stderr.write(f"no loop has '{chosen.only}' in its name or kind\n")
        return 2
    results = {
        (setting, golden.id): measure(library, golden, setting) for setting in library.settings for golden in loops
    }
    lines = list(overview(library, loops, results))
    if chosen.loops:
        for setting in library.settings:
            lines += ["", *each_loop(loops, setting, results)]
    failures = [
        f"{name}: {quantity.name} has {right:.1f} right digits in {setting}, fewer than {chosen.require:g}"
        for (setting, name), found in results.items()
        for quantity, right in found.items()
        if right is not None and right < chosen.require
    ]
    sys.stdout.write("\n".join([*lines, *failures]) + "\n")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())

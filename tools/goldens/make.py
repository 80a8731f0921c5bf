"""Write replicate/loops/goldens.json: exact values of hard control loops with dead time, from mpmath alone.

    python tools/goldens/make.py [--check] [ID ...]

With ids it prints these loops instead of writing the file; with --check it says which loops of the file, all or those
named, do not come out again to the last digit, and fails if there are any. The package itself is not used.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))  # the reference formulas of the tests

import mpmath as mp
from case import DIGITS, Case, load
from frequency import feedthrough, quantities
from poles import Pole, poles
from responses import Output, metrics

GOLDENS = ROOT / "replicate" / "loops" / "goldens.json"
SIGNIFICANT = 16
LISTED = 6
LICENSE = "CC0-1.0: no rights reserved. Any library may use, change and ship these numbers."


def golden(case: Case) -> dict[str, Any]:
    """Return the record of one loop."""
    mp.mp.dps = DIGITS
    complete = poles(case)
    stable = complete[0].value.real < 0
    record: dict[str, Any] = {
        "id": case.id,
        "kind": case.record["kind"],
        "source": case.record["source"],
        "plant": {"num": case.plant[0], "den": case.plant[1], "dead_time": case.dead_time},
        "controller": {name: float(value) for name, value in case.numbers.items()},
        "stable": bool(stable),
        "poles": [
            {"re": _number(p.value.real), "im": _number(p.value.imag), "multiplicity": p.multiplicity}
            for p in _listed(case, complete)
        ],
    }
    if stable:
        record |= {name: _numbers(pair) for name, pair in quantities(case).items()}
    record["responses"] = _responses(case, complete)
    if stable and not _jumps(case):
        record["metrics"] = _numbers(metrics(case, complete))
    return record


def _jumps(case: Case) -> bool:
    """Whether the output jumps: at the step itself, or at each return of a jump of a neutral loop."""
    poly = case.polynomials
    return bool(feedthrough(case)) or len(poly["F"]) == len(poly["A"]) or len(poly["G"]) == len(poly["A"])


def _listed(case: Case, complete: list[Pole]) -> list[Pole]:
    """Return the poles that are the rightmost of all: those right of where a neutral loop's poles crowd."""
    count = case.record.get("listed_poles", LISTED)
    direct = feedthrough(case)
    if not (direct and case.dead_time):
        return complete[:count]
    crowd = mp.log(direct) / case.dead_time
    return [pole for pole in complete[:count] if pole.value.real > crowd * mp.mpf("0.99")]


def _responses(case: Case, complete: list[Pole]) -> dict[str, Any]:
    found: dict[str, Any] = {"times": case.record["times"]}
    for name, kind in (("step", "F"), ("load_step", "G")):
        output = Output(case, complete, kind)
        late = not case.dead_time or max(case.record["times"]) < 60 * case.dead_time
        found[name] = [_number(output.early(mp.mpf(t)) if late else output(mp.mpf(t))) for t in case.record["times"]]
        if late and case.dead_time and complete[0].value.real < 0:
            _agree(case, output)
    return found


def _agree(case: Case, output: Output) -> None:
    """Raise unless the dead-time series and the sum of residues give the same value where both hold."""
    t = max(output.late, *case.record["times"])
    if t > 40 * case.dead_time or feedthrough(case):
        return
    series, early = output.early(mp.mpf(t)), output.early(mp.mpf(case.record["times"][0]))
    # the poles are those of the closed form of a gain, the series has its double
    if abs(series - output(mp.mpf(t))) > mp.mpf(10) ** -16 * (abs(output.final) + abs(series) + abs(early)):
        msg = f"{case.id}: series and residues differ at t = {t}: {series} and {output(mp.mpf(t))}"
        raise ArithmeticError(msg)


def _numbers(values: dict[str, Any]) -> dict[str, float | None]:
    return {name: _number(value) for name, value in values.items()}


def _number(value: mp.mpf | None) -> float | None:
    return None if value is None else float(mp.nstr(value, SIGNIFICANT + 1, strip_zeros=False))


def main(arguments: list[str]) -> int:
    """Compute all loops, or print or check the given ones; return 1 if one differs from the file."""
    ids = [argument for argument in arguments if argument != "--check"]
    cases = load()
    unknown = set(ids) - {case.id for case in cases}
    if unknown:
        sys.stderr.write(f"no loop has the id {', '.join(sorted(unknown))}\n")
        return 2
    chosen = [case for case in cases if not ids or case.id in ids]
    with ProcessPoolExecutor(2) as pool:
        records = pool.map(golden, chosen)
        if "--check" in arguments:
            return check(records)
        if ids:
            sys.stdout.write(json.dumps(list(records), indent=1) + "\n")
        else:
            write(list(records))
    return 0


def check(records: Iterable[dict[str, Any]]) -> int:
    """Say which loops are not those of the file; return 1 if one is not."""
    accepted = {record["id"]: record for record in json.loads(GOLDENS.read_text(encoding="utf-8"))["loops"]}
    differing = 0
    for record in records:
        known = accepted.get(record["id"], {})
        wrong = [name for name in record.keys() | known.keys() if record.get(name) != known.get(name)]
        differing += bool(wrong)
        sys.stdout.write(f"{record['id']}: {', '.join(sorted(wrong)) + ' differ' if wrong else 'as in the file'}\n")
        sys.stdout.flush()
    return 1 if differing else 0


def write(records: list[dict[str, Any]]) -> None:
    """Write the file, one line for each loop."""
    rows = ",\n".join(json.dumps(record) for record in records)
    head = json.dumps({"license": LICENSE, "about": "docs/goldens.md"})[:-1]
    GOLDENS.write_text(f'{head}, "loops": [\n{rows}\n]}}\n', encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

"""Time of one PI and one PID design for a range of plants (Ms = 1.4 and 2.0), each verified on all frequencies."""

from __future__ import annotations

import time

import numpy as np

from replicate.loops import Plant, design_pi, design_pid

PLANTS = {
    "1/(s+1)^3": Plant([1.0], np.poly([-1.0] * 3)),
    "1/(s+1)^4": Plant([1.0], np.poly([-1.0] * 4)),
    "1/(s+1)^7": Plant([1.0], np.poly([-1.0] * 7)),
    "e^-5s/(s+1)^3": Plant([1.0], np.poly([-1.0] * 3), dead_time=5.0),
    "e^-s/(s+1)": Plant.foptd(1.0, 1.0, 1.0),
    "(1-2s)/(s+1)^3": Plant([-2.0, 1.0], np.poly([-1.0] * 3)),
    "1/(s(s+1)^2)": Plant([1.0], [1.0, 2.0, 1.0, 0.0]),
}


def main() -> None:
    """Print the table."""
    print(f"{'design':18}{'Ms':>6}{'PI, ms':>10}{'PID, ms':>10}{'ki of PI':>12}{'ki of PID':>12}")
    for name, plant in PLANTS.items():
        for ms in (1.4, 2.0):
            start = time.perf_counter()
            pi = design_pi(plant, ms=ms)
            middle = time.perf_counter()
            pid = design_pid(plant, ms=ms)
            end = time.perf_counter()
            milliseconds = f"{1e3 * (middle - start):10.1f}{1e3 * (end - middle):10.1f}"
            print(f"{name:18}{ms:6.1f}{milliseconds}{pi.ki:12.6f}{pid.ki:12.6f}")


if __name__ == "__main__":
    main()

"""What the paper says about the drugs in words."""

import math
import statistics

from scipy import stats

from replicate.exhibits import Finding
from student1908 import paper
from student1908.illustration_1 import hours

claims = paper.claims()

LEVEL = 0.95


@claims.claim(
    "of-value",
    "In the usual dose drug 2 was of value as a soporific, and drug 1 was not.",
    where="Section IX, Illustration I",
)
def of_value() -> Finding:
    """Judge both means with the exact distribution, at the usual level of one-sided tests."""
    first, second = (_probability_positive(hours()[drug]) for drug in ("dextro", "laevo"))
    verdict = "holds" if second >= LEVEL > first else "fails"
    return Finding(
        verdict,
        second,
        f"With Student's distribution the probability that the mean is positive is {first:.4f} for drug 1 and "
        f"{second:.4f} for drug 2; only the second exceeds {LEVEL:g}.",
    )


def _probability_positive(sample: list[float]) -> float:
    """Return the area of Student's distribution below t, with one degree of freedom less than patients."""
    size = len(sample)
    t = statistics.fmean(sample) / (statistics.stdev(sample) / math.sqrt(size))
    return float(stats.t.cdf(t, size - 1))

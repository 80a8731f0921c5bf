"""The values for which the paper draws its charts."""

TAUS = tuple(k / 10 for k in range(1, 11))
"""Normalised dead times of Figures 6 and 7; the paper's text checks its statements on them too."""

FREQUENCIES = tuple(0.25 * k for k in range(1, 9))
"""Gain crossover frequencies of Figure 4."""

"""Numerics that know no loop: Chebyshev series, polynomials, roots, brackets, peaks."""

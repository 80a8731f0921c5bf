"""Integrals over many responses at once: of the error, its square, its size, and of what the control signal moves."""

from __future__ import annotations

from functools import cache, cached_property

import numpy as np
from numpy.polynomial import chebyshev as chebyshev_series
from numpy.typing import NDArray

from replicate.loops.numerics import chebyshev, series_roots
from replicate.loops.sweep import block_series
from replicate.loops.sweep.block_series import DEGREE
from replicate.loops.sweep.response_pieces import MARGIN, ResponsePieces, summits

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Places = NDArray[np.intp]

NEGLIGIBLE = 3e-11  # share of an integral that all pieces together may have which are looked at no further
NEAR_ENOUGH = 1e-5  # last step of Newton's method: the next is of its square, and an integral errs by a square again
UNSURE = 3e-10  # share of an integral that what is left beside the last modes may have
FLAT = 1e-13  # of a control signal's size: a slope that is rounding


class ResponseIntegrals(ResponsePieces):
    """The integrals over the responses of a block."""

    @cached_property
    def _areas(self) -> Array:
        """Integrals of the deviation over the pieces, shape (pieces, n)."""
        areas = np.zeros((len(self.pieces), self.count))
        for index, piece in enumerate(self.pieces):
            areas[index, piece.columns] = piece.area
        return np.asarray(np.where(self._exists, areas, 0.0) * (0.5 * self.responses.lengths)[:, None])

    def ie(self) -> Array:
        """Return the integrated error, for a load response the integrated deviation."""
        modes = self.responses.modes
        total = self._areas.sum(axis=0) + modes.integral()
        self._require_sure(1.0 / modes.beyond, np.abs(self._areas).sum(axis=0) + np.abs(modes.integral()))
        return np.asarray(np.where(self.final == 0.0, total, -total))

    def ise(self) -> Array:
        """Return the integrated squared error."""
        points, weights = chebyshev.gauss_legendre(DEGREE + 2)
        matrix = chebyshev.basis(points, DEGREE).T @ chebyshev.values_to_coefficients(DEGREE)
        squares = np.zeros((len(self.pieces), self.count))
        for index, piece in enumerate(self.pieces):
            squares[index, piece.columns] = weights @ (matrix @ piece.values) ** 2
        squares = np.where(self._exists, squares, 0.0) * (0.5 * self.responses.lengths)[:, None]
        modes = self.responses.modes
        found = squares.sum(axis=0) + modes.square_integral()
        return self._require_sure(modes.size / modes.beyond, found)

    def itse(self) -> Array:
        """Return the integrated squared error, weighted with the time from the step."""
        points, weights = chebyshev.gauss_legendre(DEGREE + 2)
        matrix = chebyshev.basis(points, DEGREE).T @ chebyshev.values_to_coefficients(DEGREE)
        half, middle = 0.5 * self.responses.lengths, self._middles()
        total = np.zeros((len(self.pieces), self.count))
        for index, piece in enumerate(self.pieces):
            times = middle[index] + half[index] * points
            total[index, piece.columns] = (half[index] * times * weights) @ (matrix @ piece.values) ** 2
        total = np.where(self._exists, total, 0.0)
        modes, decay = self.responses.modes, self.responses.modes.beyond
        found = total.sum(axis=0) + modes.square_moment()
        return self._require_sure(modes.size * (modes.start + 0.5 / decay) / decay, found)

    def iae(self) -> Array:
        """Return the integrated absolute error."""
        total = np.abs(self._areas)
        piece, column = self._crossing(total, np.ones(len(self.pieces)))
        if piece.size:
            (area,) = _absolute(self._gathered(piece, column), _area_up_to())
            total[piece, column] = area * (0.5 * self.responses.lengths[piece])
        modes = self.responses.modes
        return self._require_sure(1.0 / modes.beyond, total.sum(axis=0) + modes.absolute_integral())

    def itae(self) -> Array:
        """Return the integrated absolute error, weighted with the time from the step."""
        half, middle = 0.5 * self.responses.lengths, self._middles()
        moment_weights = _moment_up_to().sum(axis=0) @ chebyshev.values_to_coefficients(DEGREE)
        total = np.zeros((len(self.pieces), self.count))
        for index, record in enumerate(self.pieces):
            moment = middle[index] * record.area + half[index] * (moment_weights @ record.values)
            total[index, record.columns] = np.abs(moment) * half[index]
        total = np.where(self._exists, total, 0.0)
        piece, column = self._crossing(total, middle)
        if piece.size:
            area, moment = _absolute(self._gathered(piece, column), _area_up_to(), _moment_up_to())
            total[piece, column] = half[piece] * (middle[piece] * area + half[piece] * moment)
        modes, decay = self.responses.modes, self.responses.modes.beyond
        found = total.sum(axis=0) + modes.absolute_moment()
        return self._require_sure((modes.start + 1.0 / decay) / decay, found)

    def _require_sure(self, weight: Array, total: Array) -> Array:
        """Return integrals; leave to the single loop those to which it matters what else may be left than last modes.

        It enters with a weight.
        """
        self.doubtful |= self.responses.modes.error * weight > UNSURE * total
        return total

    def _middles(self) -> Array:
        lengths = self.responses.lengths
        return np.asarray(np.cumsum(lengths) - 0.5 * lengths)

    def _crossing(self, total: Array, weight: Array) -> tuple[Places, Places]:
        """Return the pieces whose error may change its sign and which count in an integral with a weight."""
        (low, high), slack = self._ranges, self._slack
        near = (low < slack) & (high > -slack) & self._exists
        least = MARGIN * NEGLIGIBLE / len(self.pieces) * total.sum(axis=0)
        near &= slack * (self.responses.lengths * weight)[:, None] > least
        piece, column = np.nonzero(near)
        return piece, column

    def total_variation(self) -> Array:
        """Return the total variation of the control signal, jumps included."""
        total, end = np.zeros(self.count), np.zeros(self.count)
        for index, record in enumerate(self.pieces):
            assert record.control is not None  # noqa: S101  -- the march was asked to keep it
            here = self._exists[index, record.columns]
            columns, control = record.columns[here], record.control[:, here]
            moved = np.abs(control[-1] - control[0])
            slopes = _slopes() @ control
            span = np.ptp(slopes, axis=0)
            turning = (slopes.min(axis=0) - MARGIN * span < 0.0) & (slopes.max(axis=0) + MARGIN * span > 0.0)
            places = np.nonzero(turning & (span > FLAT * np.abs(control).max(axis=0)))[0]
            if places.size:
                (moved[places],) = _absolute(slopes[:, places], _area_up_to())
            # a jump of the control signal, the first from zero, counts with its height
            total[columns] += np.abs(control[0] - end[columns]) + moved
            end[columns] = control[-1]
        return np.asarray(total + self.responses.control_modes.absolute_change())


def _absolute(values: Array, *antiderivatives: Array) -> list[Array]:
    """Return integrals over [-1, 1] of polynomials in columns, given at the nodes, with every sign made positive.

    Each antiderivative is the matrix from the coefficients of e to those of an integral from -1, of e or of x e.
    """
    sign = np.sign(values)
    # two zeros may hide next to an extremum that nearly touches zero, away from other zeros
    touching = np.abs(values) < MARGIN * np.ptp(values, axis=0)
    turned = sign[1:] != sign[:-1]
    touching[1:] &= ~turned
    touching[:-1] &= ~turned
    series = block_series.series(values)
    nodes = np.broadcast_to(chebyshev.nodes(DEGREE)[:, None], values.shape)
    if touching.any():
        near = summits(-np.abs(values), touching)
        nodes, values = block_series.sharpened(series, nodes, values, near, -sign)
    negative = values < 0.0
    before, place = np.nonzero(negative[1:] != negative[:-1])
    x = series_roots.roots(
        series[:, place], nodes[before, place], nodes[before + 1, place],
        values[before, place], values[before + 1, place], converged=NEAR_ENOUGH,
    )  # fmt: skip
    sides = np.where(negative[before, place], -2.0, 2.0)
    last = np.where(negative[-1], -1.0, 1.0)
    found = []
    for antiderivative in antiderivatives:
        running = antiderivative @ series  # zero at -1
        at_root = series_roots.evaluate(running[:, place], x)
        jumps = np.bincount(place, weights=sides * at_root, minlength=last.size)
        found.append(np.asarray(last * running.sum(axis=0) + jumps))
    return found


@cache
def _area_up_to() -> Array:
    """Return the matrix from the coefficients of e to those of its integral from -1."""
    return _integrated(np.eye(DEGREE + 1))


@cache
def _moment_up_to() -> Array:
    """Return the matrix from the coefficients of e to those of the integral of x e from -1."""
    unit, times_x = np.eye(DEGREE + 1), np.zeros((DEGREE + 2, DEGREE + 1))
    times_x[1:] += 0.5 * unit  # x T_k = (T_(k+1) + T_(k-1)) / 2, x T_0 = T_1
    times_x[:DEGREE, 1:] += 0.5 * np.eye(DEGREE)
    times_x[1, 0] = 1.0
    return _integrated(times_x)


def _integrated(series: Array) -> Array:
    return np.asarray(chebyshev_series.chebint(series, lbnd=-1.0, axis=0))


@cache
def _slopes() -> Array:
    """Return the matrix from node values of a polynomial to those of its derivative."""
    table = chebyshev.basis(chebyshev.nodes(DEGREE), DEGREE - 1).T
    return np.asarray(table @ chebyshev.differentiation(DEGREE).T @ chebyshev.values_to_coefficients(DEGREE))

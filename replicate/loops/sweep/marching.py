"""The method of steps for many loops of one plant at once: one matrix product for each piece of all responses.

The map of a piece (`replicate.loops.time_domain.method_of_steps`) does not contain the gains, so that it is the same
for all loops; the control law acts column by column. A loop leaves the block when its response has come to rest, or
when what is left is a few modes (`replicate.loops.sweep.mode_search`), whose rest is known in closed form. Without dead
time each loop has a map of its own, and pieces are made longer as soon as all that is quick has decayed.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from replicate.loops.numerics import chebyshev
from replicate.loops.sweep.block_series import DEGREE
from replicate.loops.sweep.closed_law import ClosedLaw
from replicate.loops.sweep.last_modes import LastModes
from replicate.loops.sweep.loop_columns import LoopColumns, Places
from replicate.loops.sweep.mode_search import DEAD_TIMES, ModeSearch
from replicate.loops.sweep.paces import PACE
from replicate.loops.sweep.piece_law import POINTS, WEIGHTS, PieceLaw
from replicate.loops.time_domain.chain import Chain, build_chain

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

SPARSE = 7  # every so many nodes show how large a signal is
AT_REST = 1e-12  # of the largest deviation: a response that deviates less, with its control signal, is at rest
RESOLVED = 1e-12  # size of the last coefficients of the plant's input, relative to its largest value
STIFFNESS = 2.0  # largest (spectral radius x piece length) to start from
MOST_PIECES = 1200  # a loop that is not at rest by then is left to the single loop; but
MANY, LONGEST = 16, 6000  # so many go on together up to here,
MOST_KEPT = 5_000_000  # as far as there is memory for pieces times loops
ROUNDED = 1e-14  # of a horizon: what is shorter is no piece
AT_ONCE = 16  # pieces for which there is memory at once: many small pieces of it would be asked for again and again
FIRST_LOOK, LOOKS = 8, 1.2  # dead times after which modes are first looked for, and the factor to the next look
WORTH = 0.1  # share of loops that must have left before the others move together
PATIENCE = 24  # pieces after which longer ones are tried, without dead time
ENOUGH = 0.5  # share of loops for which longer ones must do: the others are marched again by themselves


@dataclass(frozen=True)
class Piece:
    """One piece of the loops that were still moving: which they are, and their deviations from the final value.

    Attributes
    ----------
    columns
        The loops, ascending.
    values
        Deviations at the nodes, shape (points, loops).
    low, high, area
        Smallest and largest of the values, and the integral over [-1, 1].
    control
        The control signal at the nodes, if it is kept.
    """

    columns: Places
    values: Array
    low: Array
    high: Array
    area: Array
    control: Array | None = None

    def cut(self, share: float) -> Piece:
        """Return the record of the first part of the piece."""
        first = _restriction(share)
        values = self.values[0] + first @ (self.values - self.values[0])  # a constant stays one
        control = None if self.control is None else first @ self.control
        return Piece(self.columns, values, values.min(axis=0), values.max(axis=0), WEIGHTS @ values, control)


@dataclass
class Responses:
    """Deviations from the final value, piece by piece.

    Attributes
    ----------
    lengths
        Length of each piece.
    final
        Final values.
    pieces
        The pieces.
    ends
        Number of pieces of each loop.
    modes, control_modes
        What follows after the last piece: deviations of the output, and of the control signal.
    unresolved
        Loops whose pieces are too long.
    failed
        Loops whose response is not resolved or has not come to rest: theirs is not to be used.
    settles
        Whether each is followed until it has settled.
    """

    lengths: Array
    final: Array
    pieces: list[Piece]
    ends: NDArray[np.intp]
    modes: LastModes
    control_modes: LastModes
    unresolved: Flags
    failed: Flags
    settles: bool


def march(
    loops: LoopColumns,
    setpoint: float,
    load: float,
    until: float | None,
    shorter: int = 1,
    *,
    control: bool = False,
) -> Responses:
    """Return the responses of stable loops to steps of set-point and load.

    Parameters
    ----------
    setpoint, load
        Heights of the steps, in the units of the columns.
    until
        Horizon in the unit of the columns; by default each loop is followed until it is at rest.
    shorter
        How many times shorter the pieces are than they usually need to be.
    control
        Whether the control signals are kept.
    """
    chain = build_chain(loops.plant, loops.form, integral=bool(loops.form.ki), derivative=bool(loops.form.kd))
    chain = chain.balanced(np.max(np.abs(loops.gains), axis=1))
    radius = float(np.max(np.abs(np.linalg.eigvals(chain.a)), initial=0.0)) if loops.delay else PACE
    march = _March(loops, chain, setpoint, load, until, control)
    return march.run(shorter * max(1, int(np.ceil(radius / STIFFNESS))))


class _March:
    def __init__(
        self,
        loops: LoopColumns,
        chain: Chain,
        setpoint: float,
        load: float,
        until: float | None,
        control: bool,
    ) -> None:
        self.loops, self.chain, self.setpoint, self.load, self.until = loops, chain, setpoint, load, until
        self.control = control
        self.final, self.final_control = loops.final(setpoint, load)

    def run(self, splits: int) -> Responses:
        """Step through the pieces, of which ``splits`` make a dead time."""
        count, until = len(self.loops), np.inf if self.until is None else self.until
        failed = ~(np.isfinite(self.final_control) & (self.final >= 0.0)) | (
            (self.final == 0.0) & (self.setpoint != 0.0)
        )
        if self.until is not None and self.loops.delay and until * splits > MOST_PIECES:
            failed[:] = True
        state = _Moving(self, splits, np.nonzero(~failed)[0])
        found = Responses(
            np.zeros(0), self.final, [], np.zeros(count, dtype=np.intp), LastModes.none(count), LastModes.none(count),
            np.zeros(count, dtype=bool), failed, self.until is None,
        )  # fmt: skip
        look, ends = FIRST_LOOK, [0.0]
        while state.columns.size and ends[-1] < until * (1.0 - ROUNDED):
            most = MOST_PIECES if state.columns.size < MANY else min(LONGEST, max(MOST_PIECES, MOST_KEPT // count))
            if len(found.pieces) >= most:
                break
            found.pieces.append(state.advance())
            done = len(found.pieces)
            # of equal pieces the ends are multiples: no sum of roundings
            ends.append(done / splits if self.loops.delay else ends[-1] + state.length)
            if not self.loops.delay and done % PATIENCE == 0:
                state.lengthen(found)
            if self.until is not None or done % splits or done <= DEAD_TIMES * splits:
                continue
            leaving = state.at_rest()
            if done // splits >= look and state.alike >= DEAD_TIMES * splits:
                look = int(np.ceil(look * LOOKS))
                modes = state.last_modes(ends[-1])
                modes.found &= ~(leaving | state.left)
                found.modes.put(state.columns, modes, ends[-1])
                leaving |= modes.found
            gone = state.leave(leaving, found)
            if gone.sum() > WORTH * gone.size:
                state.keep(np.nonzero(~gone)[0], found)
        if ends[-1] >= until * (1.0 - ROUNDED):
            state.leave(np.ones(state.columns.size, dtype=bool), found)
        state.keep(np.zeros(0, dtype=np.intp), found)
        if ends[-1] > until:
            found.pieces[-1] = found.pieces[-1].cut((until - ends[-2]) / (ends[-1] - ends[-2]))
            ends[-1] = until
        found.lengths = np.diff(ends)
        if self.control:
            with np.errstate(all="ignore"):
                found.control_modes = found.modes.times(-self.loops.feedback(found.modes.pole))
        return found


class _Moving:
    """The loops that still move: all that the next piece needs, each array with a column for each loop.

    What enters a piece is one array: the plant's input one dead time ago at the nodes, the state, the set-point. Those
    of the pieces of a dead time wait in ``entering``; as soon as one has been used, its rows of the plant's input are
    overwritten with those that leave. Pieces are ``longer`` than at first by this factor, the last ``alike`` of them.
    """

    def __init__(self, march: _March, splits: int, columns: Places) -> None:
        chain = march.chain
        self.march, self.splits, self.columns = march, splits, columns
        self.loops = march.loops.take(columns)
        self.law: PieceLaw | ClosedLaw = (PieceLaw if self.loops.delay else ClosedLaw).of(
            self.loops, chain, 1.0 / splits, march.setpoint, march.load
        )
        self.search = ModeSearch(self.loops, march.setpoint, march.load)
        self.count, self.alike, self.longer = 0, 0, 1.0
        self.state = self.law.begun(np.repeat(chain.start[:, None] * march.setpoint, columns.size, axis=1))
        self.entering = deque(np.zeros((POINTS + chain.e.size + 1, columns.size)) for _ in range(splits))
        for inputs in self.entering:
            inputs[-1] = march.setpoint
        self.recent: deque[Array] = deque(maxlen=DEAD_TIMES * splits)
        self.impulse = self.law.gains[3] * chain.setpoint_impulse * march.setpoint
        self.size, self.input_size, self.tail = (np.zeros(columns.size) for _ in range(3))
        self.left = np.zeros(columns.size, dtype=bool)
        self.room: list[Array] = []

    @property
    def length(self) -> float:
        """Length of the next piece."""
        return self.longer / self.splits

    def advance(self) -> Piece:
        """Compute the next piece."""
        march, chain, inputs = self.march, self.march.chain, self.entering.popleft()
        if self.count >= self.splits and self.count % self.splits == 0 and self.impulse.any():
            self.state += chain.b * self.impulse
            self.impulse = self.impulse * self.law.gains[3] * chain.wv[3, 0]
        self.count, self.alike = self.count + 1, self.alike + 1
        inputs[POINTS:-1] = self.state
        v, values = inputs[:POINTS], self._room()
        self.state, area, tail = self.law.apply(inputs, v, values)
        self.entering.append(inputs)
        control = v - march.load if march.control else None
        piece = Piece(self.columns, values, values.min(axis=0), values.max(axis=0), area, control)
        self.recent.append(values)
        np.maximum(self.size, np.maximum(piece.high, -piece.low), out=self.size)
        np.maximum(self.input_size, np.abs(v[::SPARSE]).max(axis=0), out=self.input_size)
        np.maximum(self.tail, np.abs(tail).max(axis=0), out=self.tail)
        return piece

    def _room(self) -> Array:
        """Return room for the values of a piece."""
        if not self.room:
            self.room = list(np.empty((AT_ONCE, POINTS, self.columns.size)))
        return self.room.pop()

    def lengthen(self, found: Responses) -> None:
        """Make pieces twice as long if that does for enough of the loops; the others are not resolved."""
        assert isinstance(self.law, ClosedLaw)  # noqa: S101  -- with dead time its pieces are what they are
        law = self.law.doubled()
        resolved = law.resolves(self.state) | self.left
        if resolved.mean() >= (1.0 if self.march.until is None else ENOUGH):
            self.law, self.longer, self.alike = law, 2.0 * self.longer, 0
            self.tail[~resolved] = np.inf
            self.keep(np.nonzero(resolved & ~self.left)[0], found)

    def at_rest(self) -> Flags:
        """Return which loops deviate no more, as seen over the last dead time, in output and in the plant's input."""
        # the slower the mode that is left, the more a deviation adds to integrals over time, and to their moments
        limit = AT_REST / self.longer**2 * self.size
        resting = np.abs(self.recent[-1][-1]) <= limit
        places = np.nonzero(resting)[0]
        if places.size:
            final = self.march.final_control[self.columns[places]] + self.march.load
            quiet = np.ones(places.size, dtype=bool)
            for values in list(self.recent)[-self.splits :]:
                quiet &= np.abs(values[:, places]).max(axis=0) <= limit[places]
            for inputs in self.entering:
                quiet &= np.abs(inputs[:POINTS, places] - final).max(axis=0) <= AT_REST * self.input_size[places]
            resting[places] = quiet
        return np.asarray(resting)

    def last_modes(self, elapsed: float) -> LastModes:
        return self.search.look(list(self.recent), elapsed, self.size, unit=self.longer, control=self.march.control)

    def leave(self, leaving: Flags, found: Responses) -> Flags:
        """Note which loops leave now; return all that have left but still move along."""
        newly = leaving & ~self.left
        found.ends[self.columns[newly]] = self.count
        self.left |= newly
        return self.left

    def keep(self, stay: Places, found: Responses) -> None:
        """Drop all loops but some; those dropped that never left, or are not resolved, have failed."""
        with np.errstate(invalid="ignore"):
            unresolved = ~(self.tail <= RESOLVED * self.input_size)
        unusable = ~self.left | unresolved
        unusable[stay] = unresolved[stay] = False
        found.unresolved[self.columns[unresolved]] = True
        found.failed[self.columns[unusable]] = True
        self.columns, self.search, self.law = self.columns[stay], self.search.take(stay), self.law.take(stay)
        for name in ("impulse", "size", "input_size", "tail", "left"):
            setattr(self, name, getattr(self, name)[stay])
        self.state, self.room = self.state.take(stay, axis=1), []
        self.entering = deque(inputs.take(stay, axis=1) for inputs in self.entering)
        self.recent = deque((values.take(stay, axis=1) for values in self.recent), maxlen=DEAD_TIMES * self.splits)


def _restriction(share: float) -> Array:
    """Return the matrix from the values of a piece to those of its first part, at the nodes of the part."""
    x = -1.0 + share * (chebyshev.nodes(DEGREE) + 1.0)
    return np.asarray(chebyshev.basis(x, DEGREE).T @ chebyshev.values_to_coefficients(DEGREE))

"""All exceptions of the numerical core.

LoopError(ValueError)
├── ImproperLoopError      the loop contains a pure differentiator without a causal solution
├── UnstableLoopError      a quantity was asked for that only a stable loop has
├── NotSettledError        the response has not settled inside its horizon
├── NotationError          a text is not a plant or controller
└── TuningRuleError        a tuning rule is incomplete, cannot be read, or lacks a parameter

A design that finds no controller is not an error: it returns a result whose status says so.
"""

from __future__ import annotations


class LoopError(ValueError):
    """Base of every error of the numerical core."""


class ImproperLoopError(LoopError):
    """The loop gain does not stay below one at high frequency, or is not defined there."""


class UnstableLoopError(LoopError):
    """A quantity was asked for that only a stable loop has."""


class NotSettledError(LoopError):
    """The response has not settled, or not reached the level asked for, inside its horizon."""


class TuningRuleError(LoopError):
    """A tuning rule is incomplete, cannot be read, or lacks a parameter."""


_AROUND = 100  # characters that are quoted on either side of a column


class NotationError(LoopError):
    """A text that should name a plant or a controller does not; the message names the column.

    Attributes
    ----------
    text : str
        The whole text.
    column : int
        Where it stops making sense, from 1.
    reason : str
        What is wrong there, and what is allowed.
    """

    def __init__(self, what: str, text: str, column: int, reason: str) -> None:
        super().__init__(what, text, column, reason)
        self.text = text
        self.column = column
        self.reason = reason

    def __str__(self) -> str:
        what, text, column, reason = self.args
        first, last = max(0, column - 1 - _AROUND), column + _AROUND
        if first + len(text[last:]) <= len("……"):  # shortening would not make it shorter
            first, last = 0, len(text)
        quoted = "…" * (first > 0) + text[first:last] + "…" * (last < len(text))
        return f"{what} '{''.join(' ' if c.isspace() else c for c in quoted)}', column {column}: {reason}"

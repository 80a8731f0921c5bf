"""One figure compared with its accepted state, or accepted: what became of it."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

from replicate.baselines.store import Store
from replicate.errors import FigureError, FigureRecordError, ReplicateError
from replicate.figures import Record, compare

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Status = Literal["same", "changed", "new", "gone", "accepted", "failed", "not drawn"]

#: Statuses that an author has to look at; a failed one is not a difference but a broken run.
DIFFERS = {"changed", "new", "gone"}

_RENEWED = "is written in the present format, which says more"
_UNREADABLE = "replaces a state that could not be read"
_PICTURE_DPI = 60
_MOST_INCHES = 100.0  # each way: of a larger figure there is no picture
_COLOURS = 64


@dataclass(frozen=True)
class Outcome:
    """What became of one figure.

    Attributes
    ----------
    name
        Of the figure.
    where
        The test or the script that draws it, as one writes it on the command line.
    changes
        In words; what was wrong, if it failed.
    layers
        Who noticed each change: ``named`` or ``net``.
    size
        How far the curve that moved most did, as a fraction of its axes.
    digest
        Of the accepted state it was compared with.
    accepted, new
        Small pictures, PNG, in base64.
    """

    name: str
    status: Status
    where: str = ""
    changes: Sequence[str] = ()
    layers: Sequence[str] = ()
    size: float = 0.0
    digest: str = ""
    accepted: str = ""
    new: str = ""

    @property
    def differs(self) -> bool:
        """Whether there is something to look at and to accept."""
        return self.status in DIFFERS

    def to_dict(self) -> dict[str, Any]:
        """Return plain data, for another process."""
        return asdict(self)


@dataclass(frozen=True)
class Drawn:
    """A figure that was drawn: its record as JSON and a small picture."""

    record: str
    picture: bytes


def draw(figure: Figure) -> Drawn:
    """Record a figure and draw its picture.

    Raises
    ------
    FigureError
        If it is none, or nothing is drawn on it.
    """
    from replicate.figures import capture

    record = capture(figure)
    if not record.panels and len(record.figure.get("parts", ())) <= 1:
        msg = "nothing is drawn on the figure: was it cleared, or closed too early?"
        raise FigureError(msg)
    return Drawn(record.to_json(), _small_picture(figure))


def compared(store: Store, name: str, drawn: Drawn, where: str = "") -> Outcome:
    """Compare a figure with its accepted state."""
    from base64 import b64encode

    new = b64encode(drawn.picture).decode()
    try:
        accepted = store.read(name)
        if accepted is None:
            said = [f"has no accepted state: {store.folder.name}/{name}.json is missing"]
            return Outcome(name, "new", where, said, ["named"], new=new)
        found = compare(accepted.record, Record.from_json(drawn.record))
    except FigureRecordError as error:
        return Outcome(name, "failed", where, [error.why], ["named"], new=new)
    if not found.changes:
        return Outcome(name, "same", where, digest=accepted.digest)
    size = max((part.size or 0.0 for part in found.differences), default=0.0)
    layers = [part.layer for part in found.differences]
    picture = b64encode(accepted.picture).decode()
    return Outcome(name, "changed", where, found.changes, layers, min(size, 9.99), accepted.digest, picture, new)


def accept(store: Store, outcome: Outcome, drawn: Drawn | None, reason: str, replaces: str | None = None) -> Outcome:
    """Make the new state of a figure the accepted one; one that is as accepted keeps its files.

    Unless an earlier release wrote them, whose records cannot say all that is compared now.

    Parameters
    ----------
    drawn
        ``None`` for a figure that is not drawn any more.
    replaces
        The digest of the accepted state that its author looked at; by default any.

    Raises
    ------
    ReplicateError
        If another state is accepted by now, or there is no reason.
    OutputError
        If the folder cannot be written.
    """
    reason = " ".join(reason.split())
    if not reason:
        msg = "accepting needs a reason: --reason 'why the new state is right'"
        raise ReplicateError(msg)
    if replaces is not None and replaces != store.digest(outcome.name):
        there = store.digest(outcome.name) or "none"
        msg = (
            f"figure '{outcome.name}' is not accepted: its author looked at the difference from state "
            f"{replaces or 'none'}, but the accepted state is {there} now; look at the new difference first"
        )
        raise ReplicateError(msg)
    if outcome.status == "same":
        accepted = store.read(outcome.name)
        if drawn is None or accepted is None or not accepted.record.outdated:
            return outcome
        outcome = replace(outcome, status="changed", changes=[_RENEWED], layers=["named"])
    if drawn is None:
        store.remove(outcome.name, reason)
    else:
        # What could not be read is said with its path, which is another one on each machine.
        changes = [_UNREADABLE] if outcome.status == "failed" else outcome.changes
        store.write(outcome.name, drawn.record, drawn.picture, reason, changes)
    return Outcome(outcome.name, "accepted", outcome.where, outcome.changes, outcome.layers)


def _small_picture(figure: Figure) -> bytes:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from PIL import Image

    large, small = io.BytesIO(), io.BytesIO()
    if max(figure.get_size_inches()) > _MOST_INCHES:
        return b""
    canvas, face = figure.canvas, figure.get_facecolor()
    FigureCanvasAgg(figure)  # makes itself the figure's: what is drawn on the other one may still be read
    try:
        figure.savefig(large, format="png", dpi=_PICTURE_DPI, facecolor=face, metadata={"Software": None})
    finally:
        figure.set_canvas(canvas)
    with Image.open(large) as picture:
        few = picture.convert("RGB").quantize(_COLOURS, dither=Image.Dither.NONE)
    few.save(small, format="png", optimize=True)
    return small.getvalue()

"""One block of a sweep: computed, and written as the bytes of a CSV or Parquet file."""

from __future__ import annotations

import io
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from replicate.errors import OutputError
from replicate.loops.sweep import sweep as compute
from replicate.loops.sweep.sweep_result import GRID
from replicate.sweeps.sweep_file import Block, SweepFile, as_axis

if TYPE_CHECKING:
    import pandas as pd

FORMATS = ("csv", "parquet")
#: As in results.csv.
_DIGITS = "%.12g"


def checked_format(name: str) -> str:
    """Return the name of a format.

    Raises
    ------
    OutputError
        If it is unknown, or what writes it is not installed.
    """
    if name not in FORMATS:
        msg = f"the format must be {' or '.join(FORMATS)}, not {name!r}"
        raise OutputError(msg)
    if name == "parquet" and find_spec("pyarrow") is None:
        msg = "Parquet needs pyarrow, which is not installed: pip install 'paper-replicate[parquet]', or --format csv"
        raise OutputError(msg)
    return name


def file_name(block: Block, file_format: str) -> str:
    """Return the name of a block's file; names sort as the blocks do."""
    return f"block-{block.number:06d}.{file_format}"


def rows_of(sweep: SweepFile, block: Block) -> int:
    """Return the number of loops in a block."""
    plants, controllers = block.plants[1] - block.plants[0], block.controllers[1] - block.controllers[0]
    return plants * controllers if sweep.pairing == GRID else plants


def compute_block(sweep: SweepFile, block: Block, file_format: str) -> bytes:
    """Return the file of one block: a row for each loop, its plant and controller, metrics, ``stable``, ``reason``."""
    frame = _frame(sweep, block)
    if file_format == "csv":
        text: str = frame.to_csv(index=False, float_format=_DIGITS, lineterminator="\n")
        return text.encode()
    buffer = io.BytesIO()
    frame.to_parquet(buffer, index=False, engine="pyarrow")
    return buffer.getvalue()


def rows_in(path: Path) -> int:
    """Return the number of rows in a block's file; -1 if it is damaged."""
    if path.suffix == ".csv":
        content = path.read_bytes()
        return content.count(b"\n") - 1 if content.endswith(b"\n") else -1
    try:
        return int(import_module("pyarrow.parquet").read_metadata(path).num_rows)
    except Exception:  # noqa: BLE001  -- whatever the library says of a damaged file
        return -1


def _frame(sweep: SweepFile, block: Block) -> pd.DataFrame:
    import numpy as np
    import pandas as pd

    plants, controllers = sweep.plants.members(*block.plants), sweep.controllers.members(*block.controllers)
    found = compute(
        as_axis(plants),
        as_axis(controllers),
        metrics=sweep.metrics,
        until=sweep.until,
        pairing=sweep.pairing,
        band=sweep.band,
    )
    high, wide = block.plants[1] - block.plants[0], block.controllers[1] - block.controllers[0]
    columns: dict[str, Any] = {}
    for members, each, times in ((plants, wide, 1), (controllers, 1, high)):
        for name, values in members.items():
            array = np.array(values, dtype=object if isinstance(values[0], str) else float)
            columns[name] = np.tile(np.repeat(array, each), times) if sweep.pairing == GRID else array
    for name in dict.fromkeys((*sweep.metrics, "stable")):
        result = found[name].ravel()
        if np.iscomplexobj(result):
            columns |= {f"{name}_re": result.real, f"{name}_im": result.imag}
        else:
            columns[name] = result
    return pd.DataFrame({**columns, "reason": found.reason.ravel().astype(str)})

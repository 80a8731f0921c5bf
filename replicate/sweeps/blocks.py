"""One block of a sweep: computed, and written as the bytes of a CSV or Parquet file."""

from __future__ import annotations

import io
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from replicate.errors import OutputError
from replicate.loops.sweep import sweep as compute
from replicate.loops.sweep.sweep_result import GRID
from replicate.sweeps.sweep_file import Block, SweepFile, as_axis

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

FORMATS = ("csv", "parquet")
#: As in results.csv.
_DIGITS = "%.12g"
_LOST = 1e-11  # what they leave of a number is nearer than that to it


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


def is_kept(path: Path, sweep: SweepFile, block: Block) -> bool:
    """Say whether a file is this block, whole: as many rows, and in each its plant and its controller."""
    import numpy as np
    import pandas as pd

    expected = _inputs(sweep, block)
    try:
        if path.suffix == ".csv":
            content = path.read_bytes()
            if not content.endswith(b"\n"):
                return False
            kinds = {name: values.dtype for name, values in expected.items()}  # "0.5" may be the text of a plant
            there = pd.read_csv(io.BytesIO(content), usecols=list(kinds), dtype=kinds)
        else:
            there = pd.read_parquet(path, columns=list(expected), engine="pyarrow")
        return all(
            np.array_equal(there[name], values)
            if values.dtype == object
            else there[name].shape == values.shape and np.allclose(there[name], values, rtol=_LOST, atol=0.0)
            for name, values in expected.items()
        )
    except Exception:  # noqa: BLE001  -- whatever the libraries say of a damaged file
        return False


def _inputs(sweep: SweepFile, block: Block) -> dict[str, NDArray[Any]]:
    """Return the plants and controllers of a block, a value for each row by column."""
    import numpy as np

    high, wide = block.plants[1] - block.plants[0], block.controllers[1] - block.controllers[0]
    plants, controllers = sweep.plants.members(*block.plants), sweep.controllers.members(*block.controllers)
    columns: dict[str, NDArray[Any]] = {}
    for members, each, times in ((plants, wide, 1), (controllers, 1, high)):
        for name, values in members.items():
            array = np.array(values, dtype=object if isinstance(values[0], str) else float)
            columns[name] = np.tile(np.repeat(array, each), times) if sweep.pairing == GRID else array
    return columns


def _frame(sweep: SweepFile, block: Block) -> pd.DataFrame:
    import numpy as np
    import pandas as pd

    found = compute(
        as_axis(sweep.plants.members(*block.plants)),
        as_axis(sweep.controllers.members(*block.controllers)),
        metrics=sweep.metrics,
        until=sweep.until,
        pairing=sweep.pairing,
        band=sweep.band,
    )
    columns: dict[str, Any] = dict(_inputs(sweep, block))
    for name in dict.fromkeys((*sweep.metrics, "stable")):
        result = found[name].ravel()
        if np.iscomplexobj(result):
            columns |= {f"{name}_re": result.real, f"{name}_im": result.imag}
        else:
            columns[name] = result
    return pd.DataFrame({**columns, "reason": found.reason.ravel().astype(str)})

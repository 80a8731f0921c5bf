"""Images and meshes as arrays: their shape, extent and colours, a digest, and the means of blocks for the words."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.collections import Collection, QuadMesh
from matplotlib.colors import BoundaryNorm
from matplotlib.contour import ContourSet
from matplotlib.image import AxesImage, _ImageBase

from replicate.figures.digests import Array, rounded, sign_sums

_MOST = 400
_BLOCKS = 12
_LUT = 9
_STEPS = 41
#: Scales of colours that the limits determine.
_PLAIN = {"Normalize", "LogNorm", "NoNorm"}


def read_field(artist: Any) -> dict[str, Any]:
    """Return what is known of the values that an artist shows in colours; empty if it does not.

    Returns
    -------
    dict
        ``shape``, ``limits`` (of the colours), ``map`` (name and some of its colours), ``scale`` (of the colours),
        ``extent`` and ``interpolation`` of an image; ``values``, all of them or, if they are many, the means of
        blocks with ``rows`` and ``columns`` of blocks, all as fractions of the range of the colours; ``signs``, the
        sums of all under fixed signs.
    """
    if not isinstance(artist, _ImageBase | Collection) or isinstance(artist, ContourSet):
        return {}
    array = artist.get_array()
    if array is None:
        return {}
    values: Array = np.ma.filled(np.ma.asarray(array, dtype=float), np.nan)
    if values.ndim == 3 and values.shape[2] == 4 and np.all(values[..., 3] == (255.0 if values.max() > 1.0 else 1.0)):
        values = values[..., :3]  # opaque
    found: dict[str, Any] = {"shape": list(values.shape)}
    if isinstance(artist.get_alpha(), float):
        found["alpha"] = float(f"{artist.get_alpha():.4g}")
    elif isinstance(artist.get_alpha(), np.ndarray):
        opacities = np.atleast_2d(np.asarray(artist.get_alpha(), dtype=float))
        found["opacities"] = [rounded(row, 4) for row in _plain(_blocks(opacities))]
    if isinstance(artist, AxesImage):
        found["extent"] = [float(f"{float(end):.9g}") for end in artist.get_extent()]
    if isinstance(artist, _ImageBase):
        found["interpolation"] = str(artist.get_interpolation()).replace("antialiased", "auto")  # its name until 3.9
        found["origin"] = str(artist.origin)
    if values.ndim == 3 and not isinstance(artist, QuadMesh):  # colours, not values
        scaled = values / 255.0 if np.nanmax(values, initial=0.0) > 1.0 else values
    else:
        low, high = (float(end) for end in artist.get_clim())
        span = high - low
        found["limits"] = [float(f"{low:.9g}"), float(f"{high:.9g}")]
        found |= _colours(artist)
        scaled = (values - low) / span if span else values - low
    if scaled.ndim == 1:
        scaled = scaled[:, None]
    grid = scaled.mean(axis=2) if scaled.ndim == 3 else scaled
    if grid.size <= _MOST and scaled.ndim < 3:
        found["values"] = [rounded(row, 6) for row in _plain(grid)]
    else:
        found["values"] = [rounded(row, 5) for row in _plain(_blocks(grid))]
    found["signs"] = rounded(sign_sums(scaled), 8)
    hidden = int(np.isnan(values).sum())
    return found | ({"masked": hidden} if hidden else {})


def _plain(grid: Array) -> Array:
    return np.nan_to_num(grid, nan=-9.0, posinf=9.0, neginf=-9.0)


def _blocks(grid: Array) -> Array:
    """Return the means of blocks; a block in which nothing is shown has none."""
    rows = np.array_split(grid, min(_BLOCKS, grid.shape[0]), axis=0)
    cells = [np.array_split(row, min(_BLOCKS, row.shape[1]), axis=1) for row in rows]
    return np.array(
        [[block[np.isfinite(block)].mean() if np.isfinite(block).any() else np.nan for block in row] for row in cells]
    )


def _colours(artist: ScalarMappable) -> dict[str, Any]:
    from replicate.figures.marks import hexed

    cmap = artist.get_cmap()
    colours = [hexed(np.asarray(cmap(float(share)))) for share in np.linspace(0.0, 1.0, _LUT)]
    ends = [hexed(np.asarray(colour)) for colour in (cmap.get_under(), cmap.get_over(), cmap.get_bad())]
    found: dict[str, Any] = {"map": [str(cmap.name), *colours, *ends], "scale": type(artist.norm).__name__}
    if found["scale"] in _PLAIN:
        return found
    low, high = (float(end) for end in artist.get_clim())
    shares: Array = np.ma.filled(np.ma.asarray(artist.norm(np.linspace(low, high, _STEPS)), dtype=float), -9.0)
    if isinstance(artist.norm, BoundaryNorm):  # it counts colours
        shares = shares / cmap.N
    return found | {"steps": rounded(shares, 4)}

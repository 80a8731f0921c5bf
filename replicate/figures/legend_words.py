"""What is said of a legend: apart from what reads it, so that comparing two records does not load matplotlib."""

from __future__ import annotations

#: What a legend always says, since another default may be set: sizes in units of its letters.
LEGEND_SIZES = {
    "handlelength": "length of the handles",
    "handleheight": "height of the handles",
    "handletextpad": "distance between handles and words",
    "borderpad": "distance between frame and entries",
    "borderaxespad": "distance to the axes",
    "columnspacing": "distance between columns",
    "numpoints": "number of markers on each line",
    "scatterpoints": "number of markers for each set of points",
}
HANDLES = "place of the handles"
OUTSIDE = "place outside the axes"

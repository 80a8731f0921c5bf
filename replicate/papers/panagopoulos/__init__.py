"""Panagopoulos' thesis on PI and PID design: six papers and a supplement, one sub-package a part.

Each part keeps its own list of plants, because the papers use the same letters for different plants, and names its
modules and its numbered exhibits; ids carry the part (``I-table-1``, ``IIs-table-2``).
"""

from replicate.exhibits import Paper
from replicate.papers.panagopoulos import introduction, part_1, part_2, parts_3_to_6

_PARTS = (introduction, part_1, part_2, parts_3_to_6)

paper = Paper(
    id="panagopoulos",
    package=__name__,
    title="PID Control: Design, Extension, Application",
    authors=("Hélène Panagopoulos",),
    citation="H. Panagopoulos, PID Control: Design, Extension, Application. Doctoral thesis, Department of Automatic "
    "Control, Lund Institute of Technology, 2000 (ISRN LUTFD2/TFRT-1059--SE).",
    year=2000,
    summary="Six papers and a supplement on designing PI and PID controllers from a bound on the sensitivity, and on "
    "using them. The design method holds: the PI gains are reproduced to the last digit, and so are most of the PID "
    "gains of the corrected table. What was measured on the finished loops follows definitions other than those in the "
    "text, and a few designs are not the optima they claim to be.",
    modules=tuple(f"{part.__name__.rpartition('.')[2]}.{module}" for part in _PARTS for module in part.MODULES),
    numbered=tuple(exhibit for part in _PARTS for exhibit in part.NUMBERED),
)

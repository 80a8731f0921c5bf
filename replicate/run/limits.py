"""How much a run may take, in time and in space."""

from __future__ import annotations

#: Seconds after which a unit (a reading, a figure, one claim) is stopped, unless told otherwise.
UNIT_TIMEOUT = 900.0

#: Seconds that importing a paper may take.
IMPORT_TIMEOUT = 60.0

#: Seconds that a chart may take.
CHART_TIMEOUT = 300.0

#: Bytes that a unit may write to standard output and error.
MOST_OUTPUT = 100 * 2**20

#: Bytes of results that are kept; beyond it, those that have not been used for longest are removed.
MOST_KEPT = 2**30

"""A page in which printed tuning parameters come alive: exact dead-time loops in the browser, in one file."""

from replicate.whatif.page import DISTRIBUTIONS, NAME, ROOMS, whatif_page, write_whatif
from replicate.whatif.rows import Row, rows_of, unreadable_loops

__all__ = ["DISTRIBUTIONS", "NAME", "ROOMS", "Row", "rows_of", "unreadable_loops", "whatif_page", "write_whatif"]

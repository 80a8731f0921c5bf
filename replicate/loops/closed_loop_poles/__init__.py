"""Closed-loop poles of loops with dead time: found, polished and proven."""

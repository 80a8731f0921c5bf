"""Interval arithmetic: what is certain of all gains in a box."""

"""Exact responses in time: the method of steps, its pieces, and what is read from a response."""

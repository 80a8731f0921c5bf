"""Hypothesis tries the same examples in every run: a test that passes today passes tomorrow."""

from __future__ import annotations

from hypothesis import settings

settings.register_profile("reproducible", max_examples=25, derandomize=True, deadline=None)
settings.load_profile("reproducible")

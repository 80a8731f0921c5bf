"""Loops with a Smith predictor."""

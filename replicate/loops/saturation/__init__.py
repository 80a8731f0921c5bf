"""Responses whose control signal has limits, from event to event."""

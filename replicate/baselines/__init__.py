"""Accepted figures of any repository: kept beside its tests or scripts, compared in words, accepted with a reason.

The pytest plugin, ``replicate figures`` and the GitHub Action stand on this; nothing here knows a paper.
"""

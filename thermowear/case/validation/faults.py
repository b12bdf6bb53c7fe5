"""Faults found by the consistency checks."""

Fault = tuple[str, str]
"""Path of the key at fault, and the message."""

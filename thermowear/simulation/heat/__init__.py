"""Friction heat: steady, transient, and with temperature-dependent properties."""

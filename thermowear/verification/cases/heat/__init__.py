"""Friction heat and temperature-dependent properties, steady and in time."""

"""Friction heat: steady, in time, and with properties that vary."""

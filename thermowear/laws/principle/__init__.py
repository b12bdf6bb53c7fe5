"""Principle of minimum wear dissipation power: steady pressure, solvability, functionals."""

"""Steady state: special cases, minimum principle, running-in to it."""

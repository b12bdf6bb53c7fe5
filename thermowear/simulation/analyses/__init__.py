"""Analyses that a case can ask for."""

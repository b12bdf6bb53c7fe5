"""Analyses of a model, and checks of their results."""

"""Mesh motion and remeshing of worn bodies."""

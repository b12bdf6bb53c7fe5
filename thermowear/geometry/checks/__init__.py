"""Checks of meshes: cells, names, and the position of the bodies."""

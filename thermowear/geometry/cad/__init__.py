"""Designed shapes as worn bodies, meshes and STEP files."""

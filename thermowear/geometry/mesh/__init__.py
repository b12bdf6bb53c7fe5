"""Meshes with named bodies and surfaces, and their Lagrange nodes."""

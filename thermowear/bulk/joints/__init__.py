"""Joints of glued bodies: weak continuity across them, and solvers of bodies joined by them."""

"""Structured meshing: blocks, rings, outlines, graded element ends."""

"""Structured meshing: blocks, rings, outlines, graded ends."""

"""Structured meshing: graded divisions, blocks, rings."""

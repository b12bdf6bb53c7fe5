"""Solvers of unilateral contact on condensed operators."""

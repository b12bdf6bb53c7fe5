"""Analyses selected by ``analysis.type`` of a case."""

"""Closed forms and reference solutions for verification, each with its source."""

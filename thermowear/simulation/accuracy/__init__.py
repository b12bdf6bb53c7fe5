"""Estimates of the discretisation error."""

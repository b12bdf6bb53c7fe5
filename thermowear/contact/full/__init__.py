"""Penalty and Nitsche contact on the full finite-element system."""

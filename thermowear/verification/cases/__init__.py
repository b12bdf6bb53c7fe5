"""Verification cases by subject."""

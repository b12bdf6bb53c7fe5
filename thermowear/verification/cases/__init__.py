"""Verification cases, one file each."""

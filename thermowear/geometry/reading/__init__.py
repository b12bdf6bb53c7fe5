"""Mesh files: reading, checking, writing."""

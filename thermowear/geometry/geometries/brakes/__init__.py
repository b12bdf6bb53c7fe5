"""Disk brakes, in a half section and in space."""

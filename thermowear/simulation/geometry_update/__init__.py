"""Outer loop over the worn geometry: mesh motion, remeshing, wear kept in the gap."""

"""Wear at the interface: worn faces, tracks, edges of the wear."""

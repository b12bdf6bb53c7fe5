"""Wear at the interface: worn faces, wear tracks, edges of the worn zone."""

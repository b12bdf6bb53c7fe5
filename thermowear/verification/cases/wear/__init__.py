"""Wear of growing contacts, with geometry updates, and of a beam over a gap."""

"""Oscillating contacts: fretting and reciprocating sliding."""

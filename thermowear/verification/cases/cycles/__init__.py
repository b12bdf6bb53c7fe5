"""Fretting and reciprocating sliding."""

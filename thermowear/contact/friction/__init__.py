"""Coulomb friction with stick and slip, and wear by slip."""

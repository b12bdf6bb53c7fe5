"""Glued interfaces: pairs of points as in contact, with equalities in place of inequalities."""

"""Checks between the tables of a case, and comparison of cases."""

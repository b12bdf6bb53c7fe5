"""Coefficients of the interface: constant, tabulated, proportional to the pressure."""

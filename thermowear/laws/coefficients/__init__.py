"""Coefficients of the interface: constant, tabulated, in proportion to the pressure."""

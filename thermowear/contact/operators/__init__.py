"""Operators of the interface: traces, pressure space, condensation, heat exchange."""

"""System of bodies and interface, the input of all analyses."""

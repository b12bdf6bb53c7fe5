"""System of bodies and interface that an analysis works on."""

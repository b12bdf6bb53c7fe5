"""Values of fields at points of the bodies."""

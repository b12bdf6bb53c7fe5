"""Heat conduction in the bodies."""

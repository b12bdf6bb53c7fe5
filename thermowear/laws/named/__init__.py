"""Laws selected by name in a case file, one per module."""

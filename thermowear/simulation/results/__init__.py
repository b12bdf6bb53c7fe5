"""Results of an analysis."""

"""Studies: propagation of uncertain inputs of a case, and the sensitivity of its results."""

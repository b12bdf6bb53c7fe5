"""Results of many variants of a case: folder, journal and table that sweeps and studies share."""

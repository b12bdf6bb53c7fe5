"""Values of a case file: units, paths, columns of CSV files, bounds."""

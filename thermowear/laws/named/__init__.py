"""Laws that a case file names, one a module."""

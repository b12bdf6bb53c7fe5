"""Calibration: parameters of a case that fit measurements, by runs of the case."""

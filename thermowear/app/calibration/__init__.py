"""Calibration: parameters of a case from measured data."""

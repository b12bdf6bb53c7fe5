"""Inference from measurements and sensitivity analysis, against closed forms."""

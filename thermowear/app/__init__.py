"""Command line and entry points: run, sweep, shape, verify."""

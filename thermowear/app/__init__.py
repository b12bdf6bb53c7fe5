"""Commands and entry points: run, sweep, shape, verify."""

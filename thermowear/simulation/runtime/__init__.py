"""Observers, checkpoints, animation frames and stop requests of a run."""

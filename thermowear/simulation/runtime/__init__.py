"""Observers, checkpoints, frames and requests to stop of a run."""

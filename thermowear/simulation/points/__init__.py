"""Points of contact faces and of probes, and the gap between unworn and worn faces."""

"""Batches of variants of a case: groups, executors, and their computation."""

"""Selection of the states that are kept as animation frames.

An error-controlled loop takes short steps where the state changes fast, so step numbers are a
better clock than time. Their total is not known in advance: all steps are kept until there are too
many, then every second, then every fourth. The computation does not depend on frames.
"""

from __future__ import annotations


def spacing(number: int, most: int) -> int:
    """Smallest power of two with at most `most` multiples from 0 to a number."""
    every = 1
    while number // every >= most:
        every *= 2
    return every

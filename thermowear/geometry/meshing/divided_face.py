"""Division of a straight contact face whose contact zone may end inside it."""

from __future__ import annotations

from .blocks import Interval, graded_face, growing_from_both, smallest

_APART = 1e-6
"""Least distance of a contact edge from the edge of the face, relative to its farthest end."""


def divided_face(
    start: float, end: float, elements: int, grading: float, zone: tuple[float, float] | None
) -> list[Interval]:
    """Grade a face towards its edges, or towards those of a contact zone inside it.

    Parameters
    ----------
    start, end : float
        Ends of the face [m].
    elements, grading
        Number of elements and grading in the contact, see `thermowear.case.tables.schema.Mesh`.
    zone : tuple of float, optional
        Contact zone [m].
    """
    if zone is None:
        return graded_face(start, end, elements, grading)
    first, last = max(zone[0], start), min(zone[1], end)
    face = graded_face(first, last, elements, grading)
    size, largest = smallest(face), (last - first) / elements
    apart = _APART * max(abs(start), abs(end))
    if first - start > apart:
        face = growing_from_both(start, first, (size, size), grading, largest) + face
    if end - last > apart:
        face = face + growing_from_both(last, end, (size, size), grading, largest)
    return face

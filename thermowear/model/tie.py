"""Glued interface of two bodies."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Tie:
    """Two faces that are glued: continuous displacement and temperature, on any meshes.

    Attributes
    ----------
    faces : tuple of str
        Surfaces of two bodies.
    bodies : tuple of int
        Indices of these bodies in the model.
    name : str
        Name for results and messages.
    conductance : float or None
        Conductance of the joint; None: continuous temperature [W/(m² K)].
    """

    faces: tuple[str, str]
    bodies: tuple[int, int]
    name: str = ""
    conductance: float | None = None


def glued_bodies(count: int, ties: Iterable[Tie]) -> list[tuple[int, ...]]:
    """Groups of bodies that are glued to each other, by index; single bodies are groups too."""
    group = list(range(count))
    for tie in ties:
        one, other = (group[body] for body in tie.bodies)
        group = [one if label == other else label for label in group]
    labels = dict.fromkeys(group)
    return [tuple(k for k in range(count) if group[k] == label) for label in labels]


def with_glued(bodies: Sequence[int], groups: Iterable[tuple[int, ...]]) -> tuple[int, ...]:
    """Bodies with all those that are glued to them."""
    found = [body for group in groups if set(group) & set(bodies) for body in group]
    return tuple(sorted(found))

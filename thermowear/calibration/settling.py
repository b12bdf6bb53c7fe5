"""Further measurements that would determine what the present ones do not."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..inference import Identifiability, ParameterSpace, settling
from ..inference.fit import steps_within
from ..results.quantity import split_key
from ..results.summary_keys import GROUPS
from .case_model import CaseModel

_GROUPS = ("Loads and forces", "Pressure and contact", "Wear", "Heat and energy")
_NOT_MEASURED = ("error", "balance", "dissipation", "distance_from", "rigid_wear", "min_pressure")
_WORTH = 0.02
"""Least relative change along the undetermined direction, per unit of its largest part."""
_MOST = 3
_SMOOTH = 0.3
"""Largest relative difference of forward and backward derivatives: else a number is rounding."""


@dataclass(frozen=True)
class Suggestion:
    """Measurement that would settle an undetermined direction.

    Attributes
    ----------
    text : str
    change : float
        Relative change of the measured values along the direction, per unit of the internal
        coordinate that changes most.
    """

    text: str
    change: float


def suggestions(
    space: ParameterSpace, model: CaseModel, values: np.ndarray, found: Identifiability
) -> tuple[Suggestion, ...]:
    """Other quantities of the same runs, and the same ones under other conditions.

    Parameters
    ----------
    space : ParameterSpace
    model : CaseModel
    values : ndarray, shape (p,)
        Values of the parameters.
    found : Identifiability
        Directions that the present measurements do not determine.
    """
    if found.identified:
        return ()
    internal, steps = space.internal(values), steps_within(space, model.step)
    inside = np.clip(internal, space.bounds[0] + steps, space.bounds[1] - steps)
    if (inside != internal).any():  # at a bound there is no step to both sides
        internal, values = inside, space.admissible(inside)
    others, opposite = (list(space.admissible(internal + s * np.diag(steps))) for s in (1, -1))
    suggested: dict[str, Suggestion] = {}
    for candidates in (
        _numbers(model, values, [others, opposite], steps),
        _conditions(model, values, others, steps),
    ):
        for direction in found.null.T:
            for one in settling(direction, candidates)[:_MOST]:
                if one.change >= _WORTH:
                    suggested.setdefault(one.name, Suggestion(one.name, one.change))
    return tuple(suggested.values())


def _numbers(
    model: CaseModel, values: np.ndarray, both: list[list[np.ndarray]], steps: np.ndarray
) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Measurable numbers of the summaries, with their derivatives by steps to both sides."""
    (base,) = model.numbers(values, [values])
    sides = [model.numbers(values, points) for points in both]
    found = {}
    for name, number in base.items():
        if not _is_measured(name.partition(" ")[0]):
            continue
        ahead, behind = (np.array([o.get(name, np.nan) - number for o in one]) for one in sides)
        if np.linalg.norm(ahead + behind) <= _SMOOTH * np.linalg.norm(ahead):  # False for NaN
            found[f"a measurement of {name}"] = np.array([number]), ahead[None] / steps
    return found


def _conditions(
    model: CaseModel, values: np.ndarray, others: list[np.ndarray], steps: np.ndarray
) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """The present measurements under other loads and speeds, with their derivatives."""
    found = {}
    for key, changed in model.with_other_conditions().items():
        base, *moved = changed.neighbours(values, [values, *others])
        slopes = (np.array(moved) - base).T / steps
        if np.isfinite(slopes).all():
            found[f"the same measurements at another {key}"] = base, slopes
    return found


def _is_measured(name: str) -> bool:
    """Test for a number of the summary that can be measured."""
    name = name.rpartition(".")[2]
    known = {
        "_".join(split_key(quantity.header)[0].split())
        for group in _GROUPS
        for quantity in GROUPS[group]
    }
    return name in known and not any(word in name for word in _NOT_MEASURED)


def undetermined(found: Identifiability, further: tuple[Suggestion, ...]) -> list[str]:
    """Sentences on parameters that are not determined, and on what would determine them."""
    if found.identified:
        return []
    short = dict(zip(found.space.names, found.space.short_names, strict=True))
    text = f"the data do not determine {', '.join(short[name] for name in found.undetermined)}"
    if len(found.undetermined) > 1:
        known = "; ".join(one.text for one in found.combinations)
        text += f" one by one, {f'but {known} only' if known else 'nor any combination of them'}"
    return [text, *(f"this would settle it: {one.text}" for one in further)]

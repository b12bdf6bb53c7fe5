"""Plausibility checks of laws over the range of contact states."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..errors import ComputationError
from .interfaces import INTERFACE_VARIABLES, UNITS, Law, LocalState, Values

SAMPLES: Mapping[str, np.ndarray] = {
    "p": np.concatenate([[0.0], np.geomspace(1.0, 1e10, 61)]),
    "v": np.concatenate([[0.0], np.geomspace(1e-9, 1e2, 12)]),
    "T": np.array([200.0, 250.0, 293.15, 350.0, 500.0, 750.0, 1000.0, 1500.0]),
    "depth": np.concatenate([[0.0], np.geomspace(1e-9, 1e-2, 8)]),
    "mu": np.array([0.0, 0.1, 0.3, 1.0]),
}
"""Sample values for the checks, in SI: up to 10 GPa, 100 m/s, 1500 K and 10 mm."""
TYPICAL = LocalState(p=1e7, v=0.1, T=293.15, depth=0.0, mu=0.3)
"""Reference state of a contact, in SI."""
_ROUNDING = 1e-9  # of the rate


def require_wear_rate(law: Law) -> None:
    """Reject a wear rate that is negative or infinite somewhere, or decreases with pressure.

    Raises
    ------
    ValueError
        One-line message with a state that violates the condition.
    """
    at, rates = _sampled(law, law.variables | {"p"})
    _reject_where(~np.isfinite(rates), at, "the rate is not finite")
    _reject_where(rates < 0.0, at, "the rate is negative")
    _reject_where(rates[:1] > _ROUNDING * rates[-1:], at, "there is wear without pressure")
    decreases = np.diff(rates, axis=0) < -_ROUNDING * rates[:-1]
    _reject_where(decreases, at, "the rate decreases with increasing pressure")
    if not rates.any():
        raise ValueError("the rate is 0 at all pressures")


def require_interface_law(law: Law) -> None:
    """Reject a coefficient that is not finite somewhere, or not positive in a typical state.

    Raises
    ------
    ValueError
        One-line message with a state that violates the condition.
    """
    at, values = _sampled(law, law.variables)
    _reject_where(~np.isfinite(values), at, "the value is not finite")
    typical = typical_value(law)
    if not typical > 0.0:
        one = TYPICAL.arrays(INTERFACE_VARIABLES)
        _reject_where(np.array(True), one, f"the value is {typical:.4g}, must be greater than 0,")


def typical_value(law: Law, friction: Values = TYPICAL.mu) -> float:
    """Value of a law in the state of `TYPICAL`, at a coefficient of friction."""
    state = LocalState(*(np.array([value]) for value in TYPICAL._replace(mu=friction)))
    return float(law.value(state)[0])


def _sampled(law: Law, variables: frozenset[str]) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Tensor grid of samples, the pressure along its first axis, and values of a law on it.

    The other variables are as in `TYPICAL`.
    """
    names = [name for name in SAMPLES if name in variables]
    at = dict(zip(names, np.ix_(*(SAMPLES[name] for name in names)), strict=True))
    state = LocalState(*np.broadcast_arrays(*TYPICAL._replace(**at)))
    try:
        with np.errstate(all="ignore"):
            return at, np.broadcast_to(law.value(state), np.shape(state.p))
    except ComputationError as error:  # of a law that checks its values itself
        raise ValueError(str(error)) from None


def _reject_where(wrong: np.ndarray, at: Mapping[str, np.ndarray], what: str) -> None:
    """Raise for the first point of a grid with a violated condition."""
    if not wrong.any():
        return
    first = np.array(np.unravel_index(int(np.argmax(wrong)), wrong.shape), dtype=int)
    values = {name: x[tuple(np.minimum(first, np.array(x.shape) - 1))] for name, x in at.items()}
    where = ", ".join(f"{name} = {x:.3g} {UNITS[name]}".rstrip() for name, x in values.items())
    raise ValueError(f"{what} at {where}" if where else what)

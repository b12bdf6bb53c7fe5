"""Gross slip: the largest tangential force that friction carries."""

from __future__ import annotations

import numpy as np

from ...errors import ComputationError
from ..solvers.signorini import solve_contact
from .coulomb import CoulombProblem


class FullSliding(ComputationError):
    """Error for a tangential force that exceeds the friction limit."""


def refuse_sliding(problem: CoulombProblem, pressed: bool) -> None:
    """Raise if the contact in gross slip carries less than the tangential force.

    In gross slip the shear is a multiple of the pressure, which then solves a Signorini problem.
    """
    m, k = len(problem.friction), int(pressed)
    asked = problem.force[k]
    across = problem.modes[m : 2 * m, k] * np.sign(asked)
    drag = problem.friction * np.sign(across)  # τ = drag λ opposes the force
    compliance = problem.compliance[:m, :m] + problem.compliance[:m, m : 2 * m] * drag
    modes = problem.modes[:m, :k]
    carrying = modes + drag[:, None] * problem.modes[m : 2 * m, :k]
    sliding = solve_contact(
        compliance, problem.offset[:m], modes, problem.force[:k], force_modes=carrying
    )
    λ = sliding.coefficients
    if not np.any(λ > 0):
        raise ComputationError(
            "contact: the bodies do not touch, so that nothing balances a tangential force; give a "
            "tangential displacement, or press"
        )
    most = problem.modes[:m, k] @ λ + problem.modes[m : 2 * m, k] @ (drag * λ)
    if abs(asked) >= (1 - 1e-9) * abs(most):
        raise FullSliding(
            f"contact: body 1 slides; friction carries {abs(most):.6g} N, and the tangential force "
            f"is {abs(asked):.6g} N. Give a smaller force, or a tangential displacement"
        )

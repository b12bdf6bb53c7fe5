"""Factory of interface problems: choice of the contact solver and of the heat model."""

from __future__ import annotations

from collections.abc import Callable

from ..heat.friction_heat import friction_heat
from ..system.system import System
from .condensed_method import CondensedMethod
from .contact_solver import ContactSolver
from .full_method import FullMethod
from .interface_problem import InterfaceProblem


def interface_problem(
    system: System, note: Callable[[str], None] | None = None
) -> InterfaceProblem:
    """Interface problem of a system, with the contact method of its model. Every rank calls.

    Parameters
    ----------
    system : System
    note : callable, optional
        Called with a warning about settings that may impair the solution.
    """
    heat = friction_heat(system)
    problem = InterfaceProblem(system, _solver(system), heat)
    if note is not None and problem.note is not None:
        note(problem.note)
    return problem


def _solver(system: System) -> ContactSolver:
    if system.model.interface.method.name == "condensed":
        return CondensedMethod(system)
    with system.phases("contact operators"):
        return FullMethod(system)

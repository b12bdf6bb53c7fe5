"""Heat sources and thermal boundary conditions of a case."""

from __future__ import annotations

from ...case.tables.history import TemperatureHistory
from ...case.tables.schema import Case
from ...model.heat import Heat


def heat(case: Case) -> Heat | None:
    """Heat of a case; None if it is isothermal."""
    given = case.heat
    if given is None:
        return None
    history = given.ambient_history
    temperature = {
        surface: T.function if isinstance(T, TemperatureHistory) else T
        for surface, T in given.temperature.items()
    }
    return Heat(
        ambient=given.ambient,
        ambient_history=None if history is None else history.function,
        initial=given.initial,
        transient=given.transient,
        advection=given.advection,
        cooling=given.cooling,
        temperature=temperature,
        flux=given.flux,
        power=given.power,
    )

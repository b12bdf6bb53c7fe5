"""Pure functions of arrays: wear laws and the principle of steady wear."""

from .steady import SteadyWear, steady_pressure
from .wear import WearLaw

__all__ = ["SteadyWear", "WearLaw", "steady_pressure"]

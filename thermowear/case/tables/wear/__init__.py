"""Table ``wear``: wear laws of bodies, of parts and of layers."""

from .body_wear import BodyWearTable, PartWearTable, WearTable
from .wear_rate import RateTable

__all__ = ["BodyWearTable", "PartWearTable", "RateTable", "WearTable"]

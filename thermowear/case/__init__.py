"""What the user writes: the case file, its units and its checks. No dolfinx here."""

from .geometry import Geometry
from .geometry_type import known_geometries
from .loading import load
from .schema import Case, as_plain

__all__ = ["Case", "Geometry", "as_plain", "known_geometries", "load"]

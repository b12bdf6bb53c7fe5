"""What the user writes: the case file, its units and its checks. No dolfinx here."""

from .loading import load
from .tables.geometry import Geometry
from .tables.geometry_type import known_geometries
from .tables.schema import Case, as_plain

__all__ = ["Case", "Geometry", "as_plain", "known_geometries", "load"]

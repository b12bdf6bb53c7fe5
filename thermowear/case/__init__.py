"""Case files: schema, units, reading and validation, without dolfinx."""

from .loading import load
from .tables.geometry import Geometry, known_geometries
from .tables.schema import Case, as_plain

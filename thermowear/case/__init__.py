"""Case files: schema, units, reading and validation, without dolfinx."""

from .any_case import AnyCase
from .loading import load
from .tables.geometry import Geometry
from .tables.geometry_choice import known_geometries
from .tables.schema import Case, as_plain

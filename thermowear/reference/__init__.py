"""Solutions that the program is verified against, each with its source."""

from . import annular_punch, cylinder, slabs

__all__ = ["annular_punch", "cylinder", "slabs"]

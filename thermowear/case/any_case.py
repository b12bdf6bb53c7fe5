"""Case of two bodies, or of several."""

from __future__ import annotations

from .assembly.schema import AssemblyCase
from .tables.schema import Case

AnyCase = Case | AssemblyCase

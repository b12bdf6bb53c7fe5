"""Keys of case files: their meanings, the JSON schema for editors, rows for the reference."""

from .json_schema import case_schema
from .keys import all_tables

__all__ = ["all_tables", "case_schema"]

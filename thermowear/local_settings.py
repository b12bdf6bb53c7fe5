"""Protection from settings of libraries in the current folder.

A case may be run inside a folder from another person. dolfinx and FFCx read options from the
current folder, among them arguments of the compiler, which can run any command. The user's options
in the home folder remain valid.
"""

from __future__ import annotations

import contextlib
from pathlib import Path

OWN = Path(__file__).parent
"""Folder without option files."""


def fix_compiler_options() -> None:
    """Make dolfinx and FFCx read their options, which they do once, from another folder."""
    with contextlib.chdir(OWN):
        import ffcx
        from dolfinx import jit

        ffcx.get_options()
        jit.get_options()

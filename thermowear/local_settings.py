"""Libraries are started without the settings that lie in the current folder.

A case may come in a folder of somebody else and be run there. dolfinx and FFCx look for options in
the current folder, among them arguments of the compiler, which can be any command. Those of the
user, in the home folder, hold as ever.
"""

from __future__ import annotations

import contextlib
from pathlib import Path

OWN = Path(__file__).parent
"""A folder without such files."""


def fix_compiler_options() -> None:
    """Let dolfinx and FFCx read their options, which they do once, from another folder."""
    with contextlib.chdir(OWN):
        import ffcx
        from dolfinx import jit

        ffcx.get_options()
        jit.get_options()

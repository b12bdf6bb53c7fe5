"""Draw everything there is to draw in a results folder."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

from ...errors import CaseError
from .curves import draw_history, draw_interface, draw_wear
from .friction import draw_cycles, draw_friction, draw_loads
from .heat import draw_heat
from .maps import draw_interface_maps, draw_wear_maps, is_surface
from .modes import draw_modes
from .profile import draw_profile
from .track import draw_track

_TIMEOUT = 180.0  # seconds for the rendering process


def make_pictures(folder: Path) -> list[str]:
    """Draw the curves here and the bodies in a process of their own.

    Rendering needs graphics libraries that can take a process down with them; whatever happens
    there, the curves are drawn and the caller goes on.

    Returns
    -------
    list of str
        What could not be drawn and why, one line each.

    Raises
    ------
    CaseError
        If the folder holds no results.
    """
    if not (folder / "interface.csv").is_file():
        raise CaseError(f"{folder}: holds no interface.csv; not a results folder of a finished run")
    if is_surface(folder):
        draw_interface_maps(folder)
        draw_wear_maps(folder)
    else:
        draw_interface(folder)
        draw_profile(folder)
        draw_wear(folder)
    draw_history(folder)
    draw_heat(folder)
    draw_friction(folder)
    draw_loads(folder)
    draw_cycles(folder)
    draw_track(folder)
    draw_modes(folder)
    if not (folder / "fields.vtu").is_file():
        return [f"{folder}: no fields.vtu, so no pictures of the bodies"]
    reason = _render(folder)
    return [f"the bodies could not be drawn: {reason}"] if reason else []


def _render(folder: Path) -> str:
    """Render the bodies; the reason why not, empty on success."""
    command = [sys.executable, "-m", f"{__package__}.bodies", str(folder)]
    package_root = str(Path(__file__).parents[3])
    path = os.pathsep.join(filter(None, [package_root, os.environ.get("PYTHONPATH")]))
    environment = os.environ | {"PYTHONPATH": path, "PYVISTA_OFF_SCREEN": "true"}
    for name in [k for k in environment if k.startswith(("OMPI_", "PMIX_", "PRTE_", "PMI_"))]:
        del environment[name]  # the renderer is no rank of a parallel run
    reason = ""
    for prefix in _displays():
        try:
            done = subprocess.run(
                [*prefix, *command],
                env=environment,
                capture_output=True,
                text=True,
                timeout=_TIMEOUT,
                check=False,
            )
        except (OSError, subprocess.TimeoutExpired) as error:
            reason = str(error)
            continue
        if done.returncode == 0:
            return ""
        said = (done.stderr.strip() or done.stdout.strip()).splitlines()
        reason = said[-1] if said else f"exit code {done.returncode}"
    return reason


def _displays() -> list[list[str]]:
    """Ways to start the renderer, likeliest first: some builds of VTK need an X server."""
    direct: list[list[str]] = [[]]
    virtual = [["xvfb-run", "-a"]] if shutil.which("xvfb-run") else []
    return direct + virtual if os.environ.get("DISPLAY") else virtual + direct

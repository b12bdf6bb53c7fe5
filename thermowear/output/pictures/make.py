"""Draw all pictures of a results folder."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

from ...balances import violated
from ...errors import CaseError, ComputationError
from ...geometry.mesh.mixed import AnyMesh
from ...geometry.mesh.outside import outside
from ..files import contacts_of, name_at, picture, read_summary
from ..tables import MissingColumnError
from . import curves, maps, over_time
from .animation import FPS, check_animation, has_frames
from .hot_spots import draw_hot_spots
from .modes import draw_modes

_ALONG_A_LINE: dict[str, Callable[..., None]] = {
    "interface": curves.draw_interface,
    "profile": curves.draw_profile,
    "wear": curves.draw_wear,
    "coating": curves.draw_coating,
    "mode": draw_modes,
    "friction": curves.draw_friction,
    "track": curves.draw_track,
}
_OVER_A_SURFACE: dict[str, Callable[..., None]] = {
    "interface": maps.draw_interface_maps,
    "wear": maps.draw_wear_maps,
    "coating": maps.draw_coating_maps,
    "friction": maps.draw_friction_maps,
    "track": maps.draw_track_maps,
    "mode": draw_modes,
}
_OF_THE_INTERFACE = ("wear", "coating")
"""Pictures drawn from ``interface.csv`` that have no table of their own."""
_OTHERS: dict[str, Callable[..., None]] = {
    "history": over_time.draw_history,
    "heat": over_time.draw_heat,
    "loads": over_time.draw_loads,
    "cycles": over_time.draw_cycles,
    "hot_spots": draw_hot_spots,
}
_TIMEOUT = 180.0  # seconds for the rendering process
_ANIMATION_TIMEOUT = 1800.0  # seconds for the rendering process of an animation


def make_pictures(folder: Path) -> list[str]:
    """Draw the curves in this process, the bodies and their animation in separate processes.

    Rendering uses graphics libraries that may crash a process; the curves are drawn and the caller
    continues in any case.

    Returns
    -------
    list of str
        Missing pictures with reasons, and violated balances, one line each.

    Raises
    ------
    CaseError
        If the folder contains no results.
    """
    contacts = contacts_of(folder)
    needed = name_at("interface", None, contacts[0])
    if not (folder / needed).is_file():
        raise CaseError(f"{folder}: contains no {needed}; not a results folder of a finished run")
    notes = []
    first = _OVER_A_SURFACE if maps.is_surface(folder) else _ALONG_A_LINE
    each = [(name, draw, (contact,)) for contact in contacts for name, draw in first.items()]
    for name, draw, contact in [*each, *((name, draw, ()) for name, draw in _OTHERS.items())]:
        try:
            if name in _OF_THE_INTERFACE or (folder / name_at(name, None, *contact)).is_file():
                draw(folder, *contact)
        except MissingColumnError as reason:
            notes.append(f"{folder}: no {picture(name, *contact)}, as {reason}")
    notes += [f"{folder}: not balanced: {line}" for line in violated(read_summary(folder))]
    if not (folder / "fields.vtu").is_file():
        return [*notes, f"{folder}: no fields.vtu, so no pictures of the bodies"]
    reasons = {"the bodies": _render("bodies", str(folder.resolve()))}
    if (folder / "hot_spots.vtu").is_file():
        reasons["the hot spots"] = _render("hot_spot_views", str(folder.resolve()))
    if has_frames(folder):
        reasons["the animation"] = _animate(folder, folder / "animation.gif", FPS)
    return notes + [f"{what} could not be drawn: {why}" for what, why in reasons.items() if why]


def make_animation(folder: Path, path: Path, fps: float = FPS) -> None:
    """Draw the intermediate states of a run with ``analysis.frames``.

    Parameters
    ----------
    folder : Path
        Results folder.
    path : Path
        File to write, ``.gif`` or ``.mp4``.
    fps : float
        Frames per second.

    Raises
    ------
    CaseError
        If there are no frames, or ffmpeg is missing for an MP4.
    ComputationError
        If drawing fails.
    """
    check_animation(folder, path)
    reason = _animate(folder, path, fps)
    if reason:
        raise ComputationError(f"{path}: could not be drawn: {reason}")


def make_mesh_picture(mesh: AnyMesh, path: Path) -> None:
    """Draw the mesh of bodies in space with its named surfaces.

    Parameters
    ----------
    mesh : TaggedMesh or MixedMesh
        Mesh whose bodies have no zones.
    path : Path
        File to write, ``.png``.

    Raises
    ------
    ComputationError
        If drawing fails.
    """
    arrays = {"bodies": np.array(mesh.bodies), "surfaces": np.array(mesh.surfaces)}
    for b, body in enumerate(mesh.bodies):
        names = f"points_{b}", f"facets_{b}", f"surface_{b}"
        arrays |= dict(zip(names, outside(mesh, body), strict=True))
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "mesh.npz"
        np.savez(source, allow_pickle=False, **arrays)
        reason = _render("mesh", str(source), str(path.resolve()))
    if reason:
        raise ComputationError(f"{path}: could not be drawn: {reason}")


def _animate(folder: Path, path: Path, fps: float) -> str:
    """Draw an animation; returns the reason of a failure, empty on success."""
    arguments = str(folder.resolve()), str(path.resolve()), str(fps)
    return _render("animation.make", *arguments, timeout=_ANIMATION_TIMEOUT)


def _render(module: str, *arguments: str, timeout: float = _TIMEOUT) -> str:
    """Run a rendering module in a process; returns the reason of a failure, empty on success."""
    command = [sys.executable, "-m", f"{__package__}.{module}", *arguments]
    package_root = str(Path(__file__).parents[3])
    path = os.pathsep.join(filter(None, [package_root, os.environ.get("PYTHONPATH")]))
    environment = os.environ | {"PYTHONPATH": path, "PYVISTA_OFF_SCREEN": "true"}
    for name in [k for k in environment if k.startswith(("OMPI_", "PMIX_", "PRTE_", "PMI_"))]:
        del environment[name]  # the renderer is not a rank of the parallel run
    reason = ""
    for prefix in _displays():
        try:
            done = subprocess.run(
                [*prefix, *command],
                env=environment,
                cwd=package_root,  # no modules or settings from the current folder
                capture_output=True,
                text=True,
                timeout=timeout,
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
    """Command prefixes to try, most promising first: some builds of VTK need an X server."""
    direct: list[list[str]] = [[]]
    virtual = [["xvfb-run", "-a"]] if shutil.which("xvfb-run") else []
    return direct + virtual if os.environ.get("DISPLAY") else virtual + direct

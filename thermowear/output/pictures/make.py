"""Draw all pictures of a results folder."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from itertools import compress
from pathlib import Path

import numpy as np

from ...balances import violated
from ...errors import CaseError, ComputationError
from ...geometry.mesh.mixed import AnyMesh, outside
from ..files import contacts_of, name_at, read_summary
from ..frames import HOT_SPOTS
from ..rendering import PictureJob, Renderer, attempt
from .kinds import FPS, has_frames, is_surface

_ANIMATION_TIMEOUT = 1800.0  # [s]
_MANY = 4  # contacts from which half of their curves are drawn by another process


def make_pictures(folder: Path, renderer: Renderer | None = None) -> list[str]:
    """Draw all pictures: in this process, but bodies in space in another one at the same time,
    as half of the curves of many contacts.

    Rendering uses graphics libraries that may crash a process; the curves are drawn and the caller
    continues in any case.

    Parameters
    ----------
    folder : Path
        Results folder.
    renderer : Renderer, optional
        Process for bodies in space, if one has been started.

    Returns
    -------
    list of str
        Missing pictures with reasons, and violated balances, one line each.

    Raises
    ------
    CaseError
        If the folder contains no results.
    """
    needed = name_at("interface", None, contacts_of(folder)[0])
    if not (folder / needed).is_file():
        raise CaseError(f"{folder}: contains no {needed}; not a results folder of a finished run")
    in_space, contacts = is_surface(folder), len(contacts_of(folder))
    jobs = _of_the_bodies(folder, in_space)
    if contacts >= _MANY and not in_space:
        contacts = (contacts + 1) // 2
        arguments = str(folder.resolve()), in_space, contacts
        jobs["other contacts"] = PictureJob("contacts", arguments, in_space=False, apart=True)
    with _drawing(list(jobs.values()), renderer) as reasons:
        from .from_tables import draw_tables  # loads matplotlib while bodies are rendered

        notes = draw_tables(folder, in_space, contacts)
    notes += [f"{folder}: not balanced: {line}" for line in violated(read_summary(folder))]
    failed = [(what, why) for what, why in zip(jobs, reasons, strict=True) if why]
    notes += [f"{what} could not be drawn: {why}" for what, why in failed]
    if not (folder / "fields.vtu").is_file():
        notes.append(f"{folder}: no fields.vtu, so no pictures of the bodies")
    return notes


def _of_the_bodies(folder: Path, in_space: bool) -> dict[str, PictureJob]:
    """Pictures of the bodies that a results folder has data for, by what they show."""
    if not (folder / "fields.vtu").is_file():
        return {}
    path = str(folder.resolve())
    jobs = {"the bodies": PictureJob("bodies", (path,), in_space)}
    if (folder / HOT_SPOTS).is_file():
        jobs["the hot spots"] = PictureJob("hot spots", (path,))
    if has_frames(folder):
        jobs["the animation"] = _animation(folder, folder / "animation.gif", FPS, in_space)
    return jobs


def _animation(folder: Path, path: Path, fps: float, in_space: bool) -> PictureJob:
    arguments = str(folder.resolve()), str(path.resolve()), fps
    return PictureJob("animation", arguments, in_space, _ANIMATION_TIMEOUT)


@contextmanager
def _drawing(jobs: list[PictureJob], renderer: Renderer | None = None) -> Iterator[list[str]]:
    """Draw while the caller draws others; at the end, a list of the reason of each failure.

    Sections need no VTK, and no other process.
    """
    reasons: list[str] = []
    with nullcontext(renderer) if renderer else Renderer() as there:
        apart = [job.in_space or job.apart for job in jobs]
        there.begin(list(compress(jobs, apart)))
        yield reasons
        ours = compress(jobs, (not away for away in apart))
        here = iter([attempt(job.kind, job.arguments) for job in ours])
        rendered = iter(there.reasons())
        reasons += [next(rendered if away else here) for away in apart]


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
    from .animation import check_animation

    check_animation(folder, path)
    _draw(_animation(folder, path, fps, is_surface(folder)), path)


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
        _draw(PictureJob("mesh", (str(source), str(path.resolve()))), path)


def _draw(job: PictureJob, path: Path) -> None:
    """Draw one picture; a failure is an error."""
    with _drawing([job]) as reasons:
        pass
    if reasons[0]:
        raise ComputationError(f"{path}: could not be drawn: {reasons[0]}")

"""Initial worn shape: a design of either face, or the shape of an earlier run."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import scipy

from ...contact.search.pairing import Pairing
from ...errors import CaseError
from ...geometry.cad.design import CARRIERS, from_table, read_table
from ...parallel import on_root
from ...user_files import read_text

_BEYOND = 1e-6  # of the length of the face
_UNIT = 300.0  # times that length: a table of a longer face passes, one in millimetres does not
_STEP = 0.01  # of the range of shapes: left at a border of materials by the running-in
_LARGEST_FILE = 100_000_000  # bytes
_LARGEST_NUMBER = 1e100  # differences of larger ones overflow in interpolation


def initial_gap(comm, path: str, pairing: Pairing, key: str) -> np.ndarray:
    """Gap of the unloaded faces with an initial worn shape. Every rank calls.

    Parameters
    ----------
    comm : mpi4py.MPI.Comm
    path : str
        A design of either face, in any format (see `geometry.cad.design`): its depth is added to
        the nominal gap. Or a ``profile.csv`` (``interface.csv``) of an earlier run, or any table
        with its columns ``s_m`` and ``shape_m``: that shape replaces the nominal gap.
    pairing : Pairing
        Contact points of the nominal faces.
    key : str
        Path of the key of the case file that names it.

    Returns
    -------
    ndarray, shape (n,) [m]

    Raises
    ------
    CaseError
        If the file holds no shape, or the shape of another face.
    """
    where = f"{key}: {path}"
    table = on_root(comm, lambda: _checked(where, lambda: read_table(Path(path))))
    gdim = pairing.points.shape[1]
    if table is not None:
        design = _checked(where, lambda: from_table(table, gdim))
        side = pairing.sides[design.body - 1]
        points = side.face.points(side.facet, side.t)
        return pairing.gap + _checked(where, lambda: design.depth_at(points))
    if gdim == 3 or Path(path).suffix in CARRIERS:
        raise CaseError(f"{where} carries no design (the command shape writes them)")
    return _gap_along(where, on_root(comm, lambda: _read(where, path)), pairing.position)


def _gap_along(where: str, table: np.ndarray, position: np.ndarray) -> np.ndarray:
    """Gap by a shape given over the length along the face [m]."""
    s, shape = _curve(where, table)
    first, length = position.min(), position.max()
    if max(s[-1], -s[0]) > _UNIT * length:
        raise CaseError(
            f"{where} ranges from s_m = {s[0]:.6g} to {s[-1]:.6g}, more than {_UNIT:g} "
            f"times the length of the contact face, {length:.6g} m; is it in metres?"
        )
    beyond = _BEYOND * length
    if s[0] > first + beyond or s[-1] < length - beyond:
        raise CaseError(
            f"{where} ranges from s = {s[0]:.6g} to {s[-1]:.6g} m, the contact face from "
            f"{first:.6g} to {length:.6g} m"
        )
    height = scipy.interpolate.Akima1DInterpolator(s, shape, method="makima")(
        np.clip(position, s[0], s[-1])
    )
    if not np.ptp(height) < length:
        raise CaseError(
            f"{where} has shapes that rise by {np.ptp(height):.3g} m on a contact face of "
            f"{length:.6g} m; are they in metres?"
        )
    return height.max() - height


def _curve(where: str, table: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    names = table.dtype.names or ()
    if not {"s_m", "shape_m"} <= set(names) or table.size < 2:
        raise CaseError(f"{where} has no columns s_m and shape_m with numbers")
    points = np.unique(np.column_stack([table["s_m"], table["shape_m"]]), axis=0)
    if not np.all(np.abs(points) < _LARGEST_NUMBER):
        raise CaseError(f"{where} has entries that are no numbers, or beyond 1e100 m")
    s, shape = points.T
    twice = np.flatnonzero(np.diff(s) == 0.0)
    step = shape[twice + 1] - shape[twice]
    if len(twice) and step.max() > _STEP * np.ptp(shape):
        place = s[twice[step.argmax()]]
        raise CaseError(f"{where} has different shapes at s_m = {place:.6g}")
    shape[twice] += step / 2
    s, shape = np.delete(s, twice + 1), np.delete(shape, twice + 1)
    if len(s) < 2:
        raise CaseError(f"{where} has one place only; a shape needs two")
    return s, shape


def _read(where: str, path: str) -> np.ndarray:
    lines = _checked(where, lambda: read_text(Path(path), _LARGEST_FILE)).splitlines()
    if not any(line.strip() for line in lines):
        raise CaseError(f"{where} is empty")
    try:
        return np.genfromtxt(lines, delimiter=",", names=True)
    except ValueError as error:
        reason = " ".join(str(error).split())[:200]
        raise CaseError(
            f"{where} cannot be read as columns between commas, with points in numbers: {reason}"
        ) from None


def _checked(where: str, action):
    """Call an action; raise its file errors as `CaseError`."""
    try:
        return action()
    except (OSError, ValueError) as error:
        reason = f"cannot be read: {error.strerror}" if isinstance(error, OSError) else error
        raise CaseError(f"{where} {reason}") from None

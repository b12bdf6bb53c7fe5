"""Joints of glued bodies from their pairs of opposite points, and what they transfer.

Displacement and temperature are continuous in the mean, weighted by functions one degree below
them on the facets of one face (mortar method: Bernardi, Maday and Patera, 1994; with multipliers:
Belgacem, Numer. Math. 84 (1999) 173). The multipliers have the basis of the pressure of contact,
for each component, which is stable for any ratio of the element sizes; beside supports see
`bulk.joints`.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from ..bulk.joints import Joint, Joints
from ..bulk.kinematics import Kinematics
from ..bulk.spaces import Spaces
from ..errors import CaseError
from .faces.face import Face, Surface
from .operators.condensation import value_trace
from .operators.pressure import pressure_basis
from .search.pairing import PairedFace, Pairing, pair

_SMALLER = 1 - 1e-6
"""Ratio of areas from which a face is smaller than another one."""
_APART = 0.02
"""Largest distance of glued faces, relative to their size: those of coarse curved meshes differ."""


def glued_points(
    face_1: Face | Surface, face_2: Face | Surface, kinematics: Kinematics, degree: int, comm=None
) -> Pairing:
    """Pair two glued faces. The multipliers belong to the first face of the result.

    That is the smaller one, which lies opposite the other as a whole, and of faces of equal area
    the one with more facets. Every rank calls.

    Parameters
    ----------
    face_1, face_2 : Face or Surface
    kinematics : Kinematics
    degree : int
        Degree of the displacement and of the temperature.
    comm : mpi4py.MPI.Comm, optional
        Ranks that share the work.

    Raises
    ------
    CaseError
        If the faces do not lie opposite each other, or are apart.
    """
    first, second = (float(face.sizes.sum()) for face in (face_1, face_2))
    equal = min(first, second) > _SMALLER * max(first, second)
    swapped = len(face_2.nodes) > len(face_1.nodes) if equal else second < first
    faces = (face_2, face_1) if swapped else (face_1, face_2)
    tie = pair(*faces, kinematics, degree + 2, comm=comm)
    apart = float(np.abs(tie.gap).max())
    if apart > _APART * tie.extent:
        raise CaseError(
            f"geometry: the glued faces {face_1.name} and {face_2.name} are up to {apart:.2g} m "
            "apart; glued faces must coincide"
        )
    return tie


def elastic_joints(spaces: Spaces, ties: Sequence[Pairing]) -> Joints:
    """Joints across which the displacement is continuous. Every rank calls.

    Parameters
    ----------
    spaces : Spaces
        Displacement spaces.
    ties : sequence of Pairing
        See `glued_points`.
    """
    return Joints(tuple(_joint(spaces, tie, np.inf) for tie in ties))


def thermal_joints(
    spaces: Spaces, ties: Sequence[Pairing], conductances: Sequence[float]
) -> Joints:
    """Joints across which the temperature is continuous, or jumps by a resistance; collective.

    Parameters
    ----------
    spaces : Spaces
        Spaces of the temperature.
    ties : sequence of Pairing
        See `glued_points`.
    conductances : sequence of float
        Conductance of each interface, infinite where the temperature is continuous; zero of an
        insulating one [W/(m² K)].
    """
    pairs = zip(ties, conductances, strict=True)
    return Joints(tuple(_joint(spaces, tie, h) for tie, h in pairs))


def transferred(tie: Pairing, multipliers: np.ndarray, degree: int) -> np.ndarray:
    """Traction on, or heat flux into, the first body of a joint at its points.

    Parameters
    ----------
    tie : Pairing
    multipliers : ndarray, shape (m,)
        Those of the joint, from `Joints.split`.
    degree : int
        Degree of the displacement, or of the temperature.

    Returns
    -------
    ndarray, shape (n, width)
        Components of the traction [Pa], or the flux alone [W/m²]. The other body has the opposite.
    """
    basis = _functions(tie, degree)
    if not len(multipliers):  # insulating
        return np.zeros((len(tie.weights), 1))
    return basis @ multipliers.reshape(-1, basis.shape[1]).T


def _joint(spaces: Spaces, tie: Pairing, conductance: float) -> Joint:
    """Joint of a conductance: infinite where the field is continuous."""
    functions = _functions(tie, spaces.degree)
    if conductance == 0.0:
        functions = functions[:, :0]
    weighted = sp.diags_array(tie.weights) @ functions
    first, second = (_weighted_trace(spaces, side, weighted) for side in tie.sides)
    resistance = sp.csr_matrix((first.shape[1],) * 2)
    if 0.0 < conductance < np.inf:
        resistance = sp.csr_matrix(weighted.T @ functions / conductance)
    one, two = (side.face for side in tie.sides)
    bodies, surfaces = (one.body, two.body), (one.name, two.name)
    return Joint(bodies, surfaces, second - first, -first, resistance)


def _weighted_trace(spaces: Spaces, side: PairedFace, weighted: sp.csr_array) -> sp.csr_matrix:
    """Traces of all components on one side, each weighted by functions at the points (n, m)."""
    components = range(spaces.components)
    return sp.hstack([value_trace(spaces, side, k) @ weighted for k in components], format="csr")


def _functions(tie: Pairing, degree: int) -> sp.csr_array:
    """Functions Ψ of the multipliers at the points, shape (n, m)."""
    return sp.csr_array(pressure_basis(tie, max(degree - 1, 1)))

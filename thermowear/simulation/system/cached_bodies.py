"""Elastic and conducting bodies of a model, shared with earlier models where their keys agree.

Neither the factorised stiffness nor the conduction depends on the thermal expansion.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy.sparse as sp

from ...bulk.bodies import Bodies
from ...bulk.kinematics import Kinematics
from ...bulk.mechanics.elasticity import Elasticity, ElasticMaterial, elasticity
from ...bulk.mechanics.pins import pin
from ...bulk.solver_choice import SolverChoice
from ...bulk.spaces import Spaces, lagrange_spaces
from ...contact.faces.face import gather_faces
from ...contact.operators.pressure import Basis
from ...contact.operators.traces import gap_trace
from ...contact.search.contacts import Contacts
from ...contact.search.pairing import Pairing
from ...contact.ties.joints import elastic_joints, glued_points
from ...errors import CaseError
from ...model.conditions import Heat
from ...model.model import Model
from ...timer import Phases
from .rigid_modes import motion_of
from .setup_cache import CacheKeys, SetupCache
from .thermal_system import ThermalSystem, thermal_system


@dataclass(frozen=True)
class CachedBodies:
    """Bodies of a model from the cache of set-up results.

    Attributes
    ----------
    parts : SetupCache
    keys : CacheKeys
    model : Model
    choice : SolverChoice
    phases : Phases
    """

    parts: SetupCache
    keys: CacheKeys
    model: Model
    choice: SolverChoice
    phases: Phases

    def elastic(
        self, kinematics: Kinematics, bodies: Bodies, contacts: Contacts
    ) -> tuple[Elasticity, sp.csr_matrix, list[Pairing]]:
        """Elastic bodies, the trace of the gap, and the glued points. Every rank calls."""
        parts, keys, model = self.parts, self.keys, self.model
        glued = parts.get(
            "glued", keys.mesh, lambda: glued_pairings(model, bodies.comm, kinematics, bodies)
        )

        def assembled() -> tuple[Elasticity, sp.csr_matrix]:
            return elastic_system(model, kinematics, bodies, contacts, self.choice, glued)

        def expanding() -> tuple[Elasticity, sp.csr_matrix]:
            elastic, trace = parts.get("stiffness", keys.stiffness, assembled)
            return elastic.expanding(elastic_materials(model)), trace

        return *parts.get("elasticity", keys.elasticity, expanding), glued

    def conducting(
        self,
        heat: Heat,
        contacts: Contacts,
        glued: Sequence[Pairing],
        elastic: Elasticity,
        basis: Basis,
        partition: np.ndarray,
    ) -> ThermalSystem:
        """Conducting bodies, and the forces of their temperatures. Every rank calls."""
        parts, keys, degree = self.parts, self.keys, self.model.discretisation.degree
        spaces = parts.get(
            "temperatures", keys.mesh, lambda: lagrange_spaces(elastic.bodies, degree)
        )
        at = contacts, glued, elastic, spaces, basis, partition

        def assembled() -> ThermalSystem:
            return thermal_system(self.model, heat, *at, self.phases, self.choice)

        def straining() -> ThermalSystem:
            thermal = parts.get("conductivity", keys.conductivity, assembled)
            load = parts.get("thermal load", keys.elasticity, lambda: elastic.thermal_load(spaces))
            return thermal.straining(elastic, load)

        return parts.get("conduction", keys.conduction, straining)


def glued_pairings(model: Model, comm, kinematics: Kinematics, bodies: Bodies) -> list[Pairing]:
    """Opposite points of the glued faces."""
    degree = model.discretisation.degree
    return [
        glued_points(*gather_faces(bodies, tie.faces), kinematics, degree, comm)
        for tie in model.ties
    ]


def elastic_system(
    model: Model,
    kinematics: Kinematics,
    bodies: Bodies,
    contacts: Contacts,
    choice: SolverChoice,
    glued: Sequence[Pairing] = (),
) -> tuple[Elasticity, sp.csr_matrix]:
    """Assemble the elastic bodies and set up their solver. Every rank calls.

    Returns
    -------
    elastic : Elasticity
    trace : csr_matrix, shape (n_owned, n)
        Bᵀ of the gap in the displacement spaces.
    """
    degree = model.discretisation.degree
    clamped, symmetric, rollers, mid_plane = model.supports
    elastic = elasticity(
        bodies,
        kinematics,
        degree,
        elastic_materials(model),
        clamped,
        symmetric,
        rollers,
        choice,
        mid_plane,
        joints=lambda spaces: elastic_joints(spaces, glued),
        pinned=partial(_pinned, model),
    )
    return elastic, gap_trace(elastic.spaces, contacts)


def _pinned(model: Model, spaces: Spaces, supports: list[np.ndarray]) -> list[np.ndarray]:
    """Supports with as many more values as hanging bodies have free motions. Every rank calls.

    Raises
    ------
    CaseError
        If supports that are not plane prevent such a motion.
    """
    fixed, nodes = np.concatenate(supports), spaces.nodes()
    for holder in (one for one in model.holders if one.hanging):
        own = np.zeros(len(fixed))
        own[spaces.rows(*holder.bodies)] = 1.0
        motions = [own * motion_of(holder, name).at(nodes).ravel() for name in holder.free]
        if pin(fixed, np.stack(motions, axis=1), spaces.comm).shape[1] < len(holder.free):
            raise CaseError(
                f"bodies.{holder.name}: its supports prevent the motion {' or '.join(holder.free)} "
                "in part, as their surfaces are not plane; fix one, or use a holder"
            )
    return spaces.split(fixed)


def elastic_materials(model: Model) -> dict[str, ElasticMaterial]:
    """Elastic materials by part; none expands in a model without heat."""
    hot = model.heat is not None
    return {
        part: ElasticMaterial(m.young_modulus, m.poisson_ratio, m.expansion if hot else 0.0)
        for part, m in model.materials.items()
    }

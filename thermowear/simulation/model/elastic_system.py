"""Elastic bodies of a case and their loads beside the contact."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from ...bulk.bodies import Bodies
from ...bulk.kinematics import Model
from ...bulk.mechanics.elasticity import Elasticity, ElasticMaterial, elasticity
from ...bulk.mechanics.surface_load import surface_load, surface_pressure
from ...case.tables.schema import Case
from ...contact.operators.traces import gap_trace
from ...contact.search.pairing import Pairing
from ...laws.motions import RigidMotion
from ...parallel import sum_over_ranks


def elastic_system(
    case: Case, model: Model, bodies: Bodies, pairing: Pairing
) -> tuple[Elasticity, sp.csr_matrix]:
    """Assemble and factorise the elastic bodies. Every rank calls.

    Returns
    -------
    elastic : Elasticity
    trace : csr_matrix, shape (n_owned, n)
        Bᵀ of the gap in the displacement space.
    """
    geometry = case.geometry
    materials = {name: _elastic_material(case, name) for name in geometry.parts}
    clamped, symmetric, rollers = supports(case)
    elastic = elasticity(bodies, model, case.mesh.degree, materials, clamped, symmetric, rollers)
    return elastic, gap_trace(elastic.space, pairing)


def supports(case: Case) -> tuple[list[str], tuple[str, ...], tuple[str, ...]]:
    """Clamped surfaces, symmetry planes, and surfaces on rollers."""
    geometry = case.geometry
    clamped = [s for s in (geometry.held, geometry.fixed) if s not in geometry.rollers]
    return clamped, geometry.symmetry, geometry.rollers


def dead_load(case: Case, elastic: Elasticity) -> np.ndarray | None:
    """Nodal forces of the loads on surfaces, shape (n_owned,) [N]; None without surface loads."""
    press = np.array(case.geometry.press_direction)
    loads = [
        surface_load(elastic, surface, force * press)
        for surface, force in case.load.surfaces.items()
    ]
    loads += [surface_pressure(elastic, *given) for given in case.load.pressure.items()]
    return np.sum(loads, axis=0) if loads else None


def dead_resultant(
    case: Case, elastic: Elasticity, forces: np.ndarray | None, motion: RigidMotion
) -> np.ndarray:
    """Generalised forces of nodal forces on a rigid motion of body 1 and of body 2, shape (2,).

    Every rank calls.
    """
    if forces is None:
        return np.zeros(2)
    nodes = elastic.nodes()
    work = (forces.reshape(nodes.shape) * motion.at(nodes)).sum(axis=1)
    upper = elastic.owned_by(*case.geometry.parts_of(case.geometry.bodies[0]))
    parts = np.array([work[upper].sum(), work[~upper].sum()])
    return sum_over_ranks(elastic.bodies.mesh.comm, parts)


def _elastic_material(case: Case, body: str) -> ElasticMaterial:
    material = case.material(body)
    E, ν, α = material.young_modulus, material.poisson_ratio, material.expansion
    assert E is not None  # the case has been checked
    assert ν is not None
    return ElasticMaterial(E, ν, α if case.heat is not None and α is not None else 0.0)

"""Elastic bodies of a model and their loads beside the contact."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.sparse as sp

from ...bulk.bodies import Bodies
from ...bulk.compiled import nodal_loads
from ...bulk.kinematics import Kinematics
from ...bulk.mechanics.elasticity import Elasticity, ElasticMaterial, elasticity
from ...contact.operators.traces import gap_trace
from ...contact.search.pairing import Pairing
from ...laws.motions import RigidMotion
from ...model.conditions import Holder
from ...model.model import Model
from ...parallel import sum_over_ranks


def elastic_system(
    model: Model, kinematics: Kinematics, bodies: Bodies, pairing: Pairing
) -> tuple[Elasticity, sp.csr_matrix]:
    """Assemble and factorise the elastic bodies. Every rank calls.

    Returns
    -------
    elastic : Elasticity
    trace : csr_matrix, shape (n_owned, n)
        Bᵀ of the gap in the displacement space.
    """
    hot = model.heat is not None
    materials = {
        part: ElasticMaterial(m.young_modulus, m.poisson_ratio, m.expansion if hot else 0.0)
        for part, m in model.materials.items()
    }
    degree = model.discretisation.degree
    elastic = elasticity(bodies, kinematics, degree, materials, *supports(model))
    return elastic, gap_trace(elastic.space, pairing)


def supports(model: Model) -> tuple[list[str], tuple[str, ...], tuple[str, ...]]:
    """Clamped surfaces, symmetry planes, and surfaces on rollers."""
    clamped = [surface for body in model.bodies for surface in body.fixed]
    rollers = tuple(surface for body in model.bodies for surface in body.rollers)
    return clamped, model.symmetry, rollers


def dead_load(holder: Holder, elastic: Elasticity) -> np.ndarray | None:
    """Nodal forces of the loads on surfaces, shape (n_owned,) [N]; None without surface loads."""
    loads = [nodal_loads(elastic.space, work) for work in surface_loads(holder, elastic)]
    return np.sum(loads, axis=0) if loads else None


def surface_loads(holder: Holder, elastic: Elasticity) -> list[Callable]:
    """Forms of the work of the loads on surfaces, see `Elasticity`."""
    direction = np.array(holder.load_direction)
    forces = [
        elastic.surface_work(surface, force * direction)
        for surface, force in holder.surface_forces.items()
    ]
    pressures = holder.surface_pressures.items()
    return forces + [elastic.pressure_work(*given) for given in pressures]


def dead_resultant(
    elastic: Elasticity, upper: tuple[str, ...], forces: np.ndarray | None, motion: RigidMotion
) -> np.ndarray:
    """Generalised forces of nodal forces on a rigid motion of body 1 and of body 2, shape (2,).

    Every rank calls.

    Parameters
    ----------
    elastic : Elasticity
    upper : tuple of str
        Parts of body 1.
    forces : ndarray or None, shape (n_owned,) [N]
    motion : RigidMotion
    """
    if forces is None:
        return np.zeros(2)
    nodes = elastic.nodes()
    work = (forces.reshape(nodes.shape) * motion.at(nodes)).sum(axis=1)
    on_1 = elastic.owned_by(*upper)
    parts = np.array([work[on_1].sum(), work[~on_1].sum()])
    return sum_over_ranks(elastic.bodies.mesh.comm, parts)

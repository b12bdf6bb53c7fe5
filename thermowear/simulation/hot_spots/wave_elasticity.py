"""Elastic bodies in a wave, condensed to the pressure space."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ...bulk.mechanics.elasticity import Elasticity, elasticity
from ...bulk.spaces import block_diagonal, gathered, gathered_rows
from ...bulk.waves import Wave
from ...contact.operators.pressure import dense, scaled
from ...contact.operators.traces import vector_trace
from ...contact.search.pairing import Pairing
from ...contact.ties.joints import elastic_joints
from ...parallel import sum_over_ranks
from ..system.cached_bodies import elastic_materials, glued_pairings
from ..system.system import System
from .supports import FreeMotions, Guided, Symmetry, antisymmetric, pinning


@dataclass(frozen=True)
class WaveElasticity:
    """Elastic bodies in a wave; matrices on every rank.

    Attributes
    ----------
    elastic : Elasticity
    compliance : ndarray, shape (m, m)
        A: weak gap per pressure coefficient, that of soft layers between the faces included.
    responses : ndarray, shape (n_owned, m)
        Displacement per pressure coefficient [m/Pa].
    opening : ndarray, shape (m, n_temperatures)
        Weak gap per nodal temperature of all bodies [m³/K].
    free : ndarray, shape (m, k)
        Weak gap closed by the free rigid motions of the bodies.
    """

    elastic: Elasticity
    compliance: np.ndarray
    responses: np.ndarray
    opening: np.ndarray
    free: np.ndarray


def wave_elasticity(
    system: System, wave: Wave, symmetry: Symmetry, mirror: tuple[str, ...]
) -> WaveElasticity:
    """Assemble the elastic bodies in a wave, and condense them. Every rank calls.

    Parameters
    ----------
    system : System
        System with heat, of a section.
    wave : Wave
    symmetry : str
    mirror : tuple of str
        Surfaces in the mirror plane.
    """
    assert system.thermal is not None
    free, comm = FreeMotions(), system.comm
    elastic = _assembled(system, wave, symmetry, mirror, free)
    trace = _trace(system, elastic)
    weighted = sp.csr_matrix(scaled(system.weights, system.basis))
    loads = sp.csr_matrix(trace @ weighted)
    responses = elastic.solve(loads)
    compliance = sum_over_ranks(comm, loads.T @ responses)
    soft = dense(weighted.T @ scaled(system.softness, system.basis))
    forces = elastic.thermal_load(system.thermal.conduction.spaces)
    everywhere = gathered_rows(responses, comm)
    opening = gathered(block_diagonal(forces.each)).T @ everywhere
    motions = [sum_over_ranks(comm, loads.T @ motion) for motion in free.fields]
    return WaveElasticity(
        elastic,
        compliance + soft,
        responses,
        opening.T,
        np.reshape(motions, (len(motions), -1)).T if motions else np.zeros((len(soft), 0)),
    )


def _assembled(
    system: System, wave: Wave, symmetry: Symmetry, mirror: tuple[str, ...], free: FreeMotions
) -> Elasticity:
    """Elastic bodies with the supports of the parity of the mode."""
    model, glued = system.model, _glued(system)
    clamped, *guided = model.supports
    held: Guided = (guided[0], guided[1], guided[2])
    if symmetry == "antisymmetric":
        held = antisymmetric(held, mirror)
    return elasticity(
        system.bodies,
        wave,
        model.discretisation.degree,
        elastic_materials(model),
        clamped,
        *held[:2],
        mid_plane=held[2],
        joints=lambda spaces: elastic_joints(spaces, glued),
        pinned=pinning(system.bodies, wave, free),
    )


def _glued(system: System) -> list[Pairing]:
    """Opposite points of the glued faces."""
    at = system.model, system.comm, system.elastic.kinematics, system.bodies
    return system.parts.get("glued", system.inputs.mesh, lambda: glued_pairings(*at))


def _trace(system: System, elastic: Elasticity) -> sp.csr_matrix:
    """Transposed gap trace in the spaces of the wave; the normals lie in the section."""
    normals = np.pad(system.contacts.normals, ((0, 0), (0, 1)))
    return vector_trace(elastic.spaces, system.contacts, normals)

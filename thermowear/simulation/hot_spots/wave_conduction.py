"""Heat conduction in waves: matrices of all bodies, their joints, and their exchange of heat."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
import ufl

from ...bulk.compiled import assembled_matrix
from ...bulk.heat.conduction import Conduction
from ...bulk.joints.conditions import conditions
from ...bulk.kinematics import section_measure
from ...bulk.spaces import block_diagonal, gathered, gathered_rows
from ...bulk.waves import Wave
from ..system.conditions import InterfaceConditions
from ..system.system import System
from ..system.thermal_system import ThermalSystem, conducting_parts
from .supports import Symmetry, surface_values


@dataclass(frozen=True)
class WaveConduction:
    """Matrices of heat conduction in a wave, on every rank.

    The unknowns are the nodal temperatures of all bodies, then multipliers of joints and of heat
    that crosses in perfect contact.

    Attributes
    ----------
    conducted : csc_matrix, shape (n, n)
        K: conduction, also along the wave, cooling, joints and heat exchange [W/K].
    stored : csr_matrix, shape (n, n)
        M: heat capacity, zero for multipliers [J/K].
    heated : csr_matrix, shape (n, m)
        Q: nodal friction heat per pressure coefficient at the given speed [W/Pa].
    body : ndarray of int, shape (n,)
        Index of the body of each unknown; that of a multiplier does not matter.
    kept : ndarray of bool, shape (n,)
        False for given temperatures.
    """

    conducted: sp.csc_matrix
    stored: sp.csr_matrix
    heated: sp.csr_matrix
    body: np.ndarray
    kept: np.ndarray


def wave_conduction(
    system: System,
    base: InterfaceConditions,
    wave: Wave,
    symmetry: Symmetry,
    mirror: tuple[str, ...],
) -> WaveConduction:
    """Assemble heat conduction in a wave. Every rank calls.

    Parameters
    ----------
    system : System
        System with heat, of a section.
    base : InterfaceConditions
        Conditions of the unperturbed state.
    wave : Wave
    symmetry : str
    mirror : tuple of str
        Surfaces in the mirror plane, at ambient temperature in antisymmetric modes.
    """
    thermal, comm = system.thermal, system.comm
    assert thermal is not None
    assert thermal.conduction.capacity is not None
    conduction, face, weights = thermal.conduction, thermal.face, system.weights
    matrix = gathered(conduction.conductivity)
    if not wave.is_uniform:
        matrix = matrix + gathered(_along(system, wave))
    first, second = (gathered_rows(trace, comm) for trace in face.traces)
    between = (first - second).tocsr()
    direct, passing, resistance = face.divided(base.conductance)
    matrix = matrix + between @ sp.diags(weights * direct) @ between.T
    basis = sp.csc_matrix(system.basis)
    crossing = (sp.diags(passing) @ basis).tocsc()
    used = np.flatnonzero(np.diff(crossing.indptr))
    crossing, basis = crossing[:, used], basis[:, used]
    jump, resisted = _joints(conduction, comm)
    border = sp.hstack([jump, between @ sp.diags(weights) @ crossing], format="csr")
    across = sp.block_diag([resisted, basis.T @ sp.diags(weights * resistance) @ basis])
    extra = border.shape[1]
    f = face.partition * np.ones(len(weights))
    share = first @ sp.diags(weights * f) + second @ sp.diags(weights * (1 - f))
    friction = share @ sp.csr_matrix(sp.diags(base.heating) @ sp.csr_matrix(system.basis))
    fixed = gathered_rows(_fixed(system, thermal, wave, symmetry, mirror), comm)
    return WaveConduction(
        sp.bmat([[matrix, border], [border.T, -across]], format="csc"),
        sp.block_diag([gathered(conduction.capacity), sp.csr_matrix((extra, extra))], format="csr"),
        sp.vstack([friction, sp.csr_matrix((extra, friction.shape[1]))], format="csr"),
        np.concatenate([_body_of_rows(conduction, comm), np.zeros(extra, dtype=int)]),
        np.concatenate([~fixed, np.ones(extra, dtype=bool)]),
    )


def _along(system: System, wave: Wave):
    """Conduction along the wave, ``∫ k m² T δT``, of all bodies."""
    thermal = system.thermal
    assert thermal is not None
    conductivities = {p: m.conductivity for p, m in conducting_parts(system.model).items()}
    blocks = []
    for body, space in zip(system.bodies.each, thermal.conduction.spaces.each, strict=True):
        T, δT = ufl.TrialFunction(space), ufl.TestFunction(space)
        own = {p: k for p, k in conductivities.items() if p in body.parts}
        m = wave.wave_number(body.mesh)
        density = body.per_part(own) * m**2 * T * δT
        measure = section_measure(body.mesh, space.ufl_element().degree)
        blocks.append(assembled_matrix(wave.integral(body.mesh, density, measure)))
    return block_diagonal(blocks)


def _joints(conduction: Conduction, comm) -> tuple[sp.csr_matrix, sp.csr_matrix]:
    """Jumps of the temperature across all joints by columns, and their resistances."""
    spaces, joints = conduction.spaces, conduction.joints
    if not joints.count:
        return sp.csr_matrix((spaces.total, 0)), sp.csr_matrix((0, 0))
    jumps, resistances = [], []
    for members in spaces.groups:
        rows = spaces.rows(*members)
        border = joints.border(members, rows)
        if not border.count:
            continue
        basis = conditions(border, conduction.fixed[rows], comm)
        own = spaces.placed(rows, sp.csr_matrix(border.jump @ basis))
        jumps.append(gathered_rows(own, comm))
        resistances.append(basis.T @ border.resistance @ basis)
    return sp.hstack(jumps, format="csr"), sp.block_diag(resistances, format="csr")


def _fixed(
    system: System,
    thermal: ThermalSystem,
    wave: Wave,
    symmetry: Symmetry,
    mirror: tuple[str, ...],
) -> np.ndarray:
    """Mask of the owned temperatures that vanish: given ones, by antisymmetry, on the axis."""
    spaces = thermal.conduction.spaces
    fixed = thermal.conduction.fixed.copy()
    if symmetry == "antisymmetric":
        fixed |= surface_values(system.bodies, spaces, mirror)
    if not wave.is_uniform:
        fixed |= wave.on_axis(spaces.nodes().T)
    return fixed


def _body_of_rows(conduction: Conduction, comm) -> np.ndarray:
    """Index of the body of each temperature, of all ranks."""
    sizes = np.diff(conduction.spaces.starts)
    return gathered_rows(np.repeat(np.arange(len(sizes)), sizes), comm)

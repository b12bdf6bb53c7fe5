"""Equations of the waves of a system, by their number and parity."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
import ufl

from ...bulk.compiled import assembled_matrix
from ...bulk.elasticity.elasticity import Elasticity, elasticity
from ...bulk.heat.conduction import Conduction
from ...bulk.joints import conditions
from ...bulk.kinematics import Wave, section_measure, wave_along
from ...bulk.spaces import block_diagonal, gathered, gathered_rows
from ...contact.operators.condensation import vector_trace
from ...contact.operators.pressure import dense, scaled
from ...contact.search.pairing import Pairing
from ...contact.ties import elastic_joints
from ...laws.stability import LoadFree, load_free
from ...laws.waves import WaveEquations, WaveHeat, WornBody
from ...parallel import sum_over_ranks
from ..system.building import elastic_materials, glued_pairings
from ..system.conditions import InterfaceConditions
from ..system.system import System
from ..system.thermal_system import ThermalSystem, conducting_parts
from .bodies import (
    FreeMotions,
    Guided,
    Symmetry,
    antisymmetric,
    body_speeds,
    pinning,
    surface_values,
)


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


@dataclass(frozen=True)
class WaveSystem:
    """Bodies of a system in a wave.

    Attributes
    ----------
    wave : Wave
    symmetry : str
    elasticity : WaveElasticity
    conduction : WaveConduction
    space : LoadFree
        Perturbations without resultants.
    equations : WaveEquations
    """

    wave: Wave
    symmetry: Symmetry
    elasticity: WaveElasticity
    conduction: WaveConduction
    space: LoadFree
    equations: WaveEquations


@dataclass(frozen=True)
class WaveModel:
    """Waves of a system on an unperturbed state.

    Attributes
    ----------
    system : System
        System of a section with heat, in which the bodies slide normal to it.
    pressure : ndarray, shape (n,)
        Pressure of the unperturbed state [Pa].
    conditions : InterfaceConditions
    mirror : tuple of str
        Surfaces in the mirror plane of a half model; empty for none.
    """

    system: System
    pressure: np.ndarray
    conditions: InterfaceConditions
    mirror: tuple[str, ...] = ()

    @cached_property
    def speeds(self) -> np.ndarray:
        """Velocity of each body relative to the best conductor, see `body_speeds`."""
        speeds = body_speeds(self.system.model, self.system.contacts)
        return speeds - speeds[self.reference]

    @cached_property
    def reference(self) -> int:
        """Index of the body of the largest conductivity: hot spots hardly move on it."""
        bodies = self.system.model.bodies
        in_contact = sorted({k for pair in self.system.contacts.bodies for k in pair})
        return max(in_contact, key=lambda k: _largest(bodies[k], "conductivity"))

    @cached_property
    def radius(self) -> float | None:
        """Mean radius of the contacts of an axisymmetric model [m]; None of a prism."""
        if self.system.model.kinematics != "axisymmetric":
            return None
        return float(np.average(self.system.contacts.points[:, 0], weights=self.system.weights))

    def wave_number(self, number: float) -> float:
        """Wave number at the mean radius, or of a prism [1/m]."""
        return number if self.radius is None else number / self.radius

    def at(self, number: float, symmetry: Symmetry) -> WaveSystem:
        """Equations of a wave; every rank calls.

        Parameters
        ----------
        number : float
            Number of waves round the axis, or wave number along a prism [1/m].
        symmetry : str

        Raises
        ------
        ComputationError
            If the bodies are not supported.
        """
        system, model = self.system, self.system.model
        wave = wave_along(model.kinematics, number, model.thickness, model.sector)
        given = system, wave, symmetry, self.mirror
        elasticity = wave_elasticity(*given)
        conduction = wave_conduction(system, self.conditions, *given[1:])
        space = self._space(wave, elasticity)
        kept = conduction.kept
        turning = wave.number * self.speeds
        n = elasticity.opening.shape[1]
        opening = np.pad(elasticity.opening, ((0, 0), (0, len(kept) - n)))
        equations = WaveEquations(
            elastic=space(elasticity.compliance),
            heat=WaveHeat(
                opening=space.gaps.T @ opening[:, kept],
                heated=conduction.heated[kept] @ space.pressures,
                conducted=conduction.conducted[kept][:, kept].tocsc(),
                stored=conduction.stored[kept][:, kept].tocsc(),
                turning=turning[conduction.body[kept]],
            ),
            worn=self._worn(space, turning),
            slowest=self._slowest(number),
            frames=self._frames(turning),
        )
        return WaveSystem(wave, symmetry, elasticity, conduction, space, equations)

    def _space(self, wave: Wave, elasticity: WaveElasticity) -> LoadFree:
        """Perturbations of the points in contact that carry no resultant."""
        contact, held = self.system.contact, elasticity.free
        pressed = contact.pressed(self.pressure)
        modes = [contact.modes, held] if wave.is_uniform else [held]
        forces = [contact.force_modes, held] if wave.is_uniform else [held]
        space = load_free(np.hstack(modes)[pressed], np.hstack(forces)[pressed])
        identity = np.eye(len(pressed))[:, pressed]
        return LoadFree(identity @ space.pressures, identity @ space.gaps)

    def _worn(self, space: LoadFree, turning: np.ndarray) -> tuple[WornBody, ...]:
        """Wear of the faces by body."""
        system, found = self.system, dict[int, np.ndarray]()
        pressed = dense(system.basis) @ space.pressures
        laws = zip(system.laws.items(), system.spreads.values(), strict=True)
        for row, ((side, law), spread) in enumerate(laws):
            slope = self.conditions.wear_slope(row, law, self.pressure)
            worn = spread.rate(slope[:, None] * pressed)
            for (_, points), bodies in zip(system.contacts, system.contacts.bodies, strict=True):
                own = np.zeros_like(worn)
                own[points] = worn[points]
                rate = space.gaps.T @ (system.contact.weighted.T @ own)
                found[bodies[side]] = found.get(bodies[side], np.zeros_like(rate)) + rate
        return tuple(
            WornBody(rate, float(turning[body])) for body, rate in found.items() if rate.any()
        )

    def _slowest(self, number: float) -> float:
        """Rate of heat diffusion in the best conductor over a wave, or over the contact."""
        body = self.system.model.bodies[self.reference]
        diffusivity = _largest(body, "conductivity") / max(
            m.capacity or 0.0 for m in body.materials.values()
        )
        size = min(pairing.extent for pairing in self.system.contacts.each)
        return diffusivity * max(self.wave_number(number), 1 / size) ** 2

    def _frames(self, turning: np.ndarray) -> tuple[float, ...]:
        """Angular frequencies of the bodies, that of the best conductor first."""
        others = {k for pair in self.system.contacts.bodies for k in pair} - {self.reference}
        found = [0.0]
        for body in sorted(others):
            if not any(abs(turning[body] - known) < 1e-12 for known in found):
                found.append(float(turning[body]))
        return tuple(found)


def _largest(body, name: str) -> float:
    return max(getattr(material, name) or 0.0 for material in body.materials.values())

"""Equations of the waves of a system, by their number and parity."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...bulk.waves import Wave, wave_along
from ...contact.operators.pressure import dense
from ...laws.stability import LoadFree, load_free
from ...laws.waves import WaveEquations, WaveHeat, WornBody
from ..system.conditions import InterfaceConditions
from ..system.system import System
from .body_speeds import body_speeds
from .supports import Symmetry
from .wave_conduction import WaveConduction, wave_conduction
from .wave_elasticity import WaveElasticity, wave_elasticity


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

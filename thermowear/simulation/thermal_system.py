"""The conducting bodies of a case, and how heat crosses their contact."""

from __future__ import annotations

from dataclasses import dataclass

from petsc4py import PETSc

import numpy as np

from ..bulk.bodies import Bodies
from ..bulk.conduction import Conduction, conduction
from ..bulk.elasticity import Elasticity
from ..bulk.field import lagrange_space
from ..bulk.kinematics import Model
from ..case.schema import Case
from ..contact.heat import InterfaceHeat, bath_matrix, condense_heat
from ..contact.pairing import Pairing
from ..contact.traces import value_trace
from .phases import Phases


@dataclass(frozen=True)
class ThermalSystem:
    """The conducting bodies and their share in the interface.

    Attributes
    ----------
    conduction : Conduction
    load : petsc4py.PETSc.Mat
        G: nodal forces per nodal rise [N/K].
    face : InterfaceHeat
    ambient : float
        [K]
    """

    conduction: Conduction
    load: PETSc.Mat
    face: InterfaceHeat
    ambient: float

    def forces(self, rise: np.ndarray) -> np.ndarray:
        """Nodal forces of a temperature rise, owned rows [N]."""
        right, result = self.load.createVecs()
        right.setArray(rise)
        self.load.mult(right, result)
        return result.getArray().copy()


def thermal_system(
    case: Case,
    bodies: Bodies,
    model: Model,
    pairing: Pairing,
    elastic: Elasticity,
    basis: np.ndarray,
    phases: Phases,
) -> ThermalSystem | None:
    """Assemble and condense conduction; None without heat. Every rank calls."""
    heat = case.heat
    if heat is None:
        return None
    with phases("assemble conduction"):
        space = lagrange_space(bodies.mesh, case.mesh.degree)
        upper, lower = pairing.sides
        traces = (value_trace(space, upper), value_trace(space, lower))
        conductivities, cooling = _round_the_ring(case)
        shift = max(conductivities.values()) / pairing.extent
        given = {name: value - heat.ambient for name, value in heat.temperature.items()}
        bath = bath_matrix(space, traces, pairing.weights, shift)
        conducting = conduction(bodies, model, space, conductivities, cooling, given, bath)
        load = elastic.thermal_load(space)
    with phases("condense conduction"):
        face = condense_heat(
            conducting, pairing.weights, basis, traces, shift, heat.conductance, heat.partition
        )
    return ThermalSystem(conducting, load, face, heat.ambient)


def _round_the_ring(case: Case) -> tuple[dict[str, float], dict[str, float]]:
    """Conductivities by body and heat transfer by surface, for the modelled sector.

    Under a body 1 that takes up a sector, all of a turning body 2 comes by and is heated: what
    conducts and cools is the whole ring.
    """
    assert case.heat is not None
    moving, sector = case.geometry.bodies[1], case.geometry.sector
    conductivities = {b: case.material(b).conductivity or 0.0 for b in case.geometry.parts}
    conductivities[moving] /= sector
    whole = {
        s: h / sector if s.startswith(f"{moving}_") else h for s, h in case.heat.cooling.items()
    }
    return conductivities, whole

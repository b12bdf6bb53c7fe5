"""Cache of heat exchanges: of large faces, only the first is factorised as the contact changes."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass

import numpy as np

from ...bulk.heat.conduction import Conduction
from ...contact.operators.coupled_heat import AnyExchange, AnyFace
from ...contact.operators.heat_exchange import (
    CoupledDistortion,
    HeatExchange,
    InterfaceHeat,
    ReferenceExchange,
)
from ...contact.operators.thermal_opening import ThermalDistortion, condense_distortion
from ..system.setup_cache import SetupCache
from ..system.system import System

_FEW = 1500
"""Number of nodes of both faces up to which each exchange is factorised."""
_SMALL = 500
"""Number of nodes of both faces up to which several exchanges are kept, also for later cases."""
_KEPT = 4
"""Number of exchanges kept of small and of large faces: those of the stages of a step and its
halves."""


@dataclass
class KnownExchange:
    """Exchange of heat for one conductance, with what has been computed from it.

    Attributes
    ----------
    exchange : HeatExchange or CoupledExchange
    distortion : CoupledDistortion or None
    compliance : tuple of bytes and ndarray, or None
        Thermal compliance (m, m), with the heating that it belongs to.
    """

    exchange: AnyExchange
    distortion: CoupledDistortion | None = None
    compliance: tuple[bytes, np.ndarray] | None = None


class ExchangeCache:
    """Exchanges of the last conductances.

    Parameters
    ----------
    face : InterfaceHeat or CoupledHeat
    """

    def __init__(self, face: AnyFace):
        self._face = face
        self._known: OrderedDict[bytes, KnownExchange] = OrderedDict()
        self._reference: KnownExchange | None = None

    def of(self, conductance: np.ndarray) -> KnownExchange:
        """Exchange for conductances at the points, shape (n,)."""
        key = conductance.tobytes()
        if key not in self._known:
            self._known[key] = self._changed(conductance) or self._made(conductance)
            if len(self._known) > _KEPT:
                self._known.popitem(last=False)
        self._known.move_to_end(key)
        return self._known[key]

    def distortion(self, known: KnownExchange, uncoupled: ThermalDistortion) -> CoupledDistortion:
        """Distortion of faces that exchange heat, from that of the uncoupled ones."""
        assert isinstance(known.exchange, HeatExchange)
        before, reference = None, self._reference
        if reference is not None and reference is not known:
            before = reference.distortion or self.distortion(reference, uncoupled)
            reference.distortion = before
        return uncoupled.coupled(known.exchange, before)

    def _changed(self, conductance: np.ndarray) -> KnownExchange | None:
        """Exchange that follows from the reference, if there is one."""
        if self._reference is None:
            return None
        assert isinstance(self._reference.exchange, ReferenceExchange)
        exchange = self._reference.exchange.changed(conductance)
        return None if exchange is None else KnownExchange(exchange)

    def _made(self, conductance: np.ndarray) -> KnownExchange:
        """Factorised exchange; a reference for others if the faces are large."""
        self._reference = None
        face, few = self._face, is_small(self._face)
        if not few:
            self._known.clear()  # frees its memory
        if few or not isinstance(face, InterfaceHeat) or face_nodes(face) <= _FEW:
            return KnownExchange(face.exchange(conductance))
        self._reference = KnownExchange(ReferenceExchange(face, conductance))
        return self._reference


def exchange_cache(system: System, conduction: Conduction, face: AnyFace) -> ExchangeCache:
    """Exchanges of the faces; steady, linear ones of small faces are shared with later cases.

    Parameters
    ----------
    system : System
    conduction : Conduction
        Steady, or of a time step or a tangent.
    face : InterfaceHeat or CoupledHeat
    """
    thermal = system.thermal
    steady = thermal is not None and conduction is thermal.conduction and not thermal.varies
    if not (steady and is_small(face)):
        return ExchangeCache(face)
    key = system.inputs.conduction, np.asarray(face.partition).tobytes()
    return system.parts.get("exchanges", key, lambda: ExchangeCache(face))


def is_small(face: AnyFace) -> bool:
    """Test for condensed faces of few nodes."""
    return isinstance(face, InterfaceHeat) and face_nodes(face) <= min(_SMALL, _FEW)


def face_nodes(face: InterfaceHeat) -> int:
    """Number of nodes of both faces."""
    return sum(nodes.count for nodes in face.nodes)


def thermal_distortion(
    system: System, conduction: Conduction, face: AnyFace, slopes: list[np.ndarray]
) -> ThermalDistortion:
    """Weak gap per heat at the uncoupled faces. Every rank calls.

    Parameters
    ----------
    system : System
    conduction : Conduction
        Steady, or of a time step or a tangent; the latter are not shared with other systems.
    face : InterfaceHeat
    slopes : list of ndarray, shape (n_owned,)
        Excess rises of temperature-dependent expansions per rise.
    """
    assert isinstance(face, InterfaceHeat)
    steady = system.thermal is not None and conduction is system.thermal.conduction
    parts = system.parts if steady else SetupCache()
    opening = system.thermal_opening  # the distortion may have been condensed with it
    with system.phases("condense distortion"):
        return parts.get(
            "distortion",
            system.inputs.conduction,
            lambda: condense_distortion(conduction, opening, face.nodes, slopes),
        )

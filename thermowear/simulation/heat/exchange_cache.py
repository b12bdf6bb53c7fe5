"""Cache of heat exchanges: of large faces, only the first is factorised as the contact changes."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass

import numpy as np

from ...contact.operators.coupled_heat import AnyExchange, AnyFace
from ...contact.operators.exchange_update import ReferenceExchange
from ...contact.operators.heat_exchange import HeatExchange, InterfaceHeat
from ...contact.operators.thermal_opening import CoupledDistortion, ThermalDistortion

_FEW = 1500
"""Number of nodes of both faces up to which each exchange is factorised."""
_KEPT = 4
"""Number of exchanges kept of large faces: those of the stages of a step and its halves."""


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
        if known.distortion is None:
            assert isinstance(known.exchange, HeatExchange)
            before, reference = None, self._reference
            if reference is not None and reference is not known:
                before = self.distortion(reference, uncoupled)
            known.distortion = uncoupled.coupled(known.exchange, before)
        return known.distortion

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
        self._known.clear()  # frees its memory
        face = self._face
        if not isinstance(face, InterfaceHeat) or sum(n.count for n in face.nodes) <= _FEW:
            return KnownExchange(face.exchange(conductance))
        self._reference = KnownExchange(ReferenceExchange(face, conductance))
        return self._reference

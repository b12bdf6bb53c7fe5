"""Result of an analysis: interface, profile, summary, histories and fields."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .hot_spots import GrowthRow, HotSpotMode, HotSpotRow
from .points import FrictionInterface, InterfaceFields, Modes, Profile, WornTrack, by_contact
from .quantity import from_key, table_of
from .rows import (
    ContactRow,
    CycleRow,
    HeatRow,
    HistoryRow,
    HolderRow,
    LoadRow,
    ProbeRow,
    StickRow,
    TangentialRow,
)


@dataclass(frozen=True)
class FrictionHistory:
    """Results of a fretting analysis beside the interface.

    Attributes
    ----------
    rows : list of LoadRow
    cycles : list of CycleRow
        Computed cycles, without those skipped by cycle jumps.
    last : FrictionInterface
        Stick-slip state at the end.
    outputs : dict of float to FrictionInterface
        Stick-slip states at the output times.
    sticking : list of StickRow
        Contacts of several bodies by increment.
    holders : list of HolderRow
        Holders of several bodies by increment.
    tangential : list of TangentialRow
        Tangential loads of bodies in space by increment and holder.
    """

    rows: list[LoadRow]
    cycles: list[CycleRow]
    last: FrictionInterface
    outputs: dict[float, FrictionInterface]
    sticking: list[StickRow] = field(default_factory=list)
    holders: list[HolderRow] = field(default_factory=list)
    tangential: list[TangentialRow] = field(default_factory=list)


@dataclass(frozen=True)
class HotSpots:
    """Results of a search for hot spots.

    Attributes
    ----------
    rows : list of HotSpotRow
        Critical speeds by number and symmetry.
    growth : list of GrowthRow
        First hot spots over the speed.
    first : HotSpotMode or None
        Mode of the first hot spots, on rank 0 only.
    """

    rows: list[HotSpotRow]
    growth: list[GrowthRow]
    first: HotSpotMode | None


@dataclass(frozen=True)
class TrackHistory:
    """Results of a reciprocating analysis beside the interface.

    Attributes
    ----------
    last : WornTrack
        Worn track at the end.
    outputs : dict of float to WornTrack
        Worn tracks at the output times.
    """

    last: WornTrack
    outputs: dict[float, WornTrack]


@dataclass(frozen=True)
class BodyFields:
    """Fields on a fine grid of points in each cell, on rank 0.

    Attributes
    ----------
    points : ndarray, shape (n_cells, n_points, gdim) [m]
    pieces : ndarray of int, shape (n_pieces, n_corners)
        Small triangles or quadrilaterals between the points of one cell; in space tetrahedra or
        hexahedra.
    body : ndarray of int, shape (n_cells,)
        Number of the body, from 1.
    displacement : ndarray, shape (n_cells, n_points, gdim) [m]
    temperature : ndarray or None, shape (n_cells, n_points) [K]
    von_mises : ndarray, shape (n_cells, n_points) [Pa]
    """

    points: np.ndarray
    pieces: np.ndarray
    body: np.ndarray
    displacement: np.ndarray
    temperature: np.ndarray | None
    von_mises: np.ndarray

    @property
    def blocks(self) -> tuple[BodyFields, ...]:
        """Only these fields, as all cells are of one type; see `MixedFields`."""
        return (self,)


@dataclass(frozen=True)
class MixedFields:
    """Fields of bodies whose cells differ in type or order, on rank 0.

    Attributes
    ----------
    blocks : tuple of BodyFields
        Fields in the cells of each type and order, in the order of the bodies.
    """

    blocks: tuple[BodyFields, ...]


AnyFields = BodyFields | MixedFields
"""Fields of the bodies; `blocks` lists those in cells of one type and order."""

FIELDS = {
    "displacement": from_key("displacement_m"),
    "temperature": from_key("temperature_K", unit="°C"),
    "von_mises": from_key("von_mises_Pa", "von Mises stress", "MPa"),
}
"""Quantities of ``fields.vtu`` by the names of the fields."""


@dataclass(frozen=True)
class Frame:
    """Intermediate state, for an animation.

    Attributes
    ----------
    number : int
        Number of the step that ends in this state.
    every : int
        Earlier frames whose number is no multiple of this are discarded.
    time : float
        [s]
    interface : InterfaceFields
    fields : BodyFields, MixedFields or None
        Fields of the bodies, on rank 0 only.
    track : WornTrack or None
        Worn track of a reciprocating analysis.
    contacts : dict of str to slice
        Ranges of the points of each contact that has a name, by name.
    """

    number: int
    every: int
    time: float
    interface: InterfaceFields
    fields: AnyFields | None
    track: WornTrack | None = None
    contacts: dict[str, slice] = field(default_factory=dict)


@dataclass(frozen=True)
class Result:
    """Result of a finished (or interrupted) analysis.

    Attributes
    ----------
    interface : InterfaceFields
        Interface at the end.
    profile : Profile
    summary : dict
        Numbers in SI, the unit in each key.
    history : list of HistoryRow
        Steps of a transient analysis.
    outputs : dict of float to InterfaceFields
        Interface at the output times, by time [s].
    friction : FrictionHistory or None
        Results of a fretting analysis.
    track : TrackHistory or None
        Results of a reciprocating analysis.
    heat : list of HeatRow
        Heat history in transient conduction.
    modes : Modes or None
        Results of a stability analysis.
    stopped : BaseException or None
        Exception that stopped the run early.
    fields : BodyFields, MixedFields or None
        Fields of the bodies, on rank 0 only.
    contacts : dict of str to slice
        Ranges of the points of each contact that has a name, by name.
    contact_history : list of ContactRow
        Contacts of several bodies at the steps of a transient analysis.
    hot_spots : HotSpots or None
        Results of a stability analysis with hot spots.
    probe_history : list of ProbeRow
        Temperatures at the probes at the steps of a transient analysis.
    """

    interface: InterfaceFields
    profile: Profile
    summary: dict
    history: list[HistoryRow] = field(default_factory=list)
    outputs: dict[float, InterfaceFields] = field(default_factory=dict)
    friction: FrictionHistory | None = None
    track: TrackHistory | None = None
    heat: list[HeatRow] = field(default_factory=list)
    modes: Modes | None = None
    stopped: BaseException | None = None
    fields: AnyFields | None = None
    contacts: dict[str, slice] = field(default_factory=dict)
    contact_history: list[ContactRow] = field(default_factory=list)
    hot_spots: HotSpots | None = None
    probe_history: list[ProbeRow] = field(default_factory=list)

    def tables(self) -> dict[str, Any]:
        """Tables by the names of their files without ``.csv``: points at the end, or rows.

        Those of the points of several contacts end in the name of the contact.
        """
        friction, at_points = self.friction, list[Any]([self.interface, self.profile])
        rows: list = [self.history, self.heat, self.contact_history, self.probe_history]
        if self.modes is not None:
            at_points.append(self.modes)
        if friction is not None:
            at_points.append(friction.last)
            rows += [friction.rows, friction.cycles, friction.sticking, friction.holders]
            rows.append(friction.tangential)
        if self.hot_spots is not None:
            rows += [self.hot_spots.rows, self.hot_spots.growth]
        if self.track is not None:
            at_points.append(self.track.last)
        of_contacts = {
            f"{table_of(points).stem}_{name}": part
            for points in at_points
            for name, part in by_contact(points, self.contacts).items()
        }
        found = [*([] if self.contacts else at_points), *rows]
        return of_contacts | {table_of(content).stem: content for content in found if content}

    def columns(self, name: str) -> dict[str, np.ndarray]:
        """Columns of a table in SI by their names in files, as `pandas.DataFrame` takes them.

        Parameters
        ----------
        name : str
            Name of the file without ``.csv``, such as "interface" or "history".
        """
        content = self.tables()[name]
        return table_of(content).arrays(content)

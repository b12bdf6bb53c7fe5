"""Result of a run: interface, profile, summary, histories and fields."""

from __future__ import annotations

from dataclasses import dataclass, field, fields

import numpy as np

from .rows import CycleRow, HeatRow, HistoryRow, LoadRow


@dataclass(frozen=True)
class InterfaceFields:
    """State of the interface, one entry per contact point; names, units as in ``interface.csv``.

    Without ``[heat]`` temperatures and fluxes are NaN. Temperatures are absolute.
    """

    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    s: np.ndarray
    weight: np.ndarray
    pressure: np.ndarray
    gap: np.ndarray
    shape: np.ndarray
    wear_1: np.ndarray
    wear_2: np.ndarray
    wear_rate_1: np.ndarray
    wear_rate_2: np.ndarray
    temperature_1: np.ndarray
    temperature_2: np.ndarray
    heat_flux_1: np.ndarray
    heat_flux_2: np.ndarray

    def columns(self) -> list[np.ndarray]:
        return [getattr(self, field.name) for field in fields(self)]


@dataclass(frozen=True)
class Profile:
    """Worn shape, one entry per contact point; names and units as in ``profile.csv``.

    The shape is the height of the unloaded face above its deepest worn point, along the normal and
    along the load direction; the wear rates are sums over both bodies along the same directions.
    """

    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    s: np.ndarray
    normal_x: np.ndarray
    normal_y: np.ndarray
    normal_z: np.ndarray
    shape: np.ndarray
    shape_along_press: np.ndarray
    wear_rate: np.ndarray
    wear_rate_along_press: np.ndarray


@dataclass(frozen=True)
class FrictionInterface:
    """Stick-slip state at the contact points; names and units as in ``friction.csv``.

    Signs as in `thermowear.contact.operators.tangential`.
    """

    x: np.ndarray
    y: np.ndarray
    s: np.ndarray
    weight: np.ndarray
    pressure: np.ndarray
    shear: np.ndarray
    slip: np.ndarray
    dissipated: np.ndarray
    status: np.ndarray


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
    """

    rows: list[LoadRow]
    cycles: list[CycleRow]
    last: FrictionInterface
    outputs: dict[float, FrictionInterface]


@dataclass(frozen=True)
class WornTrack:
    """Wear of body 2 along its track in reciprocating sliding; names, units as in ``track.csv``."""

    x: np.ndarray
    wear_2: np.ndarray
    wear_rate_2: np.ndarray


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
class Modes:
    """Pressure perturbation modes, one entry per contact point and mode; as in ``mode.csv``.

    The largest value of each is 1. The first is the fastest growing mode at the given speed, if any
    grows; then follows the critical mode, if oscillatory; then the stationary modes of zero growth
    rate, each at its own speed.
    """

    mode: np.ndarray
    speed_factor: np.ndarray
    growth_rate: np.ndarray
    frequency: np.ndarray
    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    s: np.ndarray
    pressure: np.ndarray
    pressure_imaginary: np.ndarray


@dataclass(frozen=True)
class BodyFields:
    """Fields on a fine grid of points in each cell, on rank 0.

    Attributes
    ----------
    points : ndarray, shape (n_cells, n_points, gdim) [m]
    pieces : ndarray of int, shape (n_pieces, 3 or 4)
        Small triangles or quadrilaterals between the points of one cell.
    body : ndarray of int, shape (n_cells,)
        Number of the body, 1 or 2.
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
    fields : BodyFields or None
        Fields of the bodies, on rank 0 only.
    track : WornTrack or None
        Worn track of a reciprocating analysis.
    """

    number: int
    every: int
    time: float
    interface: InterfaceFields
    fields: BodyFields | None
    track: WornTrack | None = None


@dataclass(frozen=True)
class Result:
    """Result of a finished (or interrupted) run.

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
    fields : BodyFields or None
        Fields of the bodies, on rank 0 only.
    friction : FrictionHistory or None
        Results of a fretting analysis.
    track : TrackHistory or None
        Results of a reciprocating analysis.
    stopped : BaseException or None
        Exception that stopped the run early.
    heat : list of HeatRow
        Heat history in transient conduction.
    modes : Modes or None
        Results of a stability analysis.
    """

    interface: InterfaceFields
    profile: Profile
    summary: dict
    history: list[HistoryRow]
    outputs: dict[float, InterfaceFields]
    fields: BodyFields | None
    friction: FrictionHistory | None = None
    track: TrackHistory | None = None
    stopped: BaseException | None = None
    heat: list[HeatRow] = field(default_factory=list)
    modes: Modes | None = None

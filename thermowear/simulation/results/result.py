"""What a run returns."""

from __future__ import annotations

from dataclasses import dataclass, field, fields

import numpy as np

from .rows import CycleRow, HeatRow, HistoryRow, LoadRow


@dataclass(frozen=True)
class Interface:
    """The contact points, one entry a point; names and units are those of ``interface.csv``.

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
    """The worn shape, one entry a contact point; names and units are those of ``profile.csv``.

    The shape is the height of the unloaded face over its deepest worn point, along the normal and
    along the press; likewise the wear rates of both bodies together.
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
    """Sticking and slipping at the contact points; names and units are those of ``friction.csv``.

    The signs are those of `thermowear.contact.operators.tangential`.
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
    """What a fretting analysis finds beside the interface.

    Attributes
    ----------
    rows : list of LoadRow
    cycles : list of CycleRow
        Those that were computed.
    last : FrictionInterface
    outputs : dict of float to FrictionInterface
        At the output times.
    """

    rows: list[LoadRow]
    cycles: list[CycleRow]
    last: FrictionInterface
    outputs: dict[float, FrictionInterface]


@dataclass(frozen=True)
class WornTrack:
    """What body 2 loses where body 1 slides to and fro; names and units as in ``track.csv``."""

    x: np.ndarray
    wear_2: np.ndarray
    wear_rate_2: np.ndarray


@dataclass(frozen=True)
class TrackHistory:
    """What a reciprocating analysis finds beside the interface.

    Attributes
    ----------
    last : WornTrack
    outputs : dict of float to WornTrack
        At the output times.
    """

    last: WornTrack
    outputs: dict[float, WornTrack]


@dataclass(frozen=True)
class Modes:
    """Disturbances of the pressure, one entry a contact point and mode; as in ``mode.csv``.

    The largest value of each is 1. First comes what grows fastest at the given speed, if anything
    grows; then what begins to grow at the critical speed, if it swings; then what neither grows nor
    dies out, each at its own speed.
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
        1 or 2.
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
    """A state on the way, for an animation.

    Attributes
    ----------
    number : int
        Of the step that ends in it.
    every : int
        Earlier frames whose number is no multiple of this are given up.
    time : float
        [s]
    interface : Interface
    fields : BodyFields or None
        On rank 0.
    track : WornTrack or None
        Of a reciprocating analysis.
    """

    number: int
    every: int
    time: float
    interface: Interface
    fields: BodyFields | None
    track: WornTrack | None = None


@dataclass(frozen=True)
class Result:
    """A finished (or interrupted) run.

    Attributes
    ----------
    interface : Interface
        At the end.
    profile : Profile
    summary : dict
        SI, the unit in the key.
    history : list of HistoryRow
        Of a transient analysis.
    outputs : dict of float to Interface
        At the output times.
    fields : BodyFields or None
        On rank 0.
    friction : FrictionHistory or None
        Of a fretting analysis.
    track : TrackHistory or None
        Of a reciprocating analysis.
    stopped : Exception or None
        What ended the run before its time.
    heat : list of HeatRow
        Of an analysis that follows temperatures in time.
    modes : Modes or None
        Of a stability analysis.
    """

    interface: Interface
    profile: Profile
    summary: dict
    history: list[HistoryRow]
    outputs: dict[float, Interface]
    fields: BodyFields | None
    friction: FrictionHistory | None = None
    track: TrackHistory | None = None
    stopped: BaseException | None = None
    heat: list[HeatRow] = field(default_factory=list)
    modes: Modes | None = None

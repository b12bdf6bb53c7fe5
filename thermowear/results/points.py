"""Tables of the contact points, and of the points of a track."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from typing import TypeVar

import numpy as np

from .quantity import as_in, column, table, table_of

_TRACK = "of a body that is passed over"


@table(
    "interface",
    "Contact at the end",
    "one row per contact point: position, area, pressure, gap, shape, wear depths and rates, "
    "temperatures, heat fluxes, coating left",
    at_times=True,
)
class InterfaceFields:
    """State of the interface, one entry per contact point.

    Without ``[heat]`` temperatures and fluxes are NaN, without layers what is left of them.
    Temperatures are absolute.
    """

    x: np.ndarray = column("x", "m", "mm", "r in axisymmetric models")
    y: np.ndarray = column("y", "m", "mm", "z in axisymmetric models")
    z: np.ndarray = column("z", "m", "mm", "0 in plane and axisymmetric models")
    s: np.ndarray = column("position along the contact", "m", "mm", "arc length; nan in 3D models")
    weight: np.ndarray = column("area weight", "m²", "mm²", "of the whole ring or thickness")
    pressure: np.ndarray = column("contact pressure", "Pa", "MPa")
    gap: np.ndarray = column("gap", "m", "µm", "distance of the faces, positive if open")
    shape: np.ndarray = column(
        "shape of the unloaded face", "m", "µm", "height of the cold face above its lowest point"
    )
    wear_1: np.ndarray = column("wear depth, body 1", "m", "µm")
    wear_2: np.ndarray = column("wear depth, body 2", "m", "µm")
    wear_rate_1: np.ndarray = column("wear rate, body 1", "m/s", "nm/s")
    wear_rate_2: np.ndarray = column("wear rate, body 2", "m/s", "nm/s")
    temperature_1: np.ndarray = column("temperature, body 1", "K", "°C")
    temperature_2: np.ndarray = column("temperature, body 2", "K", "°C")
    heat_flux_1: np.ndarray = column("heat flux, body 1", "W/m²", "kW/m²", "into the body")
    heat_flux_2: np.ndarray = column("heat flux, body 2", "W/m²", "kW/m²", "into the body")
    coating_left_1: np.ndarray = column(
        "coating left, body 1", "m", "µm", "of all layers; only of coated faces", optional=True
    )
    coating_left_2: np.ndarray = column(
        "coating left, body 2", "m", "µm", "of all layers; only of coated faces", optional=True
    )
    fluid_pressure: np.ndarray = column(
        "fluid pressure",
        "Pa",
        "MPa",
        "besides the contact pressure; only where it is given",
        optional=True,
    )


@table(
    "profile",
    "Worn shape at the end",
    "worn shape and wear rates along the normal and along the load direction, with normals",
)
class Profile:
    """Worn shape, one entry per contact point.

    The shape is the height of the unloaded face above its deepest worn point, along the normal and
    along the load direction; the wear rates are sums over both bodies along the same directions.
    """

    x: np.ndarray = as_in(InterfaceFields)
    y: np.ndarray = as_in(InterfaceFields)
    z: np.ndarray = as_in(InterfaceFields)
    s: np.ndarray = as_in(InterfaceFields)
    normal_x: np.ndarray = column("normal, x")
    normal_y: np.ndarray = column("normal, y")
    normal_z: np.ndarray = column("normal, z")
    shape: np.ndarray = as_in(InterfaceFields)
    shape_along_press: np.ndarray = column("shape along the load direction", "m", "µm")
    wear_rate: np.ndarray = column("normal wear rate", "m/s", "nm/s", "sum over both bodies")
    wear_rate_along_press: np.ndarray = column(
        "wear rate along the load direction", "m/s", "nm/s", "sum over both bodies"
    )


@table(
    "friction",
    "Friction at the end",
    "fretting: one row per contact point with shear, slip, dissipated energy and status",
    at_times=True,
)
class FrictionInterface:
    """Stick-slip state at the contact points."""

    x: np.ndarray = as_in(InterfaceFields)
    y: np.ndarray = as_in(InterfaceFields)
    s: np.ndarray = as_in(InterfaceFields)
    weight: np.ndarray = as_in(InterfaceFields)
    pressure: np.ndarray = as_in(InterfaceFields)
    shear: np.ndarray = column(
        "shear traction on body 1",
        "Pa",
        "MPa",
        "along +x, or +y on a face along y; in space its magnitude",
    )
    slip: np.ndarray = column("slip of body 1", "m", "µm", "relative to body 2, likewise")
    dissipated: np.ndarray = column("dissipated energy", "J/m²", meaning="since the start")
    status: np.ndarray = column("status (0 open, 1 stick, 2 slip)")
    z: np.ndarray = column("z", "m", "mm", "in space", optional=True)
    shear_x: np.ndarray = column("shear traction along x", "Pa", "MPa", "in space", optional=True)
    shear_y: np.ndarray = column("shear traction along y", "Pa", "MPa", "in space", optional=True)
    shear_z: np.ndarray = column("shear traction along z", "Pa", "MPa", "in space", optional=True)
    slip_x: np.ndarray = column("slip along x", "m", "µm", "in space", optional=True)
    slip_y: np.ndarray = column("slip along y", "m", "µm", "in space", optional=True)
    slip_z: np.ndarray = column("slip along z", "m", "µm", "in space", optional=True)


@table(
    "track",
    "Track at the end",
    "reciprocating: wear depth and rate along the body that is passed over",
    at_times=True,
)
class WornTrack:
    """Wear along the tracks in reciprocating sliding, NaN for the bodies that pass over them.

    Tracks of several contacts follow one another; `counts` has their numbers of points.
    """

    x: np.ndarray = as_in(InterfaceFields)
    y: np.ndarray = column("y", "m", "mm", "in space", optional=True)
    z: np.ndarray = column("z", "m", "mm", "in space", optional=True)
    weight: np.ndarray = column("area weight", "m²", "mm²", "in space", optional=True)
    wear_1: np.ndarray = column("wear depth, body 1", "m", "µm", _TRACK, optional=True)
    wear_2: np.ndarray = column("wear depth, body 2", "m", "µm", _TRACK, optional=True)
    wear_rate_1: np.ndarray = column("wear rate, body 1", "m/s", "nm/s", _TRACK, optional=True)
    wear_rate_2: np.ndarray = column("wear rate, body 2", "m/s", "nm/s", _TRACK, optional=True)
    counts: tuple[int, ...] = ()


@table(
    "mode",
    "Pressure perturbations",
    "stability: one row per contact point of each mode, with its speed factor, growth rate and "
    "frequency",
)
class Modes:
    """Pressure perturbation modes, one entry per contact point and mode.

    The largest value of each is 1. The first is the fastest growing mode at the given speed, if any
    grows; then follows the critical mode, if oscillatory; then the stationary modes of zero growth
    rate, each at its own speed.
    """

    mode: np.ndarray = column("mode")
    speed_factor: np.ndarray = column("speed factor", meaning="speed of the mode, times the given")
    growth_rate: np.ndarray = column("growth rate", "1/s")
    frequency: np.ndarray = column("angular frequency", "rad/s")
    x: np.ndarray = as_in(InterfaceFields)
    y: np.ndarray = as_in(InterfaceFields)
    z: np.ndarray = as_in(InterfaceFields)
    s: np.ndarray = as_in(InterfaceFields)
    pressure: np.ndarray = column("pressure perturbation", meaning="largest value 1")
    pressure_imaginary: np.ndarray = column("perturbation, imaginary part")


Points = TypeVar("Points")


def by_contact(points: Points, contacts: Mapping[str, slice]) -> dict[str, Points]:
    """Points of each of several contacts by its name, from the ranges of the contact points.

    A worn track has points of its own; modes repeat the points one after the other.
    """
    ranges: list[slice | np.ndarray] = list(contacts.values())
    if isinstance(points, WornTrack) and contacts:
        ends = np.cumsum([0, *points.counts])
        ranges = [slice(int(a), int(b)) for a, b in pairwise(ends)]
    if isinstance(points, Modes) and contacts:
        count = max(own.stop for own in contacts.values())
        every = np.arange(len(points.mode)).reshape(-1, count)
        ranges = [every[:, own].ravel() for own in contacts.values()]
    return {name: part_of(points, own) for name, own in zip(contacts, ranges, strict=True)}


def part_of(points: Points, chosen: slice | np.ndarray) -> Points:
    """Table of some of the points of a table, by their range or their indices."""
    columns = {name: getattr(points, name)[chosen] for name in table_of(points).columns}
    return replace(points, **columns)  # type: ignore[type-var]

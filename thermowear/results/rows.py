"""Rows of the history tables that grow during a run."""

from __future__ import annotations

from .quantity import as_in, column, table


@table(
    "history", "History, one row per step", "one row per time step of a transient run", grows=True
)
class HistoryRow:
    """Step of a running-in.

    In reciprocating sliding, friction power and force are means over the cycle, and the largest
    wear depth of body 2 is that of its track. NaN: a quantity that does not exist.
    """

    time: float = column("time", "s")
    sliding_distance: float = column("sliding distance", "m", meaning="at the mean speed")
    max_pressure: float = column("largest pressure", "Pa", "MPa")
    contact_area: float = column("contact area", "m²", "mm²", "sum over the points in contact")
    wear_volume_1: float = column("worn volume, body 1", "m³", "mm³")
    wear_volume_2: float = column("worn volume, body 2", "m³", "mm³")
    max_temperature: float = column("highest temperature", "K", "°C")
    approach: float = column("approach", "m", "µm", "of the holder along the load direction")
    step: float = column("time step", "s")
    error: float = column("time step error", meaning="relative; NaN for given time steps")
    max_wear_1: float = column("largest wear depth, body 1", "m", "µm")
    max_wear_2: float = column("largest wear depth, body 2", "m", "µm")
    friction_power: float = column("friction power", "W", "kW")
    friction_force: float = column(
        "friction force", "N", meaning="integral of its magnitude; not of several contacts"
    )
    friction_torque: float = column(
        "friction torque", "N m", meaning="about the axis of a rotation; not of several contacts"
    )


@table(
    "heat",
    "Heat, one row per step",
    "transient temperatures: one row per time step with speed, force, friction power, heat and "
    "temperatures of both faces",
    grows=True,
)
class HeatRow:
    """Step of an analysis with transient conduction.

    Heat is cumulated from the start; temperatures are those of the faces, means are taken over
    their area.
    """

    time: float = as_in(HistoryRow)
    speed: float = column("sliding speed", "m/s")
    normal_force: float = column(
        "normal force", "N", meaning="resultant of the pressure; along the load in loads, holders"
    )
    friction_power: float = as_in(HistoryRow)
    heat_in: float = column("heat input", "J", "kJ", "since the start")
    heat_stored: float = column("heat stored", "J", "kJ", "since the start")
    heat_lost: float = column("heat lost", "J", "kJ", "since the start")
    balance_error: float = column("heat balance error", header="balance_relative_error")
    max_temperature_1: float = column("largest surface temperature, body 1", "K", "°C")
    max_temperature_2: float = column("largest surface temperature, body 2", "K", "°C")
    mean_temperature_1: float = column("mean surface temperature, body 1", "K", "°C")
    mean_temperature_2: float = column("mean surface temperature, body 2", "K", "°C")


@table(
    "contacts",
    "Contacts, one row per contact and step",
    "several bodies: one row per time step and contact with its force, pressure, worn volumes and "
    "temperatures",
    grows=True,
)
class ContactRow:
    """Contact of a model of several bodies at the end of a step; bodies are those of the contact.

    Contacts are numbered in the order of the case, as listed in ``run.json``.
    """

    time: float = as_in(HistoryRow)
    contact: int = column("contact", meaning="number, in the order of the case")
    normal_force: float = as_in(HeatRow)
    friction_power: float = as_in(HeatRow)
    max_pressure: float = as_in(HistoryRow)
    contact_area: float = as_in(HistoryRow)
    wear_volume_1: float = as_in(HistoryRow)
    wear_volume_2: float = as_in(HistoryRow)
    max_temperature_1: float = as_in(HeatRow)
    max_temperature_2: float = as_in(HeatRow)


@table(
    "probes",
    "Probes, one row per probe and step",
    "temperatures at the probes: one row per time step and probe",
    grows=True,
)
class ProbeRow:
    """Temperature at a probe at the end of a step; NaN once its point has been worn off.

    Probes are numbered in the order of the case, as listed in ``run.json``.
    """

    time: float = as_in(HistoryRow)
    probe: int = column("probe", meaning="number, in the order of the case")
    temperature: float = column("temperature", "K", "°C", "at a probe")


@table(
    "cycles",
    "Cycles, one row per computed cycle",
    "fretting with wear: one row per computed cycle, with length and error of the cycle jump",
    grows=True,
)
class CycleRow:
    """Cycle of a load history at its end.

    Area and largest pressure are those of the whole cycle. ``jump`` is the length in cycles of the
    cycle jump that it ends, ``error`` relative to the largest wear depth; NaN if not estimated.
    The stick radius is that of a circle through the edge of the zone that sticks all the time,
    located inside of elements; in sections half of the width of the zone, if axisymmetric the
    distance from the axis. NaN of several contacts (in `summary`), and without such a zone.
    """

    cycle: int = column("cycle")
    time: float = as_in(HistoryRow)
    wear_volume_1: float = as_in(HistoryRow)
    wear_volume_2: float = as_in(HistoryRow)
    dissipated: float = column("dissipated energy", "J", "mJ", "since the start")
    max_wear_1: float = as_in(HistoryRow)
    max_wear_2: float = as_in(HistoryRow)
    contact_area: float = as_in(HistoryRow)
    max_pressure: float = as_in(HistoryRow)
    jump: int = column("cycle-jump length", meaning="in cycles")
    error: float = column("cycle-jump error", meaning="relative to the largest wear depth")
    stick_radius: float = column("stick radius", "m", "mm", "of the zone that does not slip")


@table(
    "loads",
    "Load history, one row per increment",
    "fretting: one row per increment with forces and displacements",
    grows=True,
)
class LoadRow:
    """Increment of a load history."""

    time: float = as_in(HistoryRow)
    normal_force: float = as_in(HeatRow)
    approach: float = as_in(HistoryRow)
    tangential_force: float = column("tangential force", "N", meaning="of the holder, along +x")
    tangential_displacement: float = column("tangential displacement", "m", "µm", "along +x")
    max_pressure: float = as_in(HistoryRow)
    contact_area: float = as_in(HistoryRow)
    stick_area: float = column("stick area", "m²", "mm²")
    dissipated: float = as_in(CycleRow)
    iterations: int = column("Newton iterations")
    cycle: int = as_in(CycleRow)
    wear_volume_1: float = as_in(HistoryRow)
    wear_volume_2: float = as_in(HistoryRow)


@table(
    "sticking",
    "Sticking, one row per contact and increment",
    "fretting of several bodies: one row per increment and contact with friction force, stick area "
    "and dissipated energy",
    grows=True,
)
class StickRow:
    """Friction of a contact of several bodies at the end of an increment.

    Contacts are numbered as in ``contacts.csv``.
    """

    time: float = as_in(HistoryRow)
    contact: int = as_in(ContactRow)
    friction_force: float = column(
        "friction force",
        "N",
        meaning="on the first body, along +x, or +y if pressed along x; in space its magnitude",
    )
    stick_area: float = as_in(LoadRow)
    dissipated: float = as_in(CycleRow)
    cycle: int = as_in(CycleRow)


@table(
    "holders",
    "Holders, one row per holder and increment",
    "fretting of several bodies: one row per increment and holder with its forces and "
    "displacements",
    grows=True,
)
class HolderRow:
    """Forces of a holder on its bodies at the end of an increment, and its motion at the pivot.

    Holders are numbered in the order of the case. Tangential is along x, or along y for a holder
    that is pressed along x; moments and rotations are anticlockwise.
    """

    time: float = as_in(HistoryRow)
    holder: int = column("holder", meaning="number, in the order of the case")
    normal_force: float = as_in(HeatRow)
    approach: float = as_in(HistoryRow)
    tangential_force: float = column("tangential force", "N", meaning="of the holder")
    tangential_displacement: float = column("tangential displacement", "m", "µm")
    moment: float = column("moment", "N m", meaning="of the holder about its pivot")
    rotation: float = column("rotation", "rad")


@table(
    "tangential",
    "Tangential loads, one row per holder and increment",
    "fretting in space: one row per increment and holder with forces and displacements along x and "
    "y, torque and twist",
    grows=True,
)
class TangentialRow:
    """Forces of a holder on its bodies in space across its load direction, and its motion.

    Displacements are those of its pivot; torque and twist are about the axis through the pivot
    against the load direction, by the right-hand rule. Holders are numbered in the order of the
    case.
    """

    time: float = as_in(HistoryRow)
    holder: int = as_in(HolderRow)
    force_x: float = column("tangential force along x", "N")
    force_y: float = column("tangential force along y", "N")
    displacement_x: float = column("displacement along x", "m", "µm")
    displacement_y: float = column("displacement along y", "m", "µm")
    torque: float = column("torque", "N m", "N m")
    twist: float = column("twist", "rad", "mrad")

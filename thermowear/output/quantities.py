"""Names, units and labels of all columns that are written or drawn, and of the phases of a run."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Quantity:
    """Column of a results file, with the label and unit of its plots.

    Attributes
    ----------
    header : str
        Column name with its SI unit.
    label : str
        Axis label without the unit.
    unit : str
        Unit of plots.
    scale, offset : float
        Plotted value = scale · SI value + offset.
    """

    header: str
    label: str
    unit: str
    scale: float = 1.0
    offset: float = 0.0

    @property
    def axis(self) -> str:
        return f"{self.label} [{self.unit}]"

    def drawn(self, values):
        """Convert SI values to the unit of plots."""
        return self.scale * values + self.offset


def _celsius(header: str, label: str) -> Quantity:
    return Quantity(header, label, "°C", 1.0, -273.15)


INTERFACE = {
    "x": Quantity("x_m", "x", "mm", 1e3),
    "y": Quantity("y_m", "y", "mm", 1e3),
    "z": Quantity("z_m", "z", "mm", 1e3),
    "s": Quantity("s_m", "position along the contact", "mm", 1e3),
    "weight": Quantity("weight_m2", "area weight", "mm²", 1e6),
    "pressure": Quantity("pressure_Pa", "contact pressure", "MPa", 1e-6),
    "gap": Quantity("gap_m", "gap", "µm", 1e6),
    "shape": Quantity("shape_m", "shape of the unloaded face", "µm", 1e6),
    "wear_1": Quantity("wear_1_m", "wear depth, body 1", "µm", 1e6),
    "wear_2": Quantity("wear_2_m", "wear depth, body 2", "µm", 1e6),
    "wear_rate_1": Quantity("wear_rate_1_m_per_s", "wear rate, body 1", "nm/s", 1e9),
    "wear_rate_2": Quantity("wear_rate_2_m_per_s", "wear rate, body 2", "nm/s", 1e9),
    "temperature_1": _celsius("temperature_1_K", "temperature, body 1"),
    "temperature_2": _celsius("temperature_2_K", "temperature, body 2"),
    "heat_flux_1": Quantity("heat_flux_1_W_per_m2", "heat flux, body 1", "kW/m²", 1e-3),
    "heat_flux_2": Quantity("heat_flux_2_W_per_m2", "heat flux, body 2", "kW/m²", 1e-3),
}

PROFILE = {
    **{name: INTERFACE[name] for name in ("x", "y", "z", "s")},
    **{f"normal_{axis}": Quantity(f"normal_{axis}", f"normal, {axis}", "1") for axis in "xyz"},
    "shape": INTERFACE["shape"],
    "shape_along_press": Quantity(
        "shape_along_press_m", "shape along the load direction", "µm", 1e6
    ),
    "wear_rate": Quantity("wear_rate_m_per_s", "normal wear rate", "nm/s", 1e9),
    "wear_rate_along_press": Quantity(
        "wear_rate_along_press_m_per_s", "wear rate along the load direction", "nm/s", 1e9
    ),
}

HISTORY = {
    "time": Quantity("time_s", "time", "s"),
    "sliding_distance": Quantity("sliding_distance_m", "sliding distance", "m"),
    "max_pressure": Quantity("max_pressure_Pa", "largest pressure", "MPa", 1e-6),
    "contact_area": Quantity("contact_area_m2", "contact area", "mm²", 1e6),
    "wear_volume_1": Quantity("wear_volume_1_m3", "worn volume, body 1", "mm³", 1e9),
    "wear_volume_2": Quantity("wear_volume_2_m3", "worn volume, body 2", "mm³", 1e9),
    "max_temperature": _celsius("max_temperature_K", "largest temperature"),
    "approach": Quantity("approach_m", "approach", "µm", 1e6),
    "step": Quantity("step_s", "time step", "s"),
    "error": Quantity("error", "time step error", "1"),
}

HEAT = {
    "time": HISTORY["time"],
    "speed": Quantity("speed_m_per_s", "sliding speed", "m/s"),
    "normal_force": Quantity("normal_force_N", "normal force", "N"),
    "friction_power": Quantity("friction_power_W", "friction power", "kW", 1e-3),
    "heat_in": Quantity("heat_in_J", "heat input", "kJ", 1e-3),
    "heat_stored": Quantity("heat_stored_J", "heat stored", "kJ", 1e-3),
    "heat_lost": Quantity("heat_lost_J", "heat lost", "kJ", 1e-3),
    "balance_error": Quantity("balance_relative_error", "heat balance error", "1"),
    **{
        f"{which}_temperature_{body}": _celsius(
            f"{which}_temperature_{body}_K", f"{label} surface temperature, body {body}"
        )
        for which, label in (("max", "largest"), ("mean", "mean"))
        for body in (1, 2)
    },
}

FRICTION = {
    "x": INTERFACE["x"],
    "y": INTERFACE["y"],
    "s": INTERFACE["s"],
    "weight": INTERFACE["weight"],
    "pressure": INTERFACE["pressure"],
    "shear": Quantity("shear_Pa", "shear traction on body 1", "MPa", 1e-6),
    "slip": Quantity("slip_m", "slip of body 1", "µm", 1e6),
    "dissipated": Quantity("dissipated_J_per_m2", "dissipated energy", "J/m²"),
    "status": Quantity("status", "status (0 open, 1 stick, 2 slip)", "1"),
}

LOADS = {
    "time": HISTORY["time"],
    "normal_force": Quantity("normal_force_N", "normal force", "N"),
    "approach": HISTORY["approach"],
    "tangential_force": Quantity("tangential_force_N", "tangential force", "N"),
    "tangential_displacement": Quantity(
        "tangential_displacement_m", "tangential displacement", "µm", 1e6
    ),
    "max_pressure": HISTORY["max_pressure"],
    "contact_area": HISTORY["contact_area"],
    "stick_area": Quantity("stick_area_m2", "stick area", "mm²", 1e6),
    "dissipated": Quantity("dissipated_J", "dissipated energy", "mJ", 1e3),
    "iterations": Quantity("iterations", "Newton iterations", "1"),
    "cycle": Quantity("cycle", "cycle", "1"),
    "wear_volume_1": HISTORY["wear_volume_1"],
    "wear_volume_2": HISTORY["wear_volume_2"],
}

TRACK = {name: INTERFACE[name] for name in ("x", "wear_2", "wear_rate_2")}

MODES = {
    "mode": Quantity("mode", "mode", "1"),
    "speed_factor": Quantity("speed_factor", "speed factor", "1"),
    "growth_rate": Quantity("growth_rate_per_s", "growth rate", "1/s"),
    "frequency": Quantity("frequency_rad_per_s", "angular frequency", "rad/s"),
    **{name: INTERFACE[name] for name in ("x", "y", "z", "s")},
    "pressure": Quantity("pressure", "pressure perturbation", "1"),
    "pressure_imaginary": Quantity("pressure_imaginary", "perturbation, imaginary part", "1"),
}

CYCLES = {
    "cycle": LOADS["cycle"],
    "time": LOADS["time"],
    "wear_volume_1": LOADS["wear_volume_1"],
    "wear_volume_2": LOADS["wear_volume_2"],
    "dissipated": LOADS["dissipated"],
    "max_wear_1": Quantity("max_wear_1_m", "largest wear depth, body 1", "µm", 1e6),
    "max_wear_2": Quantity("max_wear_2_m", "largest wear depth, body 2", "µm", 1e6),
    "contact_area": LOADS["contact_area"],
    "max_pressure": LOADS["max_pressure"],
    "jump": Quantity("jump", "cycle-jump length", "1"),
    "error": Quantity("error", "cycle-jump error", "1"),
}

PHASES = {
    "import": "import of libraries",
    "pair": "pairing of the contact faces",
    "assemble elasticity": "assembly of elasticity",
    "condense elasticity": "condensation of elasticity",
    "assemble conduction": "assembly of conduction",
    "condense conduction": "condensation of conduction",
    "condense distortion": "condensation of thermal distortion",
    "contact operators": "assembly of contact operators",
    "bodies": "output of the bodies",
    "move meshes": "mesh motion",
    "carry temperatures over": "transfer of temperatures",
    "coarser and finer": "coarser and finer discretisation",
    "write": "writing of results",
}
"""Labels of phases of a run, where they differ from the name in the summary."""

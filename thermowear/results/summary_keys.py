"""Keys of the summary by group, with labels and units."""

from __future__ import annotations

from .quantity import Quantity, from_key, table_of
from .rows import CycleRow, HeatRow, HistoryRow, LoadRow, ProbeRow, TangentialRow

_history, _heat, _loads, _cycles, _tangential, _probes = (
    table_of(kind).columns
    for kind in (HistoryRow, HeatRow, LoadRow, CycleRow, TangentialRow, ProbeRow)
)
OTHER = "Other"

GROUPS: dict[str, tuple[Quantity, ...]] = {
    "Loads and forces": (
        _heat["normal_force"],
        from_key("contact_force_N", meaning="integral of the pressure, to which friction refers"),
        from_key("fluid_force_N", meaning="of the fluid between the faces, opening them"),
        from_key("friction", "coefficient of friction"),
        from_key("friction_force_N"),
        from_key("friction_torque_Nm"),
        from_key("guide_force_N", "guide force along x"),
        from_key("guide_force_y_N", "guide force along y"),
        from_key("guide_force_z_N", "guide force along z"),
        from_key("guide_moment_Nm"),
        from_key("guide_moment_x_Nm", "guide moment about x"),
        from_key("guide_moment_y_Nm", "guide moment about y"),
        _loads["tangential_force"],
        from_key("tangential_force_y_N", "tangential force along y"),
        _tangential["torque"],
        _history["approach"],
        from_key("holder_rotation_rad", "rotation of the holder"),
        from_key("holder_rotation_x_rad", "rotation of the holder about x"),
        from_key("holder_rotation_y_rad", "rotation of the holder about y"),
        _loads["tangential_displacement"],
        from_key("tangential_displacement_y_m", "tangential displacement along y"),
        _tangential["twist"],
        from_key("equilibrium_relative_error", "equilibrium error"),
        from_key("force_balance_relative_error", "force balance error"),
        from_key("moment_balance_relative_error", "moment balance error"),
    ),
    "Pressure and contact": (
        from_key("between", "bodies in contact", meaning="body 1 and body 2, by their names"),
        _history["max_pressure"],
        from_key("mean_pressure_Pa"),
        from_key("min_pressure_Pa", "smallest pressure"),
        from_key(
            "singular_edge_load_fraction",
            "load share at sharp edges",
            meaning="of elements at sharp edges, where the pressure is singular",
        ),
        from_key("max_pressure_off_singular_edges_Pa", "largest pressure off sharp edges"),
        _history["contact_area"],
        from_key("contact_zones_m", meaning="ranges of `s_m` in contact, to a part of an element"),
        _loads["stick_area"],
        _cycles["stick_radius"],
    ),
    "Wear": (
        from_key("shape_range_m", "peak-to-valley of the worn shape", "µm"),
        from_key("rigid_wear_velocity_m_per_s", "steady wear rate", "nm/s"),
        from_key("rigid_wear_velocity_x_m_per_s", "steady wear rate along x"),
        from_key("rigid_wear_velocity_y_m_per_s", "steady wear rate along y"),
        from_key("rigid_wear_rotation_rad_per_s", "steady wear rotation"),
        from_key("rigid_wear_rotation_x_rad_per_s", "steady wear rotation about x"),
        from_key("rigid_wear_rotation_y_rad_per_s", "steady wear rotation about y"),
        from_key("wear_dissipation_W", "wear dissipation power"),
        from_key("wear_volume_relative_error", "worn volume error", meaning="by rates in time"),
        _history["wear_volume_1"],
        _history["wear_volume_2"],
        from_key("wear_volume_m3", "worn volume", "mm³", "of a body, at all its contacts"),
        *(
            from_key(
                f"layer_volumes_{body}_m3",
                f"worn volumes of the layers, body {body}",
                "mm³",
                "from the surface down, the substrate last",
            )
            for body in (1, 2)
        ),
        *(
            from_key(
                f"worn_through_{key}",
                f"{what} at which the first point has lost its coating, body {body}",
            )
            for body in (1, 2)
            for what, key in (
                ("time", f"time_{body}_s"),
                ("sliding distance", f"distance_{body}_m"),
            )
        ),
        from_key(
            "wear_coefficient_per", meaning="of each body or part: friction-stress or pressure"
        ),
        from_key("distance_from_steady", "distance from the steady pressure"),
    ),
    "Heat and energy": (
        _history["max_temperature"],
        _probes["temperature"],
        from_key("peak_temperature_K", "peak surface temperature", "°C"),
        from_key("peak_temperature_time_s", "time of the peak temperature"),
        _heat["friction_power"].shown_in("W"),
        from_key("prescribed_heat_W", "heat through surfaces of prescribed flux or power"),
        from_key("contact_heat_1_W", "heat at the contact into body 1"),
        from_key("contact_heat_2_W", "heat at the contact into body 2"),
        from_key("heat_advection"),
        from_key("max_cell_peclet_number", "largest cell Péclet number"),
        _heat["heat_in"],
        _heat["heat_stored"],
        _heat["heat_lost"],
        from_key("heat_cooled_W", "heat lost by cooling"),
        from_key("heat_carried_out_W", "heat removed by advection"),
        from_key("dissipated_energy_J", _cycles["dissipated"].label, "mJ"),
        from_key("heat_balance_relative_error", "heat balance error"),
    ),
    "Discretisation": (
        from_key("analysis"),
        from_key("model"),
        from_key("method", "contact method"),
        from_key("dofs_displacement", "unknowns, displacement"),
        from_key("dofs_temperature", "unknowns, temperature"),
        from_key("contact_points"),
        from_key("solver", "solver of the bodies", meaning="direct or multigrid"),
        from_key("factor_memory_estimate_bytes", "estimated memory of a factor"),
        from_key("multigrid_iterations_elasticity"),
        from_key("multigrid_iterations_conduction"),
        from_key("mesh_sha256", "SHA-256 of the mesh", meaning="of a mesh file or of CAD parts"),
        from_key("pressure_error_estimate_relative", "estimated mean error of the pressure"),
        from_key("max_pressure_error_estimate_relative", "estimated error of the largest pressure"),
        from_key("shape_error_estimate_relative", "estimated error of the shape"),
        from_key(
            "wear_volume_error_estimate_relative",
            "estimated error of the worn volume",
            meaning="of fretting in partial slip, by the position of the stick edge",
        ),
        from_key("temperature_error_estimate_relative", "estimated error of the temperature"),
        from_key("error_estimate_missing", "reason for the missing error estimate"),
        from_key("coarser_discretisation"),
        from_key("finer_discretisation"),
    ),
    "Times": (
        from_key("time_s", "time at the end"),
        from_key("steps"),
        Quantity("seconds", "time", "s", "s", "wall time by phase"),
    ),
}
"""Keys by group; all others are in `OTHER`, with labels and units from their names."""

_KEYS = {quantity.header: quantity for group in GROUPS.values() for quantity in group}


def of_key(key: str) -> Quantity:
    """Quantity of a key of the summary; of an unknown key, from its name."""
    return _KEYS.get(key) or from_key(key)


def group_of(key: str) -> str:
    """Group of a key."""
    return next((g for g, known in GROUPS.items() if any(q.header == key for q in known)), OTHER)


PHASES = {
    "import": "import of libraries",
    "mesh search": "search for the mesh",
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
"""Labels of the phases in ``seconds``, where they differ from their names."""

"""Stability analysis of a steel block that slides on an insulator and takes all friction heat."""

from __future__ import annotations

from collections.abc import Iterator

from ... import geometry  # noqa: F401  (makes the geometries known)
from ...case import load
from ...results import Result
from ..check import Check, compare
from ..computed import computed

YOUNG_MODULUS = 2.1e11  # Pa
EXPANSION = 1.2e-5  # 1/K
CONDUCTIVITY = 50.0  # W/(m K)
CAPACITY = 3.7e6  # J/(m³ K)
FRICTION = 0.3
RIGID = 1e20  # Pa
COLD = 1e5  # W/(m K): little heat and high conductivity: no temperature rise


def stability(
    speed: float,
    sizes: dict[str, float],
    poisson_ratio: float,
    pressing: dict[str, str],
    wear: float = 0.0,
    insulator: tuple[float, float] = (RIGID, 0.0),
    conductance: float = 1e-4,
    elements: int = 6,
    degree: int = 6,
) -> Result:
    """Run the stability analysis of a block between planes of symmetry.

    Parameters
    ----------
    speed : float
        Sliding speed [m/s].
    sizes : dict of str to float
        Dimensions of the geometry ``stacked-blocks`` [m].
    poisson_ratio : float
        Poisson's ratio of the steel.
    pressing : dict of str to str
        Table ``load``.
    wear : float
        Archard's k of the steel [1/Pa].
    insulator : tuple of float
        Young's modulus [Pa] and Poisson's ratio.
    conductance : float
        Contact conductance, nearly insulating [W/(m² K)].
    elements, degree : int
        Number of elements, and degree, of the mesh.
    """
    lower_modulus, lower_ratio = insulator
    storing = {"density": "1000 kg/m^3", "specific_heat": f"{CAPACITY / 1e3} J/(kg K)"}
    tables = {
        "title": "A block on an insulator",
        "model": "plane-strain",
        "geometry": {
            "type": "stacked-blocks",
            "thickness": "10 mm",
            **{key: f"{size!r} m" for key, size in sizes.items()},
        },
        "mesh": {"degree": degree, "elements": elements, "grading": 0.5},
        "bodies": {
            "upper": {
                "young_modulus": f"{YOUNG_MODULUS} Pa",
                "poisson_ratio": poisson_ratio,
                "conductivity": f"{CONDUCTIVITY} W/(m K)",
                "expansion": f"{EXPANSION} 1/K",
                **storing,
            },
            "lower": {
                "young_modulus": f"{lower_modulus} Pa",
                "poisson_ratio": lower_ratio,
                "conductivity": f"{COLD} W/(m K)",
                "expansion": "1e-12 1/K",
                **storing,
            },
        },
        "load": pressing,
        "motion": {"velocity": f"{speed!r} m/s"},
        "contact": {"friction": FRICTION},
        "heat": {
            "conductance": f"{conductance!r} W/(m^2 K)",
            "partition": 1.0,
            "ambient": "20 degC",
            "temperature": {"upper_top": "20 degC", "lower_bottom": "20 degC"},
        },
        "analysis": {"type": "stability"},
    }
    if wear > 0:
        tables["wear"] = {"upper": {"coefficient": f"{wear} 1/Pa", "per": "pressure"}}
    return computed(load(tables))


def growth(result: Result, at: str, rate: complex, source: str) -> Iterator[Check]:
    """Growth rate of the fastest mode, and its frequency if it is oscillatory."""
    found = result.summary["growth_rate_per_s"]
    yield compare(f"growth rate {at} [1/s]", found, rate.real, 1e-3, source, abs(rate))
    if rate.imag > 0:
        found = result.summary["growth_frequency_rad_per_s"]
        quantity = f"frequency of the growing mode {at} [1/s]"
        yield compare(quantity, found, rate.imag, 1e-3, source)

"""Extreme but legal cases: right within 1 %, or said to be wrong; never silently wrong.

References are closed forms and similarity laws, or a run of moderate numbers that they scale.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import pytest

import thermowear as tw
from thermowear.reference import heat
from thermowear.verification.check import starter

ALLOWED = 1e-2
AMBIENT = 293.15


def quantities(result: tw.Result) -> dict[str, float]:
    """Numbers of a run that references know."""
    summary, interface = result.summary, result.interface
    area = float(interface.weight.sum())
    found = {
        "force": summary["normal_force_N"],
        "peak": summary["max_pressure_Pa"],
        "mean": summary["mean_pressure_Pa"],
        "approach": summary["approach_m"],
        "velocity": summary["rigid_wear_velocity_m_per_s"],
    }
    if summary["max_temperature_K"] is not None:
        for body in (1, 2):
            temperature = getattr(interface, f"temperature_{body}")
            flux = getattr(interface, f"heat_flux_{body}")
            found[f"rise {body}"] = float(interface.weight @ temperature) / area - AMBIENT
            found[f"flux {body}"] = float(interface.weight @ flux) / area
    return found


def run(name: str, *overrides: str, without: tuple[str, ...] = ()) -> dict[str, float]:
    """The quantities of a run.

    Raises
    ------
    CaseError, ComputationError
        If the case is refused, or the run has failed in whatever way.
    """
    result = tw.run(starter(name, *overrides, without=without))
    if result.stopped is not None:
        raise result.stopped
    return quantities(result)


# --- Hertz: a cylinder on a block, by a given approach -------------------------------------------


def hertz(
    size: float = 1.0,
    thickness: float = 1e-3,
    stiffness: tuple[float, float] = (2.1e11, 2.1e11),
    ν: float = 0.3,
    degree: int = 4,
) -> dict[str, float]:
    """A cylinder of 10 mm times `size`; stiffness of both bodies [Pa]."""
    cylinder, block = stiffness
    return run(
        "cylinder-on-block",
        "contact.positioning=false",
        f"geometry.radius={10 * size!r} mm",
        f"geometry.block_width={40 * size!r} mm",
        f"geometry.block_height={20 * size!r} mm",
        f"geometry.zone={3 * size!r} mm",
        f"geometry.thickness={thickness!r} m",
        f"load.approach={0.05 * size!r} mm",
        f"mesh.degree={degree}",
        "mesh.elements=16",
        f"bodies.cylinder.young_modulus={cylinder!r} Pa",
        f"bodies.cylinder.poisson_ratio={ν}",
        f'bodies.block={{young_modulus="{block!r} Pa", poisson_ratio={ν}}}',
    )


moderate_hertz = cache(hertz)


def scaled_hertz(stiffness: float = 1.0, thickness: float = 1e-3, size: float = 1.0) -> dict:
    """Moderate run scaled by similarity: pressure scales with the stiffness alone."""
    base = moderate_hertz()
    return {
        "force": base["force"] * stiffness * size * thickness / 1e-3,
        "peak": base["peak"] * stiffness,
    }


SIZES = {
    f"size {size:g}": (lambda s=size: hertz(size=s), lambda s=size: scaled_hertz(size=s))
    for size in (1e-4, 1e-3, 1e-1, 1e2, 1e4)
}
THICKNESSES = {
    f"thickness {t:g} m": (
        lambda t=t: hertz(thickness=t),
        lambda t=t: scaled_hertz(thickness=t),
    )
    for t in (1e-6, 100.0)
}
STIFFNESSES = {
    f"stiffness {f:g}": (
        lambda f=f: hertz(stiffness=(2.1e11 * f, 2.1e11 * f)),
        lambda f=f: scaled_hertz(stiffness=f),
    )
    for f in (1e-12, 1e-6, 1e6, 1e12)
}


def rigid(ratio: float, soft: int) -> dict[str, float]:
    """One body 1e4 times as stiff as the other: what higher ratios do not change any more."""
    stiff = (2.1e15, 2.1e11) if soft == 2 else (2.1e11, 2.1e15)
    base = moderate_hertz(stiffness=stiff)
    return {"force": base["force"] * ratio, "peak": base["peak"] * ratio}


RATIOS = {
    f"ratio {ratio:g}": (
        lambda r=ratio: hertz(stiffness=(2.1e11 * r, 2.1e11)),
        lambda r=ratio: rigid(min(r, 1.0), 2 if r > 1.0 else 1),
    )
    for ratio in (1e-12, 1e-9, 1e-6, 1e6, 1e9, 1e12)
}
INCOMPRESSIBLE = {
    f"nu {ν}, degree {degree}": (
        lambda ν=ν, degree=degree: hertz(ν=ν, degree=degree),
        lambda: {"force": moderate_hertz(ν=0.4999, degree=8)["force"]},
    )
    for ν, degree in (
        (0.49999, 3),
        (0.49999, 6),
        (0.4999999, 3),
        (0.4999999, 4),
        (0.4999999, 8),
    )
}
LOCKING = {
    f"nu {ν}, degree {degree}": (
        lambda ν=ν, degree=degree: hertz(ν=ν, degree=degree),
        dict,
    )
    for ν, degree in ((0.49, 1), (0.4999999, 1), (0.4999, 2), (0.4999999, 2))
}
ILL_CONDITIONED = {
    "nu 0.4999999999": (
        lambda: hertz(ν=0.4999999999, degree=6),
        dict,
    ),
}

# --- a flat punch on a block, by a given load ----------------------------------------------------


def punch(pressure: float = 2e7, ratio: float = 200.0) -> dict[str, float]:
    """Mean pressure [Pa], and how stiff the punch is beside the block."""
    return run(
        "punch-on-block",
        f"load.mean_pressure={pressure!r} Pa",
        f"bodies.punch.young_modulus={3 * ratio!r} GPa",
        "mesh.degree=4",
        "mesh.elements=10",
    )


moderate_punch = cache(punch)
LOADS = {
    f"pressure {p:g} Pa": (
        lambda p=p: punch(pressure=p),
        lambda p=p: {key: moderate_punch()[key] * p / 2e7 for key in ("force", "peak", "approach")},
    )
    for p in (1e-15, 1.0, 1e15, 1e30)
}
PUNCHES = {
    f"punch {ratio:g} times as stiff": (
        lambda r=ratio: punch(ratio=r),
        lambda r=ratio: {
            key: moderate_punch(ratio=1e5)[key] for key in ("force", "mean", "approach")
        },
    )
    for ratio in (1e8, 1e12)
}

# --- two slabs with heat -------------------------------------------------------------------------

POWER = 0.2 * 5e6 * 0.1  # W/m²


def two_slabs(
    conductance: float | None = 1e4,
    conductivity: tuple[float, float] = (50.0, 15.0),
    speed: float = 0.1,
    hot: float = AMBIENT,
    degree: int = 2,
    friction: float = 0.2,
) -> dict[str, float]:
    """The starter, its conductivities [W/(m K)] and the temperature of its top changed."""
    given = () if conductance is None else (f"heat.conductance={conductance!r} W/(m^2 K)",)
    upper, lower = conductivity
    return run(
        "stacked-blocks",
        *given,
        f"bodies.upper.conductivity={upper!r} W/(m K)",
        f"bodies.lower.conductivity={lower!r} W/(m K)",
        f"motion.velocity={speed!r} m/s",
        f"contact.friction={friction!r}",
        f"heat.temperature.upper_top={hot!r} K",
        "heat.partition=0.5",
        f"mesh.degree={degree}",
        "mesh.elements=3",
        without=() if conductance is not None else ("heat.conductance",),
    )


def known_slabs(
    conductance: float | None = 1e4,
    conductivity: tuple[float, float] = (50.0, 15.0),
    speed: float = 0.1,
    hot: float = AMBIENT,
    friction: float = 0.2,
    **_,
) -> dict[str, float]:
    """The closed form of the same."""
    made = friction * 5e6 * speed
    h = float("inf") if conductance is None else conductance
    ends = (hot - AMBIENT, 0.0)
    rises, fluxes = heat.contact_temperatures((0.01, 0.02), conductivity, ends, made, 0.5, h)
    names = ("rise 1", "rise 2", "flux 1", "flux 2")
    return dict(zip(names, (*rises, *fluxes), strict=True))


def slab_rows(**settings) -> tuple[Callable, Callable]:
    return lambda: two_slabs(**settings), lambda: known_slabs(**settings)


CONDUCTANCES = {
    f"conductance {h}": slab_rows(conductance=h) for h in (1e-6, 1e3, 1e10, 1e16, 1e20, 1e30, None)
}
CONDUCTIVITIES = {
    f"conductivities {k1:g}, {k2:g}, conductance {h}": slab_rows(
        conductance=h, conductivity=(k1, k2)
    )
    for k1, k2, h in (
        (1e-6, 1e6, 1e4),
        (1e6, 1e-6, 1e4),
        (1e-6, 1e6, None),
        (1e6, 1e-6, None),
        (1e9, 1e9, 1e4),
        (1e-9, 1e-9, None),
    )
}
SPEEDS = {
    f"speed {v:g}": slab_rows(speed=v, degree=degree)
    for v, degree in ((1e-12, 1), (1e-3, 4), (10.0, 3))
}
AT_REST = {
    "hot end, hardly any friction": slab_rows(hot=473.15, friction=1e-12),
    "hot end, perfect contact": slab_rows(hot=473.15, conductance=None, friction=1e-12),
    "very hot end": slab_rows(hot=1e9, conductance=1e20),
}


# --- cooling, wear -------------------------------------------------------------------------------


def cooled(coefficient: float) -> dict[str, float]:
    """Two slabs that only the top cools [W/(m² K)]."""
    return run(
        "stacked-blocks",
        f'heat.cooling={{upper_top="{coefficient!r} W/(m^2 K)"}}',
        "mesh.degree=2",
        "mesh.elements=3",
        without=("heat.temperature", "heat.conductance"),
    )


COOLINGS = {
    f"cooling {h:g}": (
        lambda h=h: cooled(h),
        lambda h=h: {"rise 1": POWER / h + POWER * 0.01 / 50.0, "flux 1": POWER},
    )
    for h in (1e-2, 1e2, 1e12)
}
HARDLY_COOLED = {f"cooling {h:g}": (lambda h=h: cooled(h), dict) for h in (1e-6, 1e-14)}


def ring(ω: float, coefficient: float) -> dict[str, float]:
    """The cold ring, its speed [rad/s] and its wear coefficient [1/MPa]."""
    return run(
        "annular-punch",
        f"motion.angular_velocity={ω!r} rad/s",
        f'wear.punch.coefficient="{coefficient!r} 1/MPa"',
        "mesh.degree=3",
        "mesh.elements=8",
        without=("heat",),
    )


WEARS = {
    f"speed {ω:g} rad/s, wear {β:g} 1/MPa": (
        lambda ω=ω, β=β: ring(ω, β),
        # p r is constant: p = F / (2 pi r (b - a)); V = beta mu p omega r
        lambda ω=ω, β=β: {
            "velocity": β * 1e-6 * 0.25 * 50e6 * (0.12 + 0.02) / 2 * ω,
            "peak": 50e6 * (0.12 + 0.02) / 2 / 0.02,
        },
    )
    for ω, β in ((1e-9, 2e-7), (1e6, 2e-7), (0.1, 1e-30), (0.1, 1e6))
}

RIGHT = (SIZES | THICKNESSES | STIFFNESSES | RATIOS | INCOMPRESSIBLE | LOADS | PUNCHES) | (
    CONDUCTANCES | CONDUCTIVITIES | SPEEDS | AT_REST | COOLINGS | WEARS
)
FAILED = LOCKING | ILL_CONDITIONED | HARDLY_COOLED
QUICK = (
    "size 0.0001",
    "ratio 1e-12",
    "ratio 1e+12",
    "pressure 1e-15 Pa",
    "conductance 1e+20",
    "conductivities 1e-06, 1e+06, conductance None",
    "hot end, hardly any friction",
    "cooling 0.01",
    "speed 1e-09 rad/s, wear 2e-07 1/MPa",
)


def rows(table: dict, quick: tuple[str, ...] = ()) -> list:
    return [
        pytest.param(*row, id=name, marks=() if name in quick else pytest.mark.slow)
        for name, row in table.items()
    ]


@pytest.mark.parametrize(("computed", "known"), rows(RIGHT, QUICK))
def test_extremes_are_right(computed, known):
    """requirement: within 1 % of closed forms and similarity laws, whatever the numbers."""
    found = computed()
    for key, value in known().items():
        assert found[key] == pytest.approx(value, rel=ALLOWED, abs=0.0), key


@pytest.mark.parametrize("computed", [row[0] for row in FAILED.values()], ids=FAILED)
def test_what_cannot_be_right_is_said(computed):
    """requirement: elements that lock are refused, and what does not balance ends as failed."""
    with pytest.raises((tw.CaseError, tw.ComputationError)):
        computed()


def test_there_are_sixty():
    """requirement: the table has at least sixty cases."""
    assert len(RIGHT) + len(FAILED) >= 60

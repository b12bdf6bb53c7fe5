"""Cases written out and read back are equal."""

from __future__ import annotations

import tomllib

import pytest
import tomli_w
from hypothesis import given, settings
from hypothesis import strategies as st

import thermowear as tw
from thermowear.case import as_plain
from thermowear.case.starters import starters

from ..conftest import examples
from .starter import FILE, FRETTING, GONE, HERTZ, PUNCH, RUNNING_IN, STEADY, tables

FACTORS = {
    "temperature": {"at": ["20 degC", "333.3 degC"], "factor": [1.0, 0.7]},
    "pressure": {"at": ["0 MPa", "3.3 kN/cm^2"], "factor": [1, 1.1]},
    "speed": {"at": ["0.1 mm/s"], "factor": [0.9]},
}

VARIANTS = {
    **{name: (name, {}) for name in starters()},
    "cold": (STEADY, {"heat": GONE}),
    "initial": (STEADY, {"analysis": {"type": "initial"}, "wear": GONE}),
    "force": (STEADY, {"load": {"force": "2.2 MN"}}),
    "perfect contact": (STEADY, {"heat.conductance": GONE}),
    "until steady": (RUNNING_IN, {"analysis": {"type": "transient", "until": "steady"}}),
    "faces differ": (STEADY, {"mesh.bodies": {"plate": {"elements": 17}}}),
    "two laws": (STEADY, {"wear.plate": {"coefficient": "3e-9 mm^2/N", "per": "pressure"}}),
    "given temperature": (STEADY, {"heat.temperature": {"plate_side": "31.7 degC"}}),
    "to the left": (PUNCH, {"motion": {"velocity": "-33.3 mm/s"}, "contact": {"friction": 0.1}}),
    "penalty": (HERTZ, {"contact": {"method": "penalty", "penalty": "1e3 MPa/um"}}),
    "Nitsche": (HERTZ, {"contact": {"method": "nitsche", "theta": -1, "gamma": 3.7}}),
    "pressure degree": (HERTZ, {"contact.pressure_degree": 2}),
    "point by point": (HERTZ, {"contact.pressure_degree": "lobatto"}),
    "pulled to and fro": (
        FRETTING,
        {
            "load": {
                "history": {
                    "time": ["0 s", "100 ms"],
                    "approach": ["1.1 um", "1.3 um"],
                    "tangential_displacement": ["0 um", "-0.3 um"],
                }
            },
            "analysis.output_times": ["0 s", "33 ms"],
        },
    ),
    "pressed harder": (
        FRETTING,
        {
            "load": {"history": {"time": ["0 s"], "force": ["0.1 kN"]}},
            "analysis.output_times": [],
        },
    ),
    "heat in time": (
        STEADY,
        {
            "analysis": {"type": "transient", "end_time": "10 s"},
            "bodies.punch.density": "7.8 g/cm^3",
            "bodies.punch.specific_heat": "460 J/(kg K)",
            "bodies.punch.hardness": "2 GPa",
            "bodies.punch.conductivity_factor": FACTORS["temperature"],
            "bodies.punch.expansion_factor": FACTORS["temperature"],
            "contact.friction_factor": FACTORS,
            "wear.punch.factor": FACTORS,
            "heat.conductance": {"type": "pressure", "coefficient": "2e-2 1/um"},
            "heat.gap_conductance": "11.1 W/(m^2 K)",
            "heat.partition": "effusivity",
            "heat.transient": True,
            "heat.initial": "77.7 degC",
            "heat.flux": {"punch_outside": "-3.3 kW/m^2"},
            "heat.power": {"punch_inside": "0.1 kW"},
            "heat.temperature": {
                "plate_side": {"time": ["0 s", "7 s"], "temperature": ["20 degC", "31.7 degC"]},
                "plate_bottom": "11.1 degC",
            },
            "heat.cooling": {"punch_top": "3.3 W/(m^2 K)"},
            "heat.ambient_history": {"time": ["1 s"], "temperature": ["30.3 degC"]},
            "contact.friction_history": {"time": ["1 s", "2 min"], "factor": [1.1, 0]},
            "motion.history": {
                "time": ["0 s", "333 ms", "1 min"],
                "factor": [0, 1.1, 0],
                "repeat": True,
            },
            "load": {"history": {"time": ["1 s", "100 s"], "force": ["0 N", "1.1 kN"]}},
        },
    ),
    "tabulated conductance of a strip": (
        "punch-on-strip",
        {
            "heat.conductance": {
                "type": "table",
                "pressure": ["0 MPa", "11.1 MPa"],
                "conductance": ["0 W/(m^2 K)", "3.3 W/(cm^2 K)"],
            },
            "heat.advection": "spread",
        },
    ),
    "stability": (STEADY, {"analysis": {"type": "stability"}, "wear": GONE}),
    "file": (HERTZ, {"geometry": FILE, "mesh": {}, "contact": {}}),
    "every key of a file": (
        HERTZ,
        {
            "geometry": FILE
            | {
                "length_unit": "1 inch",
                "symmetry": ["axis"],
                "half": True,
                "thickness": "3 mm",
                "contact_area": "12 mm^2",
                "surfaces": {"cylinder_side": "SIDE", "cylinder_face": "FACE"},
            },
            "mesh": {},
            "contact": {},
            "load": {"mean_pressure": "1 MPa"},
        },
    ),
}


@pytest.mark.parametrize(("name", "changes"), VARIANTS.values(), ids=VARIANTS)
def test_a_case_written_out_is_the_same_case(name, changes):
    """
    requirement: case.resolved.toml can be run again and is the case that was run.
    """
    case = tw.load(tables(name, changes))
    plain = as_plain(case)
    assert tw.load(plain) == case
    assert tw.load(tomllib.loads(tomli_w.dumps(plain))) == case


def test_every_default_is_written_out():
    """
    requirement: the resolved case shows what was left to its default.
    """
    gone = {"mesh": GONE, "wear.punch.per": GONE, "heat.partition": GONE, "heat.ambient": GONE}
    plain = as_plain(tw.load(tables(STEADY, gone)))
    assert plain["mesh"]["degree"] == 8
    assert plain["contact"]["method"] == "condensed"
    assert plain["wear"]["punch"]["per"] == "friction-stress"
    assert (plain["heat"]["partition"], plain["heat"]["ambient"]) == (0.5, "293.15 K")
    assert (plain["heat"]["advection"], plain["heat"]["transient"]) == ("none", False)


positive = st.floats(1e-12, 1e12)
exponents = st.floats(0.1, 10.0)


@given(modulus=positive, friction=positive, nu=st.floats(-0.999, 0.499), a=exponents, b=exponents)
@settings(max_examples=examples(40), deadline=None, database=None)
def test_numbers_are_written_out_exactly(modulus, friction, nu, a, b):
    """
    requirement: no digit is lost in case.resolved.toml, exponents in units included.
    """
    changes = {
        "bodies.punch.young_modulus": f"{modulus!r} MPa",
        "load.mean_pressure": f"{0.1 * modulus!r} MPa",
        "bodies.punch.poisson_ratio": nu,
        "contact.friction": friction,
        "wear.punch.velocity_exponent": a,
        "wear.punch.pressure_exponent": b,
        "wear.punch.coefficient": f"2e-7 (mm/s)^({1 - a!r}) MPa^(-{b!r})",
    }
    case = tw.load(tables(STEADY, changes))
    assert tw.load(tomllib.loads(tomli_w.dumps(as_plain(case)))) == case


@pytest.mark.parametrize("name", starters())
def test_every_starter_is_a_case(name):
    """
    requirement: starter cases run as they are.
    """
    assert tw.load(tables(name)).title == starters()[name]

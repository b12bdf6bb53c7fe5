"""Tables `calibrate` and `study`: units, faults, and values written back."""

from __future__ import annotations

import pytest

from thermowear.case import as_plain, load
from thermowear.case.studies.scalars import Scalar, Spread
from thermowear.errors import CaseError

from .starter import tables

K = {"key": "wear.punch.coefficient", "start": "1e-7 1/MPa", "lower": "1e-9 1/MPa"}
K |= {"upper": "1e-2 1/GPa", "scale": "log"}
MU = {"key": "contact.friction", "start": 0.3, "lower": 0.1, "upper": 0.5}


def ring(**own):
    return load(tables("annular-punch") | own)


def test_values_in_other_units():
    """requirement: bounds in other units of the same dimension; the case is read back the same."""
    case = ring(calibrate={"parameters": {"k": K, "mu": MU}})
    k = case.calibrate.parameters["k"]
    assert k.upper.in_unit_of(k.start) == pytest.approx(1e-5)
    assert load(as_plain(case)) == case
    changes = case.calibrate.overrides({"k": 2e-7, "mu": 0.2})
    assert changes == ('wear.punch.coefficient="2e-07 1/MPa"', "contact.friction=0.2")
    calibrated = load(tables("annular-punch"), changes)
    assert calibrated.contact.friction == 0.2


def test_templates():
    """requirement: parameters in the values of several keys, as numbers and within a text."""
    calibrate = {
        "parameters": {
            "k": {"start": 1e-7, "lower": 1e-9, "upper": 1e-5, "scale": "log"},
            "b": {"start": 1.1, "lower": 0.5, "upper": 2.0},
        },
        "set": {
            "wear.punch.coefficient": "{k} 1/MPa^{b}",
            "wear.punch.pressure_exponent": "{b}",
        },
    }
    case = ring(calibrate=calibrate)
    changed = load(as_plain(case), case.calibrate.overrides({"k": 3e-8, "b": 1.2345678901234}))
    assert changed.wear["punch"].pressure_exponent == 1.2345678901234
    assert changed.wear["punch"].coefficient_si() == pytest.approx(3e-8 * 1e-6**1.2345678901234)


@pytest.mark.parametrize(
    ("parameter", "said"),
    [
        ({"upper": "1e-8 1/MPa"}, "parameters.k.start: must lie between"),
        ({"upper": "1e-10 1/MPa"}, "parameters.k.upper: must be greater than lower"),
        ({"upper": "1 m"}, "parameters.k.upper: found '1.0 m'; must be in 1/MPa"),
        ({"upper": 1e-5}, "parameters.k.upper: found 1e-05; must be in 1/MPa"),
        ({"lower": "0 1/MPa"}, "parameters.k.lower: must be greater than 0 on a logarithmic"),
        ({"scale": "loga"}, "parameters.k.scale: found 'loga'; must be 'linear' or 'log'"),
        ({"key": None}, "parameters.k.key: missing; or use the parameter in calibrate.set"),
        ({"start": "fast"}, "parameters.k.start: cannot read"),
        ({"prior": {"value": "1 m", "deviation": "1 %"}}, "parameters.k.prior: found '1.0 m'"),
        ({"prior": {"value": "1e-7 1/MPa", "deviation": 0.0}}, "prior.deviation: found 0.0"),
        (
            {"scale": "linear", "prior": {"value": "0 1/MPa", "deviation": "1 %"}},
            "parameters.k.prior.deviation: must be greater than 0; a percentage of 0",
        ),
        ({"first": 1}, "parameters.k.first: unknown key"),
    ],
)
def test_faults_of_a_parameter(parameter, said):
    """requirement: one line with the path of the key, and what is allowed."""
    given = {key: value for key, value in (K | parameter).items() if value is not None}
    with pytest.raises(CaseError) as error:
        ring(calibrate={"parameters": {"k": given}})
    assert f"calibrate.{said}" in str(error.value) or said in str(error.value)
    assert len(error.value.faults) == 1


@pytest.mark.parametrize(
    ("calibrate", "said"),
    [
        ({"parameters": {}}, "calibrate.parameters"),
        ({"parameters": {"k 1": K}}, "must be a short name"),
        ({"parameters": {"k": K}, "set": {"contact.friction": "{x}"}}, "{x} is not a parameter"),
        ({"parameters": {"k": K, "l": K}}, "wear.punch.coefficient is set twice"),
        ({"parameters": {"k": K}, "deviations": "guessed"}, "deviations: found 'guessed'"),
        ({"parameters": {"k": K}, "posterior": {"walkers": 5}}, "posterior.walkers: found 5"),
        ({"parameters": {"k": K}, "observations": {"d": {"deviation": "-1 %"}}}, "deviation"),
        (
            {"parameters": dict.fromkeys(("k", "mu", "b"), MU) | {"k": K, "b": MU | {"key": "b"}}}
            | {"posterior": {"walkers": 4}},
            "posterior.walkers: must be 6 at least, two for each parameter",
        ),
    ],
)
def test_faults_of_a_calibration(calibrate, said):
    """requirement: one line with the path of the key, and what is allowed."""
    with pytest.raises(CaseError) as error:
        ring(calibrate=calibrate)
    assert said in str(error.value)
    assert len(error.value.faults) == 1


@pytest.mark.parametrize(
    ("own", "said"),
    [
        ({"distribution": "normal", "mean": 0.3}, "deviation: missing; a normal distribution"),
        (
            {"distribution": "normal", "mean": 0.0, "deviation": "1 %"},
            "deviation: must be greater than 0; a percentage of 0",
        ),
        ({"distribution": "uniform", "lower": 1.0, "upper": 0.5}, "upper: must be greater"),
        ({"distribution": "uniform", "lower": 0.1, "upper": "1 m"}, "found '1.0 m'"),
        ({"distribution": "uniform", "lower": 0.1, "upper": 0.2, "mode": 0.1}, "mode: not a key"),
        ({"distribution": "lognormal", "median": -1.0, "factor": 2.0}, "must be greater than 0"),
        ({"distribution": "lognormal", "median": 1.0, "factor": 0.5}, "factor"),
        ({"distribution": "gauss"}, "distribution: found 'gauss'"),
    ],
)
def test_faults_of_an_input(own, said):
    """requirement: one line with the path of the key, and what is allowed."""
    with pytest.raises(CaseError) as error:
        ring(study={"inputs": {"contact.friction": own}})
    assert said in str(error.value)


def test_spreads_and_temperature_scales():
    """requirement: a deviation in °C is a difference; a percentage is relative to the value."""
    assert Spread(relative=0.1).of(Scalar(20.0, "N")) == pytest.approx(2.0)
    assert Spread(Scalar(2.0, "degC")).of(Scalar(300.0, "K")) == pytest.approx(2.0)
    assert Scalar(20.0, "degC").in_unit_of(Scalar(0.0, "K")) == pytest.approx(293.15)


def test_other_commands_do_not_see_them():
    """requirement: a run may be resumed although the table of the calibration has changed."""
    from thermowear.case.validation.comparison import changes

    plain = tables("annular-punch")
    one, other = load(plain), load(plain | {"calibrate": {"parameters": {"k": K}}})
    assert changes(one, other) == []

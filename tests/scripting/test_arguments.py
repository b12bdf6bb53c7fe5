"""Arguments of models in Python: units, laws, and faults in one line."""

from dataclasses import replace

import numpy as np
import pint
import pytest

import thermowear as tw
from thermowear.laws.interfaces import Constant, LocalState

from ..case.starter import STEADY
from .from_case import python_model

UNITS = pint.UnitRegistry()


@pytest.mark.parametrize(
    "value", [2.1e11, "210 GPa", UNITS.Quantity(210, "GPa"), np.float64(2.1e11)]
)
def test_quantities(value):
    """requirement: SI numbers, text and pint quantities, of any registry."""
    steel = tw.Material(value, 0.3, density=UNITS.Quantity(7.8, "g/cm^3"))
    assert (steel.young_modulus, steel.density) == pytest.approx((2.1e11, 7800.0), rel=1e-14)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: tw.Material("210 kg", 0.3), r"^Material\.young_modulus: .*must be in Pa"),
        (lambda: tw.Material(-1.0, 0.3), r"^Material\.young_modulus: .*greater than 0"),
        (lambda: tw.Material("soft", 0.3), r"^Material\.young_modulus: cannot read"),
        (lambda: tw.Material(True, 0.3), r"^Material\.young_modulus: found True"),
        (lambda: tw.Material(1e9, 0.5, name="rubber"), r"^rubber\.poisson_ratio: found 0\.5"),
        (lambda: tw.Material(1e9, "0.3"), r"^Material\.poisson_ratio: found '0\.3'"),
        (lambda: tw.PowerWear("1 m"), r"^PowerWear\.coefficient: .*1/Pa"),
        (lambda: tw.Heat(cooling={"top": 1.0}), r"^Heat\.cooling: .*body\.surface"),
        (lambda: tw.TimeHistory(["1 s", "1 s"], [0, 1]), r"^TimeHistory\.time: .*increasing"),
        (lambda: tw.LoadHistory([0, 1], force=[1]), r"^LoadHistory\.force: has 1 values for 2"),
    ],
)
def test_faults(make, message):
    """requirement: one line that names the argument."""
    with pytest.raises(tw.CaseError, match=message) as fault:
        make()
    assert "\n" not in str(fault.value)


def test_units_of_powers():
    """requirement: κ in (m/s)^(1-a) Pa^-b."""
    assert tw.PowerWear("1e-7 1/MPa").coefficient == pytest.approx(1e-13)
    found = tw.PowerWear("2e-9 (mm/s)^0.5/MPa^1.5", b=1.5, a=0.5)
    assert found.coefficient == pytest.approx(2e-9 * 1e-9 * 1e-3**0.5)
    found = tw.PowerWear("2e-9 1/((mm/s) MPa)", a=2.0)
    assert found.coefficient == pytest.approx(2e-9 * 1e-6 * 1e3)


@pytest.fixture(scope="module")
def ring():
    return python_model(STEADY, "mesh.degree=2", "mesh.elements=3")


def changed(ring, **face):
    model, given, _ = ring
    return replace(model, interfaces=[replace(given, **face)])


@pytest.mark.parametrize(
    ("face", "message"),
    [
        ({"friction": lambda p, x: p}, r"^Interface\.friction: .*parameter 'x'"),
        ({"friction": "0.3 + v"}, r"^Interface\.friction: "),
        ({"friction": -0.1}, r"^Interface\.friction: "),
        ({"friction": lambda v: -v}, r"^Interface\.friction: .*greater than 0"),
        ({"conductance": "1e4 W/m"}, r"^Interface\.conductance: "),
        ({"compliance": "1 m"}, r"^Interface\.compliance: "),
        ({"fluid_pressure": "1 N"}, r"^Interface\.fluid_pressure: .*needs Pa"),
        ({"fluid_pressure": -1.0}, r"^Interface\.fluid_pressure: .*from 0"),
        ({"fluid_pressure": lambda p: p}, r"^Interface\.fluid_pressure: .*parameter 'p'"),
    ],
)
def test_faults_of_laws(ring, face, message):
    """requirement: a law is checked when the model is made."""
    with pytest.raises(tw.CaseError, match=message):
        changed(ring, **face)


def test_faults_of_wear(ring):
    """requirement: a rate that decreases with pressure is refused with the name of the body."""
    punch = ring[0].bodies[0]
    with pytest.raises(tw.CaseError, match=r"^Interface\.wear of 'punch': .*decreases"):
        changed(ring, wear={punch: lambda p: 1e-9 * p / (1e6 + p) ** 2})
    with pytest.raises(tw.CaseError, match=r"^Interface\.wear: .*no body"):
        changed(ring, wear={"punch": 1e-9})


def test_expressions_and_constants(ring):
    """requirement: text is an expression with units as in a case file; a constant stays one."""
    law = changed(ring, conductance="1e4 W/(m^2 K)")._model(True).interface.conductance
    assert law == Constant(1e4)
    law = changed(ring, friction="0.1 + 0.2*exp(-v/(0.5 m/s))")._model(True).interface.friction
    p, T = np.array([1e6]), np.array([300.0])
    assert law.value(LocalState(p, np.array([0.5]), T)) == pytest.approx(0.1 + 0.2 * np.exp(-1))


def test_what_is_supported(ring):
    """requirement: bodies, interfaces and holders that do not fit together are refused."""
    model, face, _ = ring
    with pytest.raises(tw.CaseError, match=r"^Model: two interfaces have the same name"):
        replace(model, interfaces=[face, face])
    with pytest.raises(tw.CaseError, match=r"each may have one holder only"):
        replace(model, holders=[*model.holders, *model.holders])
    other = replace(model.bodies[1], name="third")
    with pytest.raises(tw.CaseError, match=r"^Model: the body 'third' is at no interface"):
        replace(model, motions={other: tw.Rotation(1.0)})
    with pytest.raises(tw.CaseError, match=r"^Model: an interface has both faces on the same"):
        replace(model, interfaces=[replace(face, other=face.one)])
    with pytest.raises(tw.CaseError, match=r"^Model\.kinematics: found None; must be"):
        replace(model, kinematics=None)
    with pytest.raises(tw.CaseError, match=r"^Model\.thickness: needed for a plane model"):
        replace(model, kinematics="plane-strain")
    with pytest.raises(tw.CaseError, match=r"^Model\.solver: found 'fast'; must be one of auto"):
        replace(model, solver="fast")


@pytest.mark.parametrize(
    "laws",
    [
        {"friction": lambda T: 0.3 - 1e-3 * (T - 293.15)},
        {"friction": "0.3 - T/(1000 K)"},
        {"wear": lambda p, v, T: 1e-14 * p * v * T / 293.15},
    ],
)
def test_laws_of_temperature_need_heat(ring, laws):
    """requirement: no law is evaluated at a temperature that nothing computes."""
    model, face, _ = ring
    punch = model.bodies[0]
    given = {key: {punch: law} if key == "wear" else law for key, law in laws.items()}
    (kind,) = laws
    with pytest.raises(tw.CaseError, match=rf"^Interface: {kind} depends on T; .* heat=Heat"):
        replace(model, interfaces=[replace(face, **given)], heat=None)


@pytest.mark.parametrize(
    ("holder", "message"),
    [
        ({"free": ["q"]}, r"^Holder\.free: found 'q'; must be some of: x, y, z"),
        ({"force": None}, r"^Holder: needs one of force"),
        ({"approach": "1 um"}, r"^Holder: needs one of force"),
        ({"surface": 42}, r"^Holder: found 42; must be body\.surface"),
        ({"pivot": (0.0,)}, r"^Holder\.pivot: has 1 coordinates; needs 2"),
    ],
)
def test_faults_of_holders(ring, holder, message):
    """requirement: a holder without a load, or with an unknown motion, is refused."""
    model = ring[0]
    with pytest.raises(tw.CaseError, match=message):
        replace(model, holders=[replace(model.holders[0], **holder)])


def test_supports(ring):
    """requirement: a body is held by its own facets, and never loose."""
    model, face, _ = ring
    punch, plate = model.bodies
    with pytest.raises(tw.CaseError, match=r"facets with the tag 7 do not bound the body 'plate'"):
        replace(model, interfaces=[replace(face, other=plate.surface(7))])
    loose = replace(plate, fixed=())
    hanging = replace(
        model,
        interfaces=[tw.Interface(punch.surface(face.one.tag), loose.surface(face.other.tag))],
        heat=None,
    )
    with pytest.raises(tw.CaseError, match=r"^bodies\.plate: neither its supports nor its contact"):
        hanging.initial()
    flat = replace(plate, fixed=(), mid_plane=plate.fixed)
    with pytest.raises(tw.CaseError, match=r"^Body 'plate': mid_plane requires a mesh in space"):
        replace(
            model,
            interfaces=[tw.Interface(punch.surface(face.one.tag), flat.surface(face.other.tag))],
            heat=None,
        )
    with pytest.raises(tw.CaseError, match=r"^Interface: found MeshBody\(name='plate'"):
        tw.Interface(face.one, plate)


def test_tags(ring):
    """requirement: an unknown tag is answered with the known ones."""
    punch = ring[0].bodies[0]
    with pytest.raises(tw.CaseError, match=r"^Body 'punch': no facet has the tag 6; known: "):
        punch.surface(6)
    with pytest.raises(tw.CaseError, match=r"materials by cell tag need the MeshTags"):
        tw.Body("punch", punch.mesh, None, punch.facets, {1: tw.Material(1e9, 0.3)})


def test_frames_need_pandas(ring):
    """requirement: a clear message without pandas; with it, columns of all points."""
    initial = ring[0].initial()
    try:
        frame = initial.to_dataframe()
    except tw.CaseError as fault:
        assert str(fault) == "to_dataframe: needs pandas (Debian: python3-pandas)"
    else:
        assert len(frame) == len(initial.pressure(ring[1]).values)


def test_advection_is_for_one_body_that_passes(ring):
    """requirement: two moving bodies, or one that turns in place, are refused in one line."""
    model = ring[0]
    carried = replace(model, heat=tw.Heat(advection="resolved"))
    with pytest.raises(tw.CaseError, match=r"^heat\.advection: is for one body that passes"):
        carried.steady()
    both = dict(zip(model.bodies, (tw.Rotation(1.0), tw.Rotation(-1.0)), strict=True))
    with pytest.raises(tw.CaseError, match=r"^Heat\.advection: .*found 2 in Model\.motions"):
        replace(carried, motions=both).steady()

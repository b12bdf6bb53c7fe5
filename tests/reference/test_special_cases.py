"""Closed forms of steady wear, against equilibrium by another integration and against print."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import dblquad, quad
from scipy.optimize import brentq

from thermowear.reference import annular_punch, rigid_faces
from thermowear.reference.rigid_faces import ArcBlock, DrumBrakeShoe, LeverBlock

EXPONENTS = (0.3, 0.5, 1.0, 2.0, 4.0)


@pytest.mark.parametrize("b", EXPONENTS)
@pytest.mark.parametrize("arm", [0.0, 1e-4, 0.02, -0.09, 0.2, -0.35, 0.49])
def test_tilted_face(b, arm):
    """requirement: the pressure carries force and moment; p^b is linear where there is pressure."""
    force, length, width = 3e3, 0.2, 0.04
    moment = arm * length * force

    def pressure(x):
        return float(rigid_faces.tilted_pressure(x, force, moment, length, width, b))

    zone = rigid_faces.contact_length(force, moment, length, b)
    loaded = np.copysign(length / 2, moment)
    ends = sorted((loaded, loaded - np.copysign(zone, moment)))
    assert width * quad(pressure, *ends, epsabs=0, epsrel=1e-11, limit=200)[0] == pytest.approx(
        force, rel=1e-8
    )
    turned = width * quad(lambda x: x * pressure(x), *ends, epsabs=1e-9, limit=200)[0]
    assert turned == pytest.approx(moment, rel=1e-7, abs=1e-7)
    x = np.linspace(*ends, 7)[1:-1]
    rate = rigid_faces.tilted_pressure(x, force, moment, length, width, b) ** b
    np.testing.assert_allclose(np.diff(rate, 2), 0.0, atol=1e-9 * rate.max())
    if zone < length:
        beyond = ends[0] - 1e-3 if moment > 0 else ends[1] + 1e-3
        assert pressure(beyond) == 0.0


def test_linear_pressure_is_the_one_of_b_1():
    x = np.linspace(-0.1, 0.1, 9)
    for arm in (0.0, 0.03, -0.16):
        data = (2e3, arm * 2e3 * 0.2, 0.2, 0.03)
        np.testing.assert_allclose(
            rigid_faces.linear_pressure(x, *data),
            rigid_faces.tilted_pressure(x, *data, 1.0),
            rtol=1e-10,
            atol=1.0,
        )


def test_tilting_punch_in_print():
    """requirement: the table of the rectangular punch, from its own closed form."""
    for b, (constant, slope, *pressures) in rigid_faces.TILTING_PUNCH.items():
        x = np.array([-0.03, 0.0, 0.03])
        p = rigid_faces.tilted_pressure(x, 10e3, -10e3 * 5e-3, 0.06, 0.08, b) / 1e6
        np.testing.assert_allclose(p, [float(text) for text in pressures], atol=0.51e-6)
        assert p[1] ** b == pytest.approx(float(constant), abs=0.51e-6)
        assert 1 - (p[2] / p[1]) ** b == pytest.approx(float(slope), abs=0.51e-6)


def test_centred_punch():
    """requirement: Z p^b S, with p = F/S."""
    p = rigid_faces.centred_pressure(1e4, 2e-3)
    assert p == pytest.approx(5e6)
    volume = rigid_faces.volume_rate(1e4, 2e-3, 3e-20, 2.0)
    assert volume == pytest.approx(3e-20 * p**2 * 2e-3, rel=1e-13, abs=0.0)


@pytest.mark.parametrize("b", EXPONENTS)
@pytest.mark.parametrize("friction", [-0.6, 0.0, 0.4])
def test_arc_is_in_equilibrium(b, friction):
    """requirement: vertical components of pressure and friction, summed over small pieces."""
    α = np.linspace(-0.4, 0.9, 200001)
    p = ArcBlock(0.03, 0.02, -0.4, 0.9, friction, b).pressure(α, 800.0)
    middle, dα = (p[1:] + p[:-1]) / 2, np.diff(α)
    centre = (α[1:] + α[:-1]) / 2
    vertical = middle * (np.cos(centre) + friction * np.sin(centre)) * dα * 0.03 * 0.02
    assert vertical.sum() == pytest.approx(800.0, rel=1e-9)
    np.testing.assert_allclose(p**b / np.cos(α), p[0] ** b / np.cos(α[0]), rtol=1e-12)


def test_arcs_in_print():
    force, size = rigid_faces.FORCE, (rigid_faces.RADIUS, rigid_faces.WIDTH)
    for b, text in rigid_faces.SYMMETRIC.items():
        p = ArcBlock(*size, -0.5, 0.5, 0.77, b).pressure(0.0, force) / 1e6
        assert p == pytest.approx(float(text), abs=0.51e-6)
    for sense, text in rigid_faces.ASYMMETRIC.items():
        p = ArcBlock(*size, -0.2, 0.7, sense * 0.3, 1.0).pressure(0.0, force) / 1e6
        assert p == pytest.approx(float(text), abs=0.51e-6)
    peak = ArcBlock(*size, -0.5, 0.5, 0.3).symmetric_peak(force) / 1e6
    assert peak == pytest.approx(5.430441, abs=0.51e-6)


def test_descent_of_the_block():
    """requirement: ``Z (F/I)^b`` is the wear rate where the face is horizontal."""
    face = ArcBlock(0.03, 0.02, -0.4, 0.9, 0.3, 2.0)
    p = face.pressure(0.0, 800.0)
    assert face.rate(800.0, 3e-20) == pytest.approx(3e-20 * p**2, abs=0.0)


@pytest.mark.parametrize("b", EXPONENTS)
@pytest.mark.parametrize("friction", [-0.9, 0.0, 0.4])
def test_lever_is_in_equilibrium(b, friction):
    data = (0.03, 0.11, 0.05, 0.02)
    face = LeverBlock(*data, friction, b)

    def moment(z):
        p = float(face.pressure(z, 90.0))
        return p * (z + friction * data[2]) * data[3]

    assert quad(moment, *data[:2], epsabs=0, epsrel=1e-12)[0] == pytest.approx(90.0, rel=1e-10)


def test_levers_in_print():
    lever = rigid_faces.LEVER
    for (b, sense), texts in rigid_faces.LEVER_ENDS.items():
        face = replace(lever, b=b, friction=sense * lever.friction)
        for z, text in zip((lever.inner, lever.outer), texts, strict=True):
            p = face.pressure(z, rigid_faces.LEVER_MOMENT)
            digits = len(text.partition(".")[2])
            assert p / 1e6 == pytest.approx(float(text), abs=0.51 * 10.0**-digits)


@pytest.mark.parametrize("b", EXPONENTS)
def test_friction_that_locks(b):
    """requirement: where the moment of friction takes up that of the pressure."""
    face = LeverBlock(0.03, 0.11, 0.05, 0.02, 0.0, b)

    def integral(friction):
        return replace(face, friction=-friction).bearing_integral()

    assert face.locking_friction() == pytest.approx(brentq(integral, 0.1, 9.0))


SHOE = {"radius": 0.15, "pivot_distance": 0.125, "width": 0.04, "start": 0.0}


def test_brake_in_print():
    """requirement: Shigley, problem 16-1: 734 kPa on the leading shoe."""
    shoe = DrumBrakeShoe(**SHOE, end=np.radians(120), friction=-0.28)
    moment = 2200 * 2 * 0.125 * np.cos(np.radians(30))
    assert moment / shoe.actuating_moment(1.0) == pytest.approx(734e3, rel=1e-3)


@pytest.mark.parametrize(("start", "end"), [(0.0, 2.0), (0.2, 1.2), (1.7, 2.6)])
@pytest.mark.parametrize("friction", [-0.3, 0.3])
def test_long_shoe_law(start, end, friction):
    """requirement: closed integrals of the law, against sums over small pieces."""
    shoe = DrumBrakeShoe(**SHOE | {"start": start}, end=end, friction=friction)
    θ = np.linspace(start, end, 100001)
    largest = 5e5
    p = largest * np.sin(θ) / np.sin(θ).max()
    area = shoe.width * shoe.radius
    arm = shoe.radius - shoe.pivot_distance * np.cos(θ)

    def total(f):
        return np.sum((f[1:] + f[:-1]) / 2 * np.diff(θ)) * area

    assert shoe.normal_moment(largest) == pytest.approx(
        total(p * shoe.pivot_distance * np.sin(θ)), rel=1e-7
    )
    assert shoe.friction_moment(largest) == pytest.approx(total(friction * p * arm), rel=1e-7)
    assert shoe.torque(largest) == pytest.approx(total(abs(friction) * p * shoe.radius), rel=1e-7)
    found = shoe.pressure(θ, shoe.actuating_moment(largest))
    np.testing.assert_allclose(found, p, rtol=1e-10, atol=1e-6)


def test_leading_shoe_bears_more():
    """requirement: the ratio of pressures under equal actuating moments."""
    leading, trailing = (DrumBrakeShoe(**SHOE, end=2.0, friction=f) for f in (-0.3, 0.3))
    ratio = trailing.actuating_moment(1.0) / leading.actuating_moment(1.0)
    assert leading.leading_over_trailing() == pytest.approx(ratio, rel=1e-12)
    assert trailing.leading_over_trailing() == pytest.approx(ratio, rel=1e-12)
    assert ratio > 1.5


@pytest.mark.parametrize(("b", "a"), [(1.0, 1.0), (2.0, 0.5), (0.5, 2.0)])
def test_straight_pad(b, a):
    """requirement: the force, and p^b v^a uniform; for a = b the uniform wear of brakes."""
    data = (0.06, 0.11, 0.8)

    def force(r):
        return (
            float(annular_punch.steady_pressure(r, 700.0, *data[:2], b, a, data[2])) * data[2] * r
        )

    assert quad(force, *data[:2])[0] == pytest.approx(700.0, rel=1e-10)
    r = np.linspace(*data[:2], 5)
    p = annular_punch.steady_pressure(r, 700.0, *data[:2], b, a, data[2])
    np.testing.assert_allclose(p**b * r**a, p[0] ** b * r[0] ** a)
    if a == b:
        assert annular_punch.uniform_wear_force(p[0], *data) == pytest.approx(700.0)
        torque = quad(lambda r: 0.4 * force(r) * r, *data[:2])[0]
        known = annular_punch.uniform_wear_torque(700.0, 0.4, *data[:2])
        assert torque == pytest.approx(known, rel=1e-10)


@pytest.mark.parametrize("lift", [0.0, 0.004, -0.003])
@pytest.mark.parametrize("a", [0.0, 1.0, 2.0, 2.5])
def test_tilting_pad_is_in_equilibrium(lift, a):
    """requirement: force and both moments, friction's included."""
    force, centre, inner, outer, angle = 500.0, (0.078, -0.003), 0.06, 0.1, 1.1

    def total(arm):
        def integrand(r, φ):
            x, y = r * np.cos(φ), r * np.sin(φ)
            p = annular_punch.tilted_pressure(x, y, force, centre, inner, outer, angle, a, lift)
            return float(p) * arm(x, y, φ) * r

        return dblquad(integrand, -angle / 2, angle / 2, inner, outer)[0]

    assert total(lambda x, y, φ: 1.0) == pytest.approx(force, rel=1e-9)
    along, across = (force * c for c in centre)
    assert total(lambda x, y, φ: x + lift * np.sin(φ)) == pytest.approx(along, rel=1e-9)
    assert total(lambda x, y, φ: y - lift * np.cos(φ)) == pytest.approx(across, rel=1e-9)


def test_cone_and_torus_are_in_equilibrium():
    """requirement: ``∫ p (sin α + mu_d cos α) 2 π r ds`` is the force; flat faces are a limit."""
    force, inner, outer, mu, b, a = 2e4, 0.03, 0.09, 0.25, 1.7, 0.6
    for α in (0.6, 1.2, np.pi / 2):

        def ring(r, α=α):
            p = float(annular_punch.conical_pressure(r, force, inner, outer, α, mu, b, a))
            return p * (np.sin(α) + mu * np.cos(α)) * 2 * np.pi * r / np.sin(α)

        assert quad(ring, inner, outer)[0] == pytest.approx(force, rel=1e-10)
    r = np.linspace(inner, outer, 4)
    np.testing.assert_allclose(
        annular_punch.conical_pressure(r, force, inner, outer, np.pi / 2, mu, b, a),
        annular_punch.steady_pressure(r, force, inner, outer, b, a),
    )

    def strip(α):
        p = annular_punch.toroidal_pressure(α, force, 0.05, 0.02, 0.4, 1.5, mu, b, a)[0]
        radius = 0.05 + 0.02 * np.cos(α)
        return p * (np.sin(α) + mu * np.cos(α)) * 2 * np.pi * radius * 0.02

    assert quad(strip, 0.4, 1.5)[0] == pytest.approx(force, rel=1e-9)


def test_torus_wears_down_at_one_rate():
    """requirement: ``p^b r^a/sin α`` is the same all over the face."""
    α = np.linspace(0.4, 1.5, 6)
    b, a = 0.7, 1.3
    p = annular_punch.toroidal_pressure(α, 1e4, 0.05, 0.02, 0.4, 1.5, 0.2, b, a)
    rate = p**b * (0.05 + 0.02 * np.cos(α)) ** a / np.sin(α)
    np.testing.assert_allclose(rate, rate[0], rtol=1e-12)


def test_ring_in_print():
    """requirement: the table of the flat ring under 100 MPa."""
    force = 100e6 * np.pi * (0.12**2 - 0.02**2)
    places = np.array([0.02, 0.04, 0.07, 0.12])
    for b, (power, constant, pressures, torque) in annular_punch.STEADY_PRESSURE.items():
        p = annular_punch.steady_pressure(places, force, 0.02, 0.12, b) / 1e6
        for value, text in zip(p, pressures, strict=True):
            digits = len(text.partition(".")[2])
            assert value == pytest.approx(float(text), abs=0.51 * 10.0**-digits)
        assert p[0] * 20**power == pytest.approx(float(constant), rel=1e-5)
        found = 1e3 * annular_punch.torque(force, 0.02, 0.12, 1.0, b, 1.0)
        assert found == pytest.approx(float(torque), rel=2e-5)

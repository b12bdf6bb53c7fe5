"""Closed form of hot spots of a layer between two half-planes."""

from dataclasses import replace

import pytest

from thermowear.reference.instability import (
    ConductorOnInsulator,
    LayerBetweenHalfPlanes,
    WaveMaterial,
)

DISK = WaveMaterial(125e9, 0.25, 12e-6, 54.0, 12.98e-6)
PADS = WaveMaterial(0.53e9, 0.25, 30e-6, 0.5, 0.269e-6)
LAYER = LayerBetweenHalfPlanes(DISK, PADS, 0.01, 0.4)


@pytest.mark.parametrize(
    ("thickness", "symmetric", "published"),
    [
        (0.01, False, (4.514, 41.20, 2.40e-2)),
        (0.01, True, (356.4, 125.4, None)),
        (0.02, False, (2.257, 20.60, 1.20e-2)),
        (0.02, True, (178.2, 62.7, None)),
    ],
)
def test_first_hot_spots(thickness, symmetric, published):
    """requirement: published critical speed, wave number and drift of the first mode."""
    found = replace(LAYER, thickness=thickness).first(symmetric)
    for value, known in zip(found, published, strict=True):
        assert known is None or value == pytest.approx(known, rel=1e-3)


@pytest.mark.parametrize(
    ("m", "speed"), [(20.0, 9.330), (40.0, 4.520), (80.0, 8.259), (160.0, 40.60)]
)
def test_given_wave_numbers(m, speed):
    """requirement: published critical speeds of antisymmetric modes."""
    assert LAYER.critical(m, False)[0] == pytest.approx(speed, rel=1e-4)


def insulated(m):
    """Thick layer on insulating pads that do not expand, and its simpler closed form."""
    pads = replace(PADS, conductivity=1e-9, expansion=0.0)
    modulus = 2 / m / (DISK.softness(m) + pads.softness(m))
    simple = ConductorOnInsulator(
        2 * 3.141592653589793 / m,
        modulus,
        DISK.poisson_ratio,
        DISK.expansion,
        DISK.conductivity,
        0.4,
        DISK.conductivity / DISK.diffusivity,
    )
    return LayerBetweenHalfPlanes(DISK, pads, 40.0 / m, 0.4), simple


@pytest.mark.parametrize("symmetric", [True, False])
def test_thick_layer_on_insulators(symmetric):
    """requirement: the conductor on an insulator, also its growth rates."""
    layer, simple = insulated(30.0)
    speed, drift = layer.critical(30.0, symmetric)
    assert speed == pytest.approx(simple.critical_speed, rel=1e-6)
    assert drift == pytest.approx(0.0, abs=1e-9)
    for part in (0.7, 1.3):
        rate = layer.growth(30.0, symmetric, part * speed)
        exact = simple.growth_rate(part * simple.critical_speed)
        assert rate == pytest.approx(exact, rel=1e-5)


def test_plane_stress():
    """requirement: flattening 2/(E m), and rise by heat without Poisson's ratio."""
    stress = DISK.plane_stress
    assert stress.softness(40.0) == pytest.approx(2 / (DISK.young_modulus * 40.0), rel=1e-12)
    lift = stress.expansion * (1 + stress.poisson_ratio)
    assert lift == pytest.approx(DISK.expansion, rel=1e-12)


def test_growth_changes_sign_at_the_critical_speed():
    """requirement: waves decay below and grow above it, and travel alike."""
    speed, drift = LAYER.critical(41.2, False)
    below, above = (LAYER.growth(41.2, False, part * speed) for part in (0.99, 1.01))
    assert below.real < 0 < above.real
    assert -(below.imag + above.imag) / 2 / 41.2 == pytest.approx(drift, rel=1e-2)


def test_wear():
    """requirement: wear of the layer stabilises, that of the pads hardly matters."""
    plain = LAYER.critical(41.2, False)[0]
    worn = replace(LAYER, wear_layer=1e-11)
    speed, drift = worn.critical(41.2, False)
    assert speed > 1.1 * plain
    residual = worn.excess(41.2, False, speed, -1j * drift * 41.2)
    assert abs(residual) < 1e-9 * PADS.softness(41.2)
    other = replace(LAYER, wear_pads=1e-11).critical(41.2, False)[0]
    assert other == pytest.approx(plain, rel=1e-3)

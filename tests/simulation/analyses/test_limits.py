"""Notes on large strains, large approaches, yielding, and clamped surfaces of hot bodies."""

import pytest

from tests.case.starter import HERTZ, changed, tables
from tests.simulation.geometry_update.test_outer_loop import STRIP, Notes
from thermowear import load, run


def told(case, *overrides):
    notes = Notes()
    run(load(case, overrides), observer=notes)
    return notes.told


@pytest.mark.parametrize(("part", "yields"), [(0.53, True), (0.58, False)])
def test_the_block_under_a_cylinder_yields_at_the_pressure_of_the_closed_form(part, yields):
    """requirement: K.L. Johnson, Contact Mechanics, 4.1: σ_vM = 0.557 p0 at most for ν = 0.3."""
    case = tables(HERTZ)
    most = run(load(case)).summary["max_pressure_Pa"]
    strength = {"bodies.cylinder.yield_strength": f"{part * most} Pa"}
    found = [note for note in told(changed(case, strength)) if "yield_strength" in note]
    assert bool(found) is yields
    if yields:
        assert found[0].startswith("bodies.cylinder.yield_strength: the von Mises stress reaches")


@pytest.mark.parametrize(
    ("modulus", "strained", "deep"), [(1500, False, False), (300, True, False), (60, True, True)]
)
def test_strains_count_but_for_the_singular_edges(modulus, strained, deep):
    """requirement: p = 10 MPa in plane strain strains by 2 (1 + ν)/3 sqrt(1 - ν + ν²) p / E.

    That is 0.77 p / E, 0.5, 2.6 and 13 %; singular corners do not count, where any mesh finds more.
    Faces approach each other by 0.91 p H / E for each body of height H.
    """
    case = STRIP | {"analysis": {"type": "initial"}, "geometry": STRIP["geometry"]}
    bodies = {"punch": {"young_modulus": f"{modulus} MPa", "poisson_ratio": 0.3}}
    notes = told(case | {"bodies": bodies | {"strip": {"like": "punch"}}})
    assert any("is strained by" in note for note in notes) is strained
    assert any("of the thickness of" in note for note in notes) is deep


def test_a_clamped_hot_surface_is_named():
    """requirement: a hot ring whose top is clamped is strained by about α ΔT there."""
    case = tables("annular-punch")
    hot = changed(case, {"motion.angular_velocity": "0.8 rad/s", "mesh.degree": 3})
    (note,) = [text for text in told(hot, 'analysis.type="steady"') if "is clamped" in text]
    assert "punch_top" in note or "plate_bottom" in note

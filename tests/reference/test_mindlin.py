"""Closed forms of contacts that stick and slip, against integrals."""

import itertools
from dataclasses import dataclass

import numpy as np
import pytest
from scipy.integrate import quad

from thermowear.reference.elastic_contact.hertz import MindlinLine


@dataclass(frozen=True)
class MindlinSphere:
    """Two spheres; slip transverse to Q is neglected, as by Mindlin.

    Attributes
    ----------
    force, radius, compliance, friction : float
        P [N], contact radius a [m], ``(2 - ν1)/G1 + (2 - ν2)/G2`` [1/Pa], and mu.
    """

    force: float
    radius: float
    compliance: float
    friction: float

    def displacement(self, tangential: float) -> float:
        """Distant displacement on first loading, ``3 mu P/(16 a) K (1 - (1 - f)^(2/3))`` [m].

        Johnson, section 7.2, with ``f = |Q|/(mu P)`` and K the compliance.
        """
        limit = self.friction * self.force
        scale = 3 * limit * self.compliance / (16 * self.radius)
        return float(np.sign(tangential) * scale * (1 - (1 - abs(tangential) / limit) ** (2 / 3)))

    def loss_per_cycle(self, amplitude: float) -> float:
        """Energy dissipated in a full cycle of Q between plus and minus the amplitude [J].

        Area of the loop that results from `displacement` and Masing's rule,
        ``8 (∫ Q dδ - Q δ/2)``, which is the result of Mindlin and Deresiewicz (1953)
        ``9 (mu P)²/(10 a) K (1 - (1 - f)^(5/3) - 5 f/6 (1 + (1 - f)^(2/3)))``.
        """
        limit = self.friction * self.force
        f = abs(amplitude) / limit
        shape = 1 - (1 - f) ** (5 / 3) - 5 * f / 6 * (1 + (1 - f) ** (2 / 3))
        return 9 * limit**2 * self.compliance / (10 * self.radius) * shape


LINE = MindlinLine(force=2e5, radius=0.03, modulus=1.1e11, friction=0.35)
SPHERE = MindlinSphere(force=300.0, radius=2e-4, compliance=4e-11, friction=0.6)
PARTS = (0.05, 0.5, 0.93)


def over_contact(f, *kinks):
    a = LINE.normal.half_width
    ends = sorted({-a, a, *kinks, *(-k for k in kinks)})
    return sum(quad(f, *pair)[0] for pair in itertools.pairwise(ends))


@pytest.mark.parametrize("part", PARTS)
def test_shear_carries_the_tangential_force(part):
    """requirement: the integral of the shear is Q, on loading and on unloading; ``|q| <= mu p``."""
    Q = part * LINE.limit
    x = np.linspace(-1.1, 1.1, 301) * LINE.normal.half_width
    bound = LINE.friction * LINE.normal.pressure(x) * (1 + 1e-12)
    loaded = over_contact(lambda s: LINE.shear(s, Q), LINE.stick_half_width(Q))
    assert loaded == pytest.approx(Q, rel=1e-9)
    for back in (0.6 * Q, -0.3 * Q, -Q):
        kinks = LINE.stick_half_width(Q), LINE.stick_half_width((Q - back) / 2)
        carried = over_contact(lambda s, back=back: LINE.shear_after(s, Q, back), *kinks)
        assert carried == pytest.approx(back, rel=1e-9)
        assert np.all(np.abs(LINE.shear_after(x, Q, back)) <= bound)
    np.testing.assert_allclose(LINE.shear_after(x, Q, -Q), LINE.shear(x, -Q), atol=1e-6)


def test_limits():
    """requirement: no force sticks everywhere; ``mu P`` slides with ``mu p``."""
    a, x = LINE.normal.half_width, np.linspace(-1, 1, 51) * LINE.normal.half_width
    assert LINE.stick_half_width(0.0) == a
    assert LINE.stick_half_width(LINE.limit) == 0.0
    np.testing.assert_allclose(LINE.shear(x, LINE.limit), LINE.friction * LINE.normal.pressure(x))
    np.testing.assert_array_equal(LINE.slip(x, 0.0), 0.0)
    assert LINE.loss_on_loading(LINE.limit) == pytest.approx(
        LINE.limit**2 / (2 * np.pi * LINE.modulus)
    )
    f = 0.01  # small amplitudes lose with their third power
    small = 2 * LINE.limit**2 / (np.pi * LINE.modulus) * f**3 / 3
    assert LINE.loss_per_cycle(f * LINE.limit) == pytest.approx(small, rel=0.01)


@pytest.mark.parametrize("part", [0.3, 0.6, 0.93])
def test_slip_from_the_shear(part):
    """requirement: the slip is what the half-planes do under the shear, by their kernel."""
    Q, a = part * LINE.limit, LINE.normal.half_width
    φ = (np.arange(40000) + 0.5) * np.pi / 40000
    c = LINE.stick_half_width(Q)

    def displacement(x):  # two ellipses, each by the midpoint rule in its own angle
        total = 0.0
        for b, sign in ((a, 1.0), (c, -1.0)):
            peak = sign * LINE.friction * LINE.normal.peak * b / a
            total += np.mean(peak * np.sin(φ) ** 2 * b * np.log(np.abs(x - b * np.cos(φ)))) * np.pi
        return 2 / (np.pi * LINE.modulus) * total

    for x in (c + 0.37 * (a - c), c + 0.9 * (a - c)):
        slip = displacement(x) - displacement(0.2 * c)
        assert slip == pytest.approx(float(LINE.slip(x, Q)), rel=2e-3, abs=1e-4 * LINE.slip(a, Q))


@pytest.mark.parametrize("part", PARTS)
def test_loss_is_friction_times_slip(part):
    """requirement: the closed form of the loss, against its integral."""
    Q = part * LINE.limit
    power = quad(
        lambda x: LINE.normal.pressure(x) * LINE.slip(x, Q),
        LINE.stick_half_width(Q),
        LINE.normal.half_width,
        epsabs=0.0,
        epsrel=1e-9,
    )[0]
    assert LINE.loss_on_loading(Q) == pytest.approx(2 * LINE.friction * power, rel=1e-6)


@pytest.mark.parametrize("part", PARTS)
def test_sphere_loses_the_area_of_its_loop(part):
    """requirement: Mindlin and Deresiewicz' loss is ∮ Q dδ; δ starts as an elastic contact."""
    amplitude = part * SPHERE.friction * SPHERE.force

    def unloading(Q):
        return SPHERE.displacement(amplitude) - 2 * SPHERE.displacement((amplitude - Q) / 2)

    half = quad(unloading, -amplitude, amplitude, epsrel=1e-12)[0]
    # the other branch is the mirror image, so that the loop holds twice the mean of this one
    assert SPHERE.loss_per_cycle(amplitude) == pytest.approx(2 * half, rel=1e-9)
    slope = SPHERE.displacement(1e-6) / 1e-6
    assert slope == pytest.approx(SPHERE.compliance / (8 * SPHERE.radius), rel=1e-6)

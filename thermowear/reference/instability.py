"""Thermoelastic instability of rods, half-planes and layers."""

from __future__ import annotations

import cmath
from dataclasses import dataclass, replace
from math import cosh, exp, log, pi, sinh, sqrt

import numpy as np
from scipy.optimize import brentq, minimize_scalar, newton, root

_POLE = -(pi**2) / 4
"""z of the slowest thermal decay in a rod whose end is insulated."""


@dataclass(frozen=True)
class SlidingRod:
    """Rod pressed on a sliding wall, with friction heat and wear.

    Its far end is fixed and kept at ambient temperature; its other end is pressed by an
    interference d0 on a rigid insulating wall. With Poisson's ratio 0 the rod is equivalent to a
    wider column. Friction heat lengthens the rod, which increases the pressure and thereby the
    heat, without bound above a critical speed: the simplest case of thermoelastic instability (J.
    R. Barber, Proc. R. Soc. A 312 (1969) 381), stabilised by wear (T. A. Dow and R. A. Burton, J.
    Lubr. Technol. 95 (1973) 71).

    A mode growing as ``exp(s t)`` has the temperature ``sinh(x √(s/κ))``, x from the far end. The
    pressure due to its elongation by the heat ``mu p v``, minus wear, equals p if ::

        s = (E v/L) [α mu/(ρ c) (1 - sech(L √(s/κ))) - k_w],

    in terms of ``z = s L²/κ``, ``r = v/vcr`` and ``w = k_w ρ c/(α mu)`` ::

        z = 2 r (1 - sech √z - w).

    Attributes
    ----------
    length, young_modulus, expansion, conductivity, capacity, friction : float
        L [m], E [Pa], α [1/K], k [W/(m K)], ρ c [J/(m³ K)], and mu.
    wear : float
        k_w: worn length per pressure and distance [1/Pa].
    """

    length: float
    young_modulus: float
    expansion: float
    conductivity: float
    capacity: float
    friction: float
    wear: float = 0.0

    @property
    def critical_speed(self) -> float:
        """Critical speed without wear, ``vcr = 2 k/(E α mu L)``; the rod is stable below [m/s]."""
        E, α, mu = self.young_modulus, self.expansion, self.friction
        return 2 * self.conductivity / (E * α * mu * self.length)

    @property
    def critical_speed_with_wear(self) -> float:
        """Critical speed with wear, for k_w up to ``α mu/(ρ c)`` [m/s].

        The critical mode is oscillatory: z is imaginary, so ``Re sech √z = 1 - w``.
        """
        if self.wear == 0.0:
            return self.critical_speed

        def excess(a):
            return (1 - _sech(2j * a**2)).real - self._worn

        z = 2j * brentq(excess, 0.0, pi / 2, xtol=1e-300, rtol=1e-14) ** 2
        return self.critical_speed * abs(z) / (2 * (1 - _sech(z)).imag)

    def pressure(self, interference: float, speed: float) -> float:
        """Pressure ``(E d0/L)/(1 - v/vcr)``, steady below the critical speed, without wear [Pa]."""
        cold = self.young_modulus * interference / self.length
        return cold / (1 - speed / self.critical_speed)

    def growth_rate(self, speed: float) -> complex:
        """Growth rate s of the mode that grows fastest, or decays most slowly, at a speed [1/s].

        With wear the mode may be oscillatory; then the rate with positive imaginary part. Without
        wear the stationary mode of a changed interference, s = 0, is left out.
        """
        r, w = speed / self.critical_speed, self._worn
        z = _unworn(r) if w == 0.0 else _worn(r, w)
        return z * self.conductivity / self.capacity / self.length**2

    @property
    def _worn(self) -> float:
        return self.wear * self.capacity / (self.expansion * self.friction)


def _unworn(r: float) -> complex:
    """Root z without wear, real and right of the pole."""

    def excess(z):
        return 2 * r * ((1 - _sech(z)).real / z if abs(z) > 1e-9 else 0.5 - 5 * z / 24) - 1

    return complex(brentq(excess, _POLE * (1 - 1e-12), 2 * r, xtol=1e-300, rtol=1e-14))


def _worn(r: float, w: float) -> complex:
    """Root z with wear: the larger one of two real roots, or one of a complex pair.

    ``sech √z`` is a Laplace transform of a density, so it is convex right of the pole.
    """

    def excess(z):
        return 2 * r * (1 - _sech(z) - w) - z

    limits = _POLE * (1 - 1e-6), 2 * r
    top = minimize_scalar(
        lambda z: -excess(z).real, bounds=limits, method="bounded", options={"xatol": 1e-9}
    ).x
    if excess(top).real >= 0:
        return complex(brentq(lambda z: excess(z).real, top, 2 * r, xtol=1e-300, rtol=1e-14))
    step = 1e-3 * (top - _POLE)
    bend = np.diff([excess(top + i * step).real for i in (-1, 0, 1)], 2)[0] / step**2
    pair = newton(excess, top + cmath.sqrt(-2 * excess(top).real / bend), tol=1e-15, maxiter=200)
    return complex(pair.real, abs(pair.imag))


def _sech(z: complex) -> complex:
    """Function ``sech √z``."""
    return 1 / cmath.cosh(cmath.sqrt(z))


@dataclass(frozen=True)
class ConductorOnInsulator:
    """Conducting half-plane sliding on an insulator, with friction heat and wear.

    The pressure varies as ``cos(m x)`` along the face, superposed on a mean value, and so do
    friction heat and temperature of the conductor (plane strain). Thermal expansion raises the face
    where the pressure is high: above a critical speed the wave grows (R. A. Burton, V. Nerlikar and
    S. R. Kilaparti, Wear 24 (1973) 177). The insulator is elastic or rigid and may slide in any
    direction.

    A mode growing as ``exp(s t)`` decays with depth as ``exp(-λ y)``, ``s = κ (λ² - m²)``. The
    thermoelastic potential of that temperature and the stress function for a traction-free face
    raise it by ``2 α (1 + ν) T/(λ + m)`` for a temperature ``T = mu v p/(k λ)``; the pressure
    flattens both bodies by ``2 p/(E* m)``, and wear removes ``k_w v p/s``. Equilibrium requires ::

        2 s λ (λ + m)/(E* m) + k_w v λ (λ + m) = 2 α (1 + ν) mu v s/k.

    Without wear this is ``λ (λ + m) = 2 m² v/vcr``, with ``λ = m`` at the critical speed.

    Attributes
    ----------
    wave_length : float
        ``2 π/m`` [m].
    modulus : float
        E* of both, ``1/E* = Σ (1 - ν²)/E``, without the term of a rigid insulator [Pa].
    poisson_ratio, expansion, conductivity, friction, capacity : float
        ν, α [1/K] and k [W/(m K)] of the conductor, mu, and its ρ c [J/(m³ K)].
    wear : float
        k_w: wear depth of both together per pressure and distance [1/Pa].
    """

    wave_length: float
    modulus: float
    poisson_ratio: float
    expansion: float
    conductivity: float
    friction: float
    capacity: float = 1.0
    wear: float = 0.0

    @property
    def wave_number(self) -> float:
        """Wave number ``m = 2 π/wave_length`` [1/m]."""
        return 2 * pi / self.wave_length

    @property
    def critical_speed(self) -> float:
        """Critical speed without wear, ``2 k m/(mu α (1 + ν) E*)``: waves decay below it [m/s]."""
        lift = self.expansion * (1 + self.poisson_ratio)
        return 2 * self.conductivity * self.wave_number / (self.friction * lift * self.modulus)

    def growth_rate(self, speed: float) -> complex:
        """Growth rate s of the mode that grows fastest, or decays most slowly [1/s].

        With wear the mode may be oscillatory; then the rate with positive imaginary part. Without
        wear the stationary mode of an uneven face, s = 0, is left out.
        """
        m, κ = self.wave_number, self.conductivity / self.capacity
        r = speed / self.critical_speed
        if self.wear == 0.0:
            λ = m * (sqrt(1 + 8 * r) - 1) / 2
            return complex(κ * (λ**2 - m**2))
        # divided by λ + m, in terms of λ/m: (λ² - 1) λ + worn λ - 2 r (λ - 1) = 0
        worn = self.wear * speed * self.modulus / (2 * κ * m)
        roots = np.roots([1.0, 0.0, worn - 1 - 2 * r, 2 * r])
        rates = κ * m**2 * (roots[roots.real > 0] ** 2 - 1)
        fastest = rates[np.argmax(rates.real)]
        return complex(fastest.real, abs(fastest.imag))


@dataclass(frozen=True)
class LayerBetweenInsulators:
    """Conducting layer sliding between two insulating half-planes, both pressed on it.

    As `ConductorOnInsulator` on both faces, ``y = ±a``; pressures vary as ``cos(m x)`` along both,
    alike (symmetric modes) or opposite (antisymmetric ones), in a section across the sliding. At
    the critical speed the temperature is steady, ``T ~ cosh(m y) cos(m x)`` or with ``sinh``, with
    ``k dT/dy = mu v p`` at the faces. A harmonic temperature causes no stress in the section: the
    displacements are ``α (1 + ν) ∫ (T + i T*) dz`` with its conjugate T*, and both kinds of modes
    raise the faces by the same ``α (1 + ν) mu v p/(k m²)``. The pressure flattens the layer by
    ``2 (1 - ν²) g p/(E m)``, with

        g = sinh² ma/(sinh ma cosh ma + ma)    or    cosh² ma/(sinh ma cosh ma - ma)

    from the stress functions ``y sinh m y``, ``cosh m y`` and the like (S. P. Timoshenko and J. N.
    Goodier, Theory of Elasticity, sec. 24), and each half-plane by ``2 (1 - ν²) p/(E m)`` of its
    own. Thick layers, g = 1, are half-planes. Symmetric modes then compress less than antisymmetric
    ones bend, and are the first to grow.

    Attributes
    ----------
    wave_length, thickness : float
        ``2 π/m`` and 2 a [m].
    young_modulus, poisson_ratio, expansion, conductivity, friction : float
        E [Pa], ν, α [1/K] and k [W/(m K)] of the layer, and mu.
    softness : float
        ``(1 - ν²)/E`` of each half-plane, zero if they are rigid [1/Pa].
    """

    wave_length: float
    thickness: float
    young_modulus: float
    poisson_ratio: float
    expansion: float
    conductivity: float
    friction: float
    softness: float = 0.0

    @property
    def symmetric(self) -> float:
        """Critical speed of modes symmetric about the middle of the layer [m/s]."""
        ma = pi * self.thickness / self.wave_length
        return self._critical(sinh(ma) ** 2 / (sinh(ma) * cosh(ma) + ma))

    @property
    def antisymmetric(self) -> float:
        """Critical speed of antisymmetric modes, which bend the layer [m/s]."""
        ma = pi * self.thickness / self.wave_length
        return self._critical(cosh(ma) ** 2 / (sinh(ma) * cosh(ma) - ma))

    def _critical(self, flattening: float) -> float:
        m, ν = 2 * pi / self.wave_length, self.poisson_ratio
        flat = 2 * ((1 - ν**2) / self.young_modulus * flattening + self.softness) / m
        lift = self.expansion * (1 + ν) * self.friction / (self.conductivity * m**2)
        return flat / lift


_REMOVABLE = 1e-7
"""Distance from the removable singularity of a steady temperature, relative to m²."""
_STEPS = 24
"""Number of wave numbers that bracket the first hot spots, between 0.05 and 20 over a."""


@dataclass(frozen=True)
class WaveMaterial:
    """Thermoelastic material in plane strain.

    Attributes
    ----------
    young_modulus, poisson_ratio, expansion : float
        E [Pa], ν and α [1/K].
    conductivity, diffusivity : float
        K [W/(m K)] and κ [m²/s].
    """

    young_modulus: float
    poisson_ratio: float
    expansion: float
    conductivity: float
    diffusivity: float

    @property
    def plane_stress(self) -> WaveMaterial:
        """Material whose plane strain is the plane stress of this one.

        ``E' = E (1 + 2 ν)/(1 + ν)²``, ``ν' = ν/(1 + ν)`` and ``α' = α (1 + ν)/(1 + 2 ν)`` (B. A.
        Boley and J. H. Weiner, Theory of Thermal Stresses, sec. 4.3).
        """
        ν = self.poisson_ratio
        return replace(
            self,
            young_modulus=self.young_modulus * (1 + 2 * ν) / (1 + ν) ** 2,
            poisson_ratio=ν / (1 + ν),
            expansion=self.expansion * (1 + ν) / (1 + 2 * ν),
        )

    def softness(self, wave_number: float) -> float:
        """Flattening of a half-plane per pressure, ``2 (1 - ν²)/(E m)`` [m/Pa]."""
        return 2 * (1 - self.poisson_ratio**2) / (self.young_modulus * wave_number)


@dataclass(frozen=True)
class LayerBetweenHalfPlanes:
    """Layer (disk) between two half-planes (pads) that slide along it, with friction heat and wear.

    Plane strain and perfect thermal contact; the effect of shear tractions on the normal
    displacement is neglected (K. Lee and J. R. Barber, J. Tribol. 115 (1993) 607). Pressures vary
    as ``exp(i m x + s t)`` on the layer, on both faces alike (symmetric modes) or opposite
    (antisymmetric ones: hot spots of the two faces alternate). The pads slide along +x with the
    speed V on the layer, so that the rate of the mode is ``s + i m V`` in them.

    Temperatures vary as ``cosh λ y`` or ``sinh λ y`` in the layer and as ``exp(-λ y)`` in the pads,
    with ``λ² = m² + s_b/κ``. The temperature of a face is ``f V p/(K₁ λ₁ tanh λ₁ a + K₂ λ₂)``, with
    coth for antisymmetric modes. The thermoelastic potential ``φ = β T/(λ² - m²)``, ``β = α (1 +
    ν)/(1 - ν)``, and Airy's function of the tractions that free the faces from stress raise those
    of the layer by ::

        2 (1 - ν) S (C φ' - m S φ)/(S C + m a),    S = sinh m a, C = cosh m a,

    in antisymmetric modes by ``2 (1 - ν) C (S φ' - m C φ)/(S C - m a)``; a pad by ``2 α (1 + ν)
    T/(λ + m)``. The pressure flattens the layer by ``2 (1 - ν²) p/(E m)`` times ``S²/(S C + m a)``
    or ``C²/(S C - m a)``, a pad by this alone, and body b wears by ``k_b V p/s_b``.

    Attributes
    ----------
    layer, pads : WaveMaterial
    thickness : float
        2 a [m].
    friction : float
        f.
    wear_layer, wear_pads : float
        k: wear depth per pressure and sliding distance [1/Pa].
    """

    layer: WaveMaterial
    pads: WaveMaterial
    thickness: float
    friction: float
    wear_layer: float = 0.0
    wear_pads: float = 0.0

    def excess(self, wave_number: float, symmetric: bool, speed: float, rate: complex) -> complex:
        """Rise of the faces by heat less flattening and wear, per pressure; zero of a mode [m/Pa].

        Parameters
        ----------
        wave_number : float
            m [1/m].
        symmetric : bool
        speed : float
            V [m/s].
        rate : complex
            s, growth rate and angular frequency on the layer [1/s].
        """
        m, pads, in_pads = wave_number, self.pads, rate + 1j * wave_number * speed
        raised, flattened, into = self._layer(m, symmetric, rate)
        λ = cmath.sqrt(m**2 + in_pads / pads.diffusivity)
        temperature = self.friction * speed / (into + pads.conductivity * λ)
        raised += 2 * pads.expansion * (1 + pads.poisson_ratio) / (λ + m)
        worn = 0j
        for wear, own in ((self.wear_layer, rate), (self.wear_pads, in_pads)):
            worn += wear * speed / own if wear else 0.0
        return temperature * raised - flattened - pads.softness(m) - worn

    def critical(self, wave_number: float, symmetric: bool) -> tuple[float, float]:
        """Critical speed, and velocity of the mode on the layer along the pads' sliding [m/s].

        The lowest one found from modes that stand still, or nearly so, on the layer or the pads.
        """
        m, cold = wave_number, replace(self, wear_layer=0.0, wear_pads=0.0)
        scale, found = self.layer.diffusivity * m**2, []
        for part in (0.0, -1.0, 1.0, -30.0, 30.0):
            speed = cold._standing(m, symmetric)
            one = cold._neutral(m, symmetric, speed, part * scale)
            found += [] if one is None else [one]
        best = min(found)
        if self.wear_layer or self.wear_pads:
            for part in np.linspace(0.0, 1.0, 11)[1:] ** 2:
                worn = replace(
                    self, wear_layer=part * self.wear_layer, wear_pads=part * self.wear_pads
                )
                following = worn._neutral(m, symmetric, *best)
                assert following is not None
                best = following
        return best[0], -best[1] / m

    def first(self, symmetric: bool) -> tuple[float, float, float]:
        """Lowest critical speed [m/s], its wave number [1/m], and velocity on the layer [m/s]."""
        a = self.thickness / 2
        numbers = np.geomspace(0.05, 20.0, _STEPS) / a
        speeds = [self.critical(float(m), symmetric)[0] for m in numbers]
        k = int(np.argmin(speeds))
        ends = log(numbers[max(k - 1, 0)]), log(numbers[min(k + 1, _STEPS - 1)])
        best = minimize_scalar(
            lambda x: self.critical(exp(x), symmetric)[0],
            bounds=ends,
            method="bounded",
            options={"xatol": 1e-7},
        )
        speed, drift = self.critical(exp(best.x), symmetric)
        return speed, exp(best.x), drift

    def growth(self, wave_number: float, symmetric: bool, speed: float) -> complex:
        """Rate of the mode on the layer that is neutral at the critical speed [1/s]."""
        start, drift = self.critical(wave_number, symmetric)
        rate, scale = -1j * drift * wave_number, self.layer.diffusivity * wave_number**2
        for v in np.geomspace(start, speed, 2 + int(20 * abs(log(speed / start)))):

            def residual(x: np.ndarray, v: float = float(v)) -> list[float]:
                value = self.excess(wave_number, symmetric, v, complex(*x) * scale)
                value /= self.pads.softness(wave_number)
                return [value.real, value.imag]

            found = root(residual, [rate.real / scale, rate.imag / scale], tol=1e-13)
            rate = complex(*found.x) * scale
        return rate

    def _standing(self, m: float, symmetric: bool) -> float:
        """Speed at which the real parts of a mode that stands still on the layer balance."""
        raised, flattened, into = self._layer(m, symmetric, 0.0)
        flat, speed = flattened + self.pads.softness(m), 1.0
        for _ in range(60):
            λ = cmath.sqrt(m**2 + 1j * m * speed / self.pads.diffusivity)
            raised_pads = 2 * self.pads.expansion * (1 + self.pads.poisson_ratio) / (λ + m)
            gain = self.friction * (raised + raised_pads) / (into + self.pads.conductivity * λ)
            speed = (speed * flat / abs(gain)) ** 0.5
        return speed

    def _neutral(
        self, m: float, symmetric: bool, speed: float, frequency: float
    ) -> tuple[float, float] | None:
        """Speed and angular frequency of a neutral mode near given ones."""
        scale = max(abs(frequency), self.layer.diffusivity * m**2)

        def residual(x: np.ndarray) -> list[float]:
            value = self.excess(m, symmetric, exp(min(x[0], 50.0)), 1j * x[1] * scale)
            value /= self.pads.softness(m)
            return [value.real, value.imag]

        found = root(residual, [log(speed), frequency / scale], tol=1e-13)
        if np.abs(residual(found.x)).max() > 1e-8:
            return None
        return exp(found.x[0]), float(found.x[1] * scale)

    def _layer(self, m: float, symmetric: bool, rate: complex) -> tuple[complex, float, complex]:
        """Rise of a face per temperature, flattening per pressure, and heat per temperature."""
        own, a = self.layer, self.thickness / 2
        if abs(rate) < _REMOVABLE * own.diffusivity * m**2:
            step = 1.5 * _REMOVABLE * own.diffusivity * m**2
            one, other = (np.array(self._layer(m, symmetric, sign * step)) for sign in (1, -1))
            raised, flat, into = (one + other) / 2 + rate * (one - other) / (2 * step)
            return complex(raised), float(flat.real), complex(into)
        λ = cmath.sqrt(m**2 + rate / own.diffusivity)
        t = np.tanh(m * a) if symmetric else 1 / np.tanh(m * a)
        slope = λ * (cmath.tanh(λ * a) if symmetric else 1 / cmath.tanh(λ * a))
        # sinh and cosh divided by cosh in symmetric modes, by sinh in antisymmetric ones
        bulk = m * a / (np.cosh(m * a) ** 2 if symmetric else -(np.sinh(m * a) ** 2))
        ν, E = own.poisson_ratio, own.young_modulus
        potential = own.expansion * (1 + ν) / (1 - ν) / (rate / own.diffusivity)
        raised = 2 * (1 - ν) * t * potential * (slope - m * t) / (t + bulk)
        flattened = 2 * (1 - ν**2) / (E * m) * t**2 / (t + bulk)
        return raised, float(flattened), own.conductivity * slope

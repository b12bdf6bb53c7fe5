"""Hot spots of a layer that slides between two half-planes: thermoelastic instability."""

from __future__ import annotations

import cmath
from dataclasses import dataclass, replace
from math import exp, log

import numpy as np
from scipy.optimize import minimize_scalar, root

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

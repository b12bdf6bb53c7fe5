"""Table ``study``: distributions of uncertain inputs, and their sampling."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Literal

from pydantic import Field, model_validator

from ..values.section import KeyFault, Number, Section
from .scalars import Scalar, ScalarKey, SpreadKey

_NEEDED = {
    "normal": ("mean", "deviation"),
    "lognormal": ("median", "factor"),
    "uniform": ("lower", "upper"),
    "loguniform": ("lower", "upper"),
    "triangular": ("lower", "mode", "upper"),
}
"""Keys of each distribution."""
_CUT = {"normal": ("lower", "upper")}
"""Keys by which a distribution may be cut off."""
_KEYS = ("mean", "deviation", "median", "factor", "mode", "lower", "upper")


class InputTable(Section):
    """Distribution of a key of the case.

    Attributes
    ----------
    mean : Scalar or None
        Mean of a normal distribution, which `lower` and `upper` may cut off.
    deviation : Spread or None
        Standard deviation of a normal distribution.
    median : Scalar or None
        Median of a lognormal distribution.
    factor : float or None
        Factor of a lognormal distribution: 95 % of the values lie between the median divided by it,
        and multiplied by it.
    lower : Scalar
        Lower end of a uniform, loguniform or triangular distribution.
    mode : Scalar
        Most probable value of a triangular distribution.
    upper : Scalar
        Upper end of a uniform, loguniform or triangular distribution.
    distribution : str
        ``"normal"``, ``"lognormal"``, ``"uniform"``, ``"loguniform"`` or ``"triangular"``.
    """

    distribution: Literal["normal", "lognormal", "uniform", "loguniform", "triangular"]
    mean: ScalarKey | None = None
    deviation: SpreadKey | None = None
    median: ScalarKey | None = None
    factor: Annotated[Number, Field(gt=1.0)] | None = None
    mode: ScalarKey | None = None
    lower: ScalarKey | None = None
    upper: ScalarKey | None = None

    @model_validator(mode="after")
    def _fits(self):
        kind = self.distribution
        for key in _NEEDED[kind]:
            if getattr(self, key) is None:
                raise KeyFault(key, f"missing; a {kind} distribution needs it")
        for key in _KEYS:
            known = _NEEDED[kind] + _CUT.get(kind, ())
            if getattr(self, key) is not None and key not in known:
                raise KeyFault(key, f"not a key of a {kind} distribution: {', '.join(known)}")
        try:
            numbers = self.numbers
        except ValueError as error:
            raise KeyFault(_NEEDED[kind][0], str(error)) from None
        if kind == "normal" and not numbers["deviation"] > 0.0:
            raise KeyFault("deviation", "must be greater than 0; a percentage of 0 is 0")
        order = [numbers[key] for key in ("lower", "mode", "upper") if key in numbers]
        if any(not a <= b for a, b in pairwise(order)) or (
            len(order) > 1 and not order[0] < order[-1]
        ):
            raise KeyFault("upper", "must be greater than lower, with the mode between them")
        if kind in ("lognormal", "loguniform") and not min(numbers.values()) > 0.0:
            raise KeyFault(_NEEDED[kind][0], f"must be greater than 0 in a {kind} distribution")
        return self

    @property
    def unit(self) -> str:
        """Unit of the values."""
        return self._first.unit

    @property
    def numbers(self) -> dict[str, float]:
        """Numbers of the keys that are given, in the unit of the first one."""
        found = {}
        for key in _KEYS:
            value = getattr(self, key)
            if isinstance(value, Scalar):
                found[key] = value.in_unit_of(self._first)
            elif value is not None:
                found[key] = value if key == "factor" else value.of(self._first)
        return found

    @property
    def _first(self) -> Scalar:
        return getattr(self, _NEEDED[self.distribution][0])


class StudyTable(Section):
    """Propagation of uncertain inputs.

    Attributes
    ----------
    inputs : dict of str to InputTable
        Distributions by the path of the key.
    samples : int
        Number of samples; of base samples for Sobol indices, which need as many variants times the
        number of inputs plus two.
    method : str
        ``"latin-hypercube"`` or ``"sobol"`` (a low-discrepancy sequence).
    indices : bool
        Compute Sobol indices, too.
    seed : int
        Seed of the random numbers.
    """

    inputs: dict[str, InputTable] = {}
    samples: Annotated[int, Field(ge=2, le=1_000_000, strict=True)] = 128
    method: Literal["latin-hypercube", "sobol"] = "latin-hypercube"
    indices: Annotated[bool, Field(strict=True)] = False
    seed: Annotated[int, Field(ge=0, strict=True)] = 1

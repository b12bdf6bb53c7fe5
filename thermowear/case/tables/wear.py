"""Table ``wear``: wear law of each body, and settings of the geometry updates.

The wear law is ``rate = coefficient · s^b · v^a`` (s: friction stress or pressure),
or any law of the rate.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, ClassVar, Literal

from pydantic import (
    BeforeValidator,
    ConfigDict,
    Field,
    PlainSerializer,
    model_serializer,
    model_validator,
)

from ...laws.interfaces import Law
from ..values.section import KeyFault, Number, Section, number_or
from ..values.units import parse, registry
from .laws import RateOfWear, wear_rate_of
from .tabulated import MultiplierTables

_EXAMPLE = "2e-7 1/MPa"
_OF_POWER = ("coefficient", "per", "pressure_exponent", "velocity_exponent")
"""Keys of a power law."""


def _coefficient(text: Any):
    value = parse(text, _EXAMPLE)
    if not value.magnitude > 0:
        raise ValueError(f'found "{text}"; must be greater than 0')
    return value


def _text(value) -> str:
    """Text that is read back to the same quantity exactly."""
    unit = f"{value.units:~C}"
    if registry().parse_units(unit) != value.units:  # pint rounds the exponents it writes
        unit = " * ".join(f"{name}**{power!r}" for name, power in value.unit_items())
    return f"{value.magnitude!r} {unit}"


Coefficient = Annotated[Any, BeforeValidator(_coefficient), PlainSerializer(_text, return_type=str)]


class RateTable(Section):
    """Wear law: a coefficient with exponents, or a rate.

    Attributes
    ----------
    coefficient : pint.Quantity or None
        Wear coefficient, in a unit that fits both exponents.
    rate : Expression, LawTable or None
        Wear rate as an expression in p, v, T, depth and mu, or a registered law, in place of the
        coefficient, its exponents and `per`.
    per : str
        ``"friction-stress"``: the coefficient multiplies ``(mu p)^b v^a``; ``"pressure"``:
        ``p^b v^a``.
    pressure_exponent, velocity_exponent : float
        b and a.
    factor : MultiplierTables
        Factors of the rate: tables of the temperature of the body's own face, pressure and speed.
    """

    coefficient: Coefficient | None = None
    rate: RateOfWear | None = None
    per: Literal["friction-stress", "pressure"] = "friction-stress"
    pressure_exponent: Annotated[Number, Field(ge=0.1, le=10.0)] = 1.0
    velocity_exponent: Annotated[Number, Field(ge=0.0, le=10.0)] = 1.0
    factor: MultiplierTables = MultiplierTables()

    @property
    def has_law(self) -> bool:
        """True if it has a law, or a key of one."""
        return True

    @model_validator(mode="after")
    def _one_law(self):
        if not self.has_law:
            return self
        if self.rate is not None:
            for key in _OF_POWER:
                if key in self.model_fields_set:
                    raise KeyFault(key, "not allowed together with rate")
            return self
        if self.coefficient is None:
            raise KeyFault("coefficient", "missing")
        try:
            number = self.coefficient_si()
        except (OverflowError, ZeroDivisionError):
            number = math.inf
        if not 0 < number < math.inf:
            raise KeyFault("coefficient", f'found "{_text(self.coefficient)}"; out of range in SI')
        return self

    @model_serializer(mode="wrap")
    def _without_other_keys(self, handler):
        """Leave out the keys of the other type of law or of both, and an empty table of parts."""
        written, left_out = handler(self).items(), {"rate"} if self.rate is None else {*_OF_POWER}
        if self.coefficient is None and self.rate is None:
            left_out = {*RateTable.model_fields}
        return {k: v for k, v in written if k not in left_out and (k != "materials" or v)}

    @property
    def law(self) -> Law | None:
        """Law given by `rate`; None for a coefficient."""
        return None if self.rate is None else wear_rate_of(self.rate)

    @property
    def variables(self) -> frozenset[str]:
        """Variables of the law (p, v, T, depth, mu), without those of the tables of factors."""
        if self.law is not None:
            return self.law.variables
        return frozenset({"p", "v", "mu"} if self.per == "friction-stress" else {"p", "v"})

    @property
    def follows_state(self) -> bool:
        """True if the rate depends on the temperature or on the wear depth."""
        return bool(self.variables & {"T", "depth"})

    def coefficient_si(self) -> float:
        """Coefficient in ``(m/s)^(1-a) Pa^(-b)``.

        Raises
        ------
        ValueError
            If its unit does not fit the exponents.
        """
        assert self.coefficient is not None
        a, b = self.velocity_exponent, self.pressure_exponent
        needed = {"[length]": 1 - a + b, "[time]": a - 1 + 2 * b, "[mass]": -b}
        found = dict(self.coefficient.dimensionality)
        if any(
            abs(needed.get(k, 0) - found.get(k, 0)) > 1e-9 for k in needed.keys() | found.keys()
        ):
            rate = "" if a == 1 else f"(m/s)^{1 - a:.12g} "
            raise KeyFault(
                "coefficient",
                f'the unit of "{_text(self.coefficient)}" does not fit the exponents'
                f" a = {a:g} and b = {b:g}; needs {rate}1/MPa^{b:.12g} or the like",
            )
        return float(self.coefficient.to_base_units().magnitude)


class PartWearTable(RateTable):
    """Wear law of a part of a contact face."""


class BodyWearTable(RateTable):
    """Wear law of one body, and those of its parts.

    Attributes
    ----------
    spread : str
        ``"in-place"``: wear at the contact points; ``"track"``: wear of body 2 along its whole
        track: uniform in plane models; on a rotating disk at each radius, multiplied by the
        fraction of a turn for which it is under the pad.
    materials : dict of str to PartWearTable
        Wear laws by cell set of a mesh file, or by zone of a geometry. All other cells of the face
        wear by the body's own law, which may be omitted if there are none.
    """

    spread: Literal["in-place", "track"] = "in-place"
    materials: dict[str, PartWearTable] = {}

    @property
    def has_law(self) -> bool:
        return not self.materials or bool(self.model_fields_set & RateTable.model_fields.keys())


_UPDATE = number_or(
    "auto",
    "never",
    where=lambda size: 0.0 < size <= 1.0,
    allowed='"auto", "never", or a number up to 1',
)


class WearTable(Section, Mapping[str, BodyWearTable]):
    """Wear laws by body, a mapping to `BodyWearTable`, and settings of the geometry updates.

    Attributes
    ----------
    update : str or float
        Largest gap wear before a geometry update, relative to the sizes of the bodies: a number,
        ``"auto"`` for `AUTOMATIC`, or ``"never"`` for no updates.
    cycles : int or None
        Number of cycles of a fretting or reciprocating analysis.
    max_jump : int or None
        Largest cycle jump.
    """

    model_config = ConfigDict(extra="allow")

    AUTOMATIC: ClassVar[float] = 0.01

    __pydantic_extra__: dict[str, BodyWearTable]

    update: Annotated[float | Literal["auto", "never"], _UPDATE] = "auto"
    cycles: Annotated[int, Field(ge=1, strict=True)] | None = None
    max_jump: Annotated[int, Field(ge=1, strict=True)] | None = None

    @property
    def largest_kept(self) -> float:
        """Largest gap wear, relative to the sizes of the bodies."""
        if self.update == "never":
            return math.inf
        return self.AUTOMATIC if self.update == "auto" else float(self.update)

    @property
    def laws(self) -> dict[str, RateTable]:
        """Wear laws of bodies and parts, by the path of their table below ``wear``."""
        found: dict[str, RateTable] = {}
        for name, body in self.items():
            found |= {name: body} if body.has_law else {}
            found |= {f"{name}.materials.{part}": law for part, law in body.materials.items()}
        return found

    def __getitem__(self, body: str) -> BodyWearTable:
        return self.__pydantic_extra__[body]

    def __iter__(self) -> Iterator[str]:  # type: ignore[override]
        return iter(self.__pydantic_extra__)

    def __len__(self) -> int:
        return len(self.__pydantic_extra__)

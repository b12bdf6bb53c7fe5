"""Consistency checks of a contact face whose materials wear by different laws."""

from __future__ import annotations

from collections.abc import Iterator

from ...errors import note
from ..any_case import AnyCase
from ..tables.materials import part_named
from ..tables.wear import RateTable
from ..values.section import Fault


def part_wear(case: AnyCase) -> Iterator[Fault]:
    """Wear laws of parts name parts of the body, which wears in place, in one direction."""
    geometry, type_ = case.geometry, case.analysis.type
    for body, wear in case.wear.items():
        path = f"wear.{body}.materials"
        if not wear.materials or body not in geometry.bodies:
            continue
        known = [geometry.set_of.get(part, part) for part in geometry.parts_of(body)[1:]]
        by_name = [name for name, law in wear.materials.items() if law.where is None]
        if by_name and not known:
            text = f"{geometry.type!r} has no parts of {body}; leave it out, or add where = ..."
            yield path, text
            continue
        for name in by_name:
            if part_named(geometry, body, name) is None:
                yield f"{path}.{name}", f"unknown part; must be one of: {', '.join(known)}"
        if case.analysis.cyclic:
            yield path, f"is not supported in a {type_} analysis"
        if wear.spread != "in-place":
            yield path, f'requires spread = "in-place"; found {wear.spread!r}'


def note_default_per(name: str, law: RateTable, friction: float) -> None:
    """Note a coefficient of friction stress by default, where friction makes a difference."""
    if law.rate is None and "per" not in law.model_fields_set and friction > 0.0:
        note(
            f"wear.{name}.per is left out: the coefficient multiplies mu p (friction stress); "
            'Archard\'s k multiplies p: with per = "pressure" it wears '
            f"{friction**-law.pressure_exponent:.3g} times as fast"
        )

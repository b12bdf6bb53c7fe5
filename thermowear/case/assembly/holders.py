"""Consistency checks of the holders of a case of several bodies, and of their loads.

Every check yields the path of the key at fault and a message.
"""

from __future__ import annotations

from collections.abc import Iterator

from ...laws.motions import NOTHING_PRESSED, spans
from ..values.section import Fault
from .schema import AssemblyCase
from .tables import AssemblyHolderTable

_SECTION = ("x", "z", "rotation")
_FREE = {
    "axisymmetric": ("z",),
    "plane-strain": _SECTION,
    "plane-stress": _SECTION,
    "3d": ("x", "y", "z", "rotation-x", "rotation-y"),
}
"""Free motions by model."""
_PLANES = {"symmetry": 0, "rollers": 1, "mid_plane": 2}
"""Axes along which surfaces with these supports do not move."""
_IN_SECTION = ("tangential_force", "moments", "point", "pivot")
"""Keys without an effect in an axisymmetric model."""


def held(case: AssemblyCase) -> Iterator[Fault]:
    """Bodies have one holder at most, and clamped ones none."""
    owners = dict[str, str]()
    for name, holder in case.holders.items():
        for body in map(case.geometry.body_of, holder.surface):
            for mate in sorted(case.glued[body]):
                glued = "" if mate == body else f" is glued to {mate}, which"
                if mate in owners:
                    text = f"{body}{glued} is on holders.{owners[mate]}, too"
                    yield f"holders.{name}.surface", text
                if case.bodies[mate].fixed:
                    joined = "" if mate == body else f" is glued to {body}, which"
                    yield f"bodies.{mate}.fixed", f"{mate}{joined} is on holders.{name}"
            owners[body] = name


def fitting(case: AssemblyCase) -> Iterator[Fault]:
    """Loads, points and free motions fit the model."""
    dim = 3 if case.model == "3d" else 2
    for name, holder in case.holders.items():
        for key in ("direction", "point", "pivot"):
            given = getattr(holder, key)
            if given is not None and len(given) != dim:
                yield f"holders.{name}.{key}", f"has {len(given)} coordinates; needs {dim}"
        for motion in holder.free:
            if motion not in _FREE[case.model]:
                text = f"{motion!r} is not possible in this model; one of: "
                yield f"holders.{name}.free", text + ", ".join(_FREE[case.model])
        if case.model == "axisymmetric" and holder.direction and holder.direction[0]:
            yield f"holders.{name}.direction", "must be along the axis in an axisymmetric model"


def loads(case: AssemblyCase) -> Iterator[Fault]:
    """Loads move their holder; somewhere the bodies are pressed."""
    for name, holder in case.holders.items():
        yield from ((f"holders.{name}.{key}", text) for key, text in _unmoved(case, holder))
    each = case.holders.values()
    steady = case.analysis.type == "steady"
    if not pressed(case) and (steady or not case.geometry.from_file):  # drawn bodies just touch
        yield "holders", NOTHING_PRESSED
    elif steady and not (_loaded(case) or any(h.history for h in each)):
        text = "no steady state, as wear unloads the contacts: one of them needs a force"
        yield "holders", text


def pressed(case: AssemblyCase) -> bool:
    """Whether loads, motions or heat may press bodies that do not overlap at first."""
    moved = any(h.approach or h.history for h in case.holders.values())
    return _loaded(case) or moved or case.heat is not None


def _loaded(case: AssemblyCase) -> bool:
    each = case.holders.values()
    loaded = any(h.force or h.closing_moment or any(h.moments or ()) for h in each)
    return loaded or bool(case.load.pressure)


def _unmoved(case: AssemblyCase, holder: AssemblyHolderTable) -> Iterator[Fault]:
    """Loads along motions that the holder does not have, by key in its table."""
    if case.model == "axisymmetric":
        for key in _IN_SECTION:
            if getattr(holder, key) is not None:
                yield key, "has no effect in an axisymmetric model"
        return
    turns = any(motion.startswith("rotation") for motion in holder.free)
    if holder.tangential_force and not turns and "x" not in holder.free:
        yield "tangential_force", 'requires a holder that is free along x: add "x" to free'
    if any(holder.moments or ()) and not turns:
        yield "moments", "requires a holder that can rotate (free)"
    elif case.model != "3d" and any((holder.moments or ())[:2]):
        yield "moments", "in a section only the last one acts, about the normal of the section"


def planes(case: AssemblyCase) -> Iterator[Fault]:
    """Motions across the load leave supports in place; those on a held surface move with it.

    All supports of a held body follow its holder along the load, without a strain.
    """
    for name, holder in case.holders.items():
        mates = {mate for s in holder.surface for mate in case.glued[case.geometry.body_of(s)]}
        for body in sorted(mates):
            for key, axis in _PLANES.items():
                beside = set(getattr(case.bodies[body], key)) - set(holder.surface)
                wrong = [m for m in holder.free if m != "z" and _leaves(m, axis)]
                if beside and wrong:
                    text = f"{wrong[0]!r} contradicts bodies.{body}.{key}"
                    yield f"holders.{name}.free", f"{text}: no motion along {'xyz'[axis]}"


def _leaves(motion: str, axis: int) -> bool:
    """Test whether a free motion across the load moves a plane normal to an axis."""
    about = {"rotation-x": 0, "rotation-y": 1, "rotation": 2}
    return about[motion] != axis if motion in about else "xyz".index(motion) == axis


def reactions(case: AssemblyCase) -> Iterator[Fault]:
    """Another holder that moves along the force bears it."""
    for name, holder in case.holders.items():
        if holder.reaction is None:
            continue
        path, other = f"holders.{name}.reaction", case.holders.get(holder.reaction)
        if other is None:
            known = ", ".join(one for one in case.holders if one != name)
            yield path, f"found {holder.reaction!r}; must be another holder: {known or 'none'}"
        elif other is holder:
            yield path, "a holder cannot bear its own force; name another one"
        elif holder.force is None and (holder.history is None or holder.history.force is None):
            yield path, f"needs a force to bear: holders.{name}.force"
        elif len(_direction(case, other)) == len(_direction(case, holder)) and not spans(
            _translations(case, other), _direction(case, holder)
        ):
            text = "is not free along this force (free, direction), or has an approach"
            yield path, f"the holder {holder.reaction!r} {text}"


def _direction(case: AssemblyCase, holder: AssemblyHolderTable) -> tuple[float, ...]:
    """Load direction, of any length."""
    return holder.direction or case.geometry.press_direction(holder.surface[0])


def _translations(case: AssemblyCase, holder: AssemblyHolderTable) -> list[tuple[float, ...]]:
    """Directions of the translations along which a force moves a holder."""
    along = _direction(case, holder)
    axes = {name: tuple(float(i == k) for i in range(len(along))) for k, name in enumerate("xy")}
    free = [along] if "z" in holder.free and holder.approach is None else []
    return free + [axes[name] for name in holder.free if name in axes]

"""Transformations of random cases that leave the results as they are, and their comparison."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.spatial import KDTree

import thermowear as tw
from thermowear.errors import CaseNote
from thermowear.model import ContactMethod
from thermowear.results import Result
from thermowear.results.points import by_contact
from thermowear.simulation.from_case import run as run_case
from thermowear.verification.check import Check, compare, compare_worst

from ..scripting.from_case import CELLS, FACETS, own_mesh
from .random_pads import ALL, CUSTOMARY, ONCE, SMALL, Scene, random_scene
from .test_checkpoint import Watched

LABELS, MOVED, SAME_PLACE = 1e-12, 1e-9, 2e-5
"""Allowed differences, of the scale of each quantity; distance of points that are one [m]."""
_SCALES = {
    "pressure": ("pressure",),
    "weight": ("weight",),
    "gap": ("gap", "shape", "wear_1", "wear_2"),
    **{f"wear_{k}": ("wear_1", "wear_2") for k in (1, 2)},
    **{f"wear_rate_{k}": ("wear_rate_1", "wear_rate_2") for k in (1, 2)},
    **{f"temperature_{k}": ("temperature_1", "temperature_2") for k in (1, 2)},
    **{f"heat_flux_{k}": ("heat_flux_1", "heat_flux_2") for k in (1, 2)},
}
"""Columns by which the differences of a column are measured."""
AMBIENT = 293.15
_EXACT = 1e-4
"""Allowed difference of forces, which are given but for inclined normals with friction."""
_ROUNDING = 2e-15
"""Of differences of coordinates and absolute temperatures, relative to the largest: turned, moved
and converted, each coordinate of both points is rounded a few times."""
_OF_STEP = 2.2e-16
"""Rounding of the wear in a step of a running-in, relative to the largest gap and wear: 3.5e-20 m
of 1.1 µm in 164 steps of mirror seed 508."""
_OF_SLIP = 1e-14
"""Rounding of the slip in a cycle, relative to the displacements that it is a difference of."""
_OF_PRESSURE = ("pressure", "wear_rate", "heat_flux")
"""Columns that are in proportion to the pressure."""
_FULL = ("penalty", "nitsche")
OF_CONTACTS = ("normal_force_N", "contact_force_N", "friction_force_N", "friction_power_W") + (
    "max_pressure_Pa",
    "wear_volume_1_m3",
    "wear_volume_2_m3",
)


@dataclass(frozen=True)
class Other:
    """The same case otherwise, and the way back from its results.

    Attributes
    ----------
    scene : Scene
    bound : float or None
        Allowed differences; None: within the estimates of errors.
    back : callable
        Coordinates of the first case from those of this one.
    swapped : bool
        The sides of the contacts are exchanged.
    run : callable
        Result of the scene in a folder.
    """

    scene: Scene
    bound: float | None
    back: Callable[[np.ndarray], np.ndarray] = lambda x: x
    swapped: bool = False
    run: Callable[..., Result] | None = None


def run(scene: Scene, folder) -> Result:
    """Result of a case from its files; in Python where only that has its contact method."""
    folder.mkdir(parents=True, exist_ok=True)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", CaseNote)
        return run_in_python(scene) if _in_python(scene) else tw.run(tw.load(scene.case(folder)))


def _in_python(scene: Scene) -> bool:
    """True for a full method of faces that are no pair of a case."""
    return "method" in scene.tables.get("contact", {}) and not scene.pair


def columns(result: Result, other: Other | None = None) -> dict[str, dict[str, np.ndarray]]:
    """Columns of each contact, sides and places as in the first case; temperatures are rises."""
    parts = by_contact(result.interface, result.contacts) or {"face0": result.interface}
    found = {}
    for name, points in parts.items():
        own = {column: getattr(points, column) for column in _SCALES}
        for side in (1, 2):
            own[f"temperature_{side}"] = own[f"temperature_{side}"] - AMBIENT
        if other is not None and other.swapped:
            own = {_exchanged(column): values for column, values in own.items()}
        places = np.column_stack([points.x, points.y, points.z])
        own["places"] = places if other is None else other.back(places)
        found[name] = own | {"shape": points.shape}
    return found


def _exchanged(name: str) -> str:
    """The column of the other body."""
    return f"{name[:-1]}{3 - int(name[-1])}" if name[-1] in "12" else name


def numbers(result: Result, swapped: bool = False) -> dict[str, float]:
    """Numbers of the contacts in the summary, by contact and key."""
    each = result.summary.get("contacts") or {"face0": result.summary}
    found = {}
    for name, of in each.items():
        for key in OF_CONTACTS:
            other = key.translate(str.maketrans("12", "21")) if swapped and "volume" in key else key
            if of.get(other) is not None:
                found[f"{name} {key}"] = float(of[other])
    return found


def differences(known: Result, found: Result, other: Other) -> Iterator[Check]:
    """Compare all columns at the points, and the numbers of the contacts."""
    bound = other.bound
    assert bound is not None
    first, second = columns(known), columns(found, other)
    assert first.keys() == second.keys()
    for name in first:
        if not other.swapped:  # where the same face carries the points in the same order
            order = _order(first[name]["places"], second[name]["places"], name)
            second[name] = {column: values[order] for column, values in second[name].items()}
    extent = max(np.abs(of["places"]).max() for of in first.values())
    # of differences of coordinates, as they are given, of temperatures, and of displacements
    far = max(np.abs([one.x, one.y, one.z]).max() for one in (known.interface, found.interface))
    rounding = {"gap": _ROUNDING * far, "temperature": _ROUNDING * AMBIENT}
    rounding |= _by_slip_of_rounding(other.scene, known)
    rough = max(1.0, _by_wear_of_rounding(other.scene, known) / bound)
    for name, of in () if other.swapped else first.items():  # places are those on body 1
        places = second[name]["places"].ravel(), of["places"].ravel()
        yield compare_worst(f"{name}: places", *places, bound, "", extent)
    for column, like in _SCALES.items():
        values = [np.abs(of[key]) for of in first.values() for key in (*like, column)]
        scale = max((np.nanmax(v, initial=0.0) for v in values), default=0.0)
        scale *= rough if column.startswith(_OF_PRESSURE) else 1.0
        scale = max(scale, rounding.get(column.rstrip("_12"), 0.0) / bound)
        for name, of in first.items():
            one, two = second[name][column], of[column]
            assert np.array_equal(np.isnan(one), np.isnan(two)), f"{name}: {column}"
            if scale and not np.isnan(one).any():
                yield compare_worst(f"{name}: {column}", one, two, bound, "", scale)
    one, two = numbers(known), numbers(found, other.swapped)
    assert one.keys() == two.keys()
    for key, value in one.items():
        unit = key.rpartition("_")[2]
        scale = max(abs(v) for k, v in one.items() if k.endswith(unit))
        scale *= rough if unit == "Pa" else 1.0
        scale = max(scale, rounding.get(unit, 0.0) / bound)
        if scale:
            yield compare(key, two[key], value, bound, "", scale)


def _by_slip_of_rounding(scene: Scene, known: Result) -> dict[str, float]:
    """Wear by a slip that is rounding of the displacements, if faces fret: they may stick."""
    tables, given = scene.tables, [h.get("history") for h in scene.tables["holders"].values()]
    if not all(given):
        return {}
    most = max(abs(x) for history in given for _, x in history["tangential_displacement"])
    period = max(t for history in given for _, t in history["time"])
    worn = tables["bodies"].keys() & tables["wear"].keys()
    coefficient = max(_coefficient(tables, name) for name in worn)
    rate = _OF_SLIP * coefficient * known.interface.pressure.max() * 4 * most / period
    depth, area = rate * known.summary["time_s"], known.interface.weight.sum()
    return {"wear_rate": rate, "wear": depth, "m3": depth * area}


def _by_wear_of_rounding(scene: Scene, known: Result) -> float:
    """Pressure of points that begin to press, by the rounding of the wear, to the largest one.

    Wear is a sum over the steps, each rounded to the last digit of the gaps. Points that others
    have carried until then have their pressure by what these wore: by the stiffness against the
    shortest waves of pressure on a facet, see `contact.full.edge_deflection`.
    """
    soft, lengths = {}, []
    for block in scene.blocks:
        own = scene.tables["bodies"][block.name]
        soft[block.name] = (1 - own["poisson_ratio"] ** 2) / own["young_modulus"][1]
        sides = (np.diff(block.nodes, axis=k) for k in range(block.dim - 1))
        lengths += [np.linalg.norm(side, axis=-1).min() for side in sides]
    softness = soft.pop("plate") + min(soft.values())
    compliance = 2 / np.pi * softness * min(lengths) / scene.tables["mesh"]["degree"]
    at = known.interface
    rounding = _OF_STEP * len(known.history) * np.nanmax(np.abs(at.gap) + at.wear_1 + at.wear_2)
    return float(rounding / compliance / at.pressure.max())


def _order(places: np.ndarray, others: np.ndarray, name: str) -> np.ndarray:
    """Indices of the other points that are the given ones."""
    assert len(places) == len(others), f"{name}: {len(places)} and {len(others)} points"
    distance, nearest = KDTree(others).query(places)
    assert distance.max() < SAME_PLACE, f"{name}: points {distance.max()} m apart"
    assert len(np.unique(nearest)) == len(nearest), f"{name}: points that coincide"
    return nearest


def within_estimates(known: Result, found: Result, other: Other) -> Iterator[Check]:
    """Compare forces, and the largest pressure within three times the sum of both estimates."""
    one, two = numbers(known), numbers(found, other.swapped)
    for key, value in one.items():
        allowed, unit = _EXACT if key.endswith("_force_N") else None, key.rpartition("_")[2]
        scale, other_scale = (
            max(abs(v) for k, v in each.items() if k.endswith(unit)) for each in (one, two)
        )
        if scale and key.endswith("max_pressure_Pa"):
            allowed = _estimated("max_pressure", (known, scale), (found, other_scale))
        if scale and allowed is not None:
            yield compare(key, two[key], value, allowed, "", scale)
    rise = [
        max(np.nanmax(np.abs(of[f"temperature_{side}"]), initial=0.0) for of in each.values())
        for each in (columns(known), columns(found, other))
        for side in (1, 2)
    ]
    largest, other_largest = max(rise[:2]), max(rise[2:])
    if largest:
        allowed = _estimated("temperature", (known, largest), (found, other_largest))
        if allowed is not None:
            yield compare("largest rise", other_largest, largest, allowed, "")


def _estimated(quantity: str, *each: tuple[Result, float]) -> float | None:
    """Three times the sum of the estimates, but for rounding; None where one has none.

    Each is relative to the value in its own result, which is given; the sum is to the first.
    """
    key = f"{quantity}_error_estimate_relative"
    errors = [(result.summary[key], value) for result, value in each]
    if any(error is None for error, _ in errors):
        return None
    return 3 * sum(error * value for error, value in errors) / each[0][1] + _EXACT


def _moved(scene: Scene, change: Callable[[np.ndarray], np.ndarray]) -> Scene:
    """Scene with other places of the nodes."""
    return scene.changed(blocks=tuple(replace(b, nodes=change(b.nodes)) for b in scene.blocks))


def _backwards(tables: dict[str, Any], *names: str) -> None:
    for name in names:
        if name in tables:
            tables[name] = dict(reversed(tables[name].items()))


def _by_any_method(seed: int, *models: str, analyses: Sequence[str] = ONCE) -> Scene:
    """Random scene, one in eight of one pad by a full method."""
    drawn = int(np.random.default_rng([seed, 4]).integers(8 * len(_FULL)))
    if drawn >= len(_FULL):
        return random_scene(seed, *models, analyses=analyses)
    scene = random_scene(seed, *models, pads=1)
    scene.tables["contact"]["method"] = _FULL[drawn]
    scene.tables.get("heat", {}).pop("transient", None)  # in time by the condensed method only
    return scene


def order_of_bodies(seed: int) -> tuple[Scene, Other]:
    """Bodies listed backwards, as their tables are; by a full method, also their nodes."""
    scene = _by_any_method(seed, analyses=SMALL)
    other = scene.changed(blocks=scene.blocks[::-1])
    if _in_python(scene):
        backwards = (replace(block, nodes=block.nodes[::-1]) for block in other.blocks)
        other = replace(other, blocks=tuple(backwards))
    _backwards(other.tables, "bodies", "wear")
    return scene, Other(other, LABELS)


def order_of_contacts(seed: int) -> tuple[Scene, Other]:
    """Contacts and holders listed backwards."""
    scene = random_scene(seed, analyses=SMALL, pads=2)
    other = scene.changed()
    _backwards(other.tables, "contacts", "holders")
    return scene, Other(other, LABELS)


def order_of_files(seed: int) -> tuple[Scene, Other]:
    """A file for each body, listed backwards."""
    scene = random_scene(seed, analyses=SMALL)
    return scene, Other(scene.changed(blocks=scene.blocks[::-1], paths=True), LABELS)


def faces_exchanged(seed: int, analyses: Sequence[str] = ALL) -> tuple[Scene, Other]:
    """The other face of each contact named first."""
    scene = random_scene(seed, analyses=analyses)
    other = scene.changed()
    for contact in other.tables["contacts"].values():
        contact["between"].reverse()
    if "heat" in other.tables:
        other.tables["heat"]["partition"] = 1 - scene.tables["heat"]["partition"]
    return scene, Other(other, LABELS, swapped=True)


def body_that_moves(seed: int) -> tuple[Scene, Other]:
    """The pads move the other way in place of the plate."""
    scene = random_scene(seed)
    other = scene.changed()
    motion = _opposite(other.tables["motions"].pop("plate"))
    other.tables["motions"] = {block.name: motion for block in scene.blocks[:-1]}
    return scene, Other(other, LABELS)


def _opposite(motion: dict[str, Any]) -> dict[str, Any]:
    speeds = {k: (v[0], -v[1]) for k, v in motion.items() if k in ("velocity", "angular_velocity")}
    return motion | speeds


def mirror(seed: int) -> tuple[Scene, Other]:
    """Mirrored about x = 0; rings about the plane of the face."""
    scene = _by_any_method(seed)
    signs = np.ones(scene.blocks[0].dim)
    rings = scene.model == "axisymmetric"
    signs[1 if rings else 0] = -1
    other = _moved(scene, lambda x: x * signs)
    for holder in other.tables["holders"].values():
        if "pivot" in holder:
            (kind, x), y = holder["pivot"]
            holder["pivot"] = [(kind, -x), y]
    if rings:
        for holder in other.tables["holders"].values():
            holder["direction"] = [0.0, 1.0]
    elif not other.tables["motions"]["plate"].get("across"):
        other.tables["motions"]["plate"] = _opposite(other.tables["motions"]["plate"])
    return scene, Other(other, LABELS, lambda x: x * np.append(signs, np.ones(3 - len(signs))))


def rotation(seed: int) -> tuple[Scene, Other]:
    """Turned by odd angles and moved; in space the plate turns about an axis, too."""
    scene = _by_any_method(seed, "3d", "plane-strain", "plane-stress")
    rng = np.random.default_rng(seed)
    dim = scene.blocks[0].dim
    turn = np.linalg.qr(rng.normal(size=(dim, dim)))[0]
    turn[0] *= np.sign(np.linalg.det(turn))
    away = rng.uniform(-0.05, 0.05, dim)
    if dim == 2:
        scene.tables["motions"]["plate"]["across"] = True
        moved = _moved(scene, lambda x: x @ turn.T + away)
    else:
        speed, centre = ("rotation", rng.uniform(-1, 1)), np.array([0.0, 0.03, 0.0])
        scene.tables["motions"]["plate"] = _turning(speed, centre, [0.0, 0.0, 1.0])
        moved = _moved(scene, lambda x: x @ turn.T + away)
        moved.tables["motions"]["plate"] = _turning(
            speed, turn @ centre + away, turn[:, 2].tolist()
        )
    for holder in moved.tables["holders"].values():
        holder["direction"] = (turn @ np.array(holder["direction"])).tolist()
        if "pivot" in holder:
            at = turn @ np.array([x for _, x in holder["pivot"]]) + away
            holder["pivot"] = [("coordinate", float(x)) for x in at]

    def back(x):
        return np.pad((x[:, :dim] - away) @ turn, ((0, 0), (0, 3 - dim)))

    return scene, Other(moved, MOVED, back)


def _turning(speed: tuple[str, float], centre: np.ndarray, axis: list[float]) -> dict[str, Any]:
    point = [("coordinate", float(x)) for x in centre]
    return {"angular_velocity": speed, "axis": {"point": point, "direction": axis}}


def units(seed: int) -> tuple[Scene, Other]:
    """In inches, pounds, ksi, degrees Fahrenheit and British thermal units."""
    scene = random_scene(seed, analyses=SMALL)
    return scene, Other(replace(scene, units=CUSTOMARY), MOVED)


def glued(seed: int) -> tuple[Scene, Other]:
    """The first pad cut in two that are glued."""
    scene = random_scene(seed)
    pad, *rest = scene.blocks
    lower, upper = pad.cut(1)
    other = scene.changed(blocks=(lower, upper, *rest))
    tables = other.tables
    tables["bodies"][upper.name] = dict(tables["bodies"][pad.name])
    tables["contacts"]["joint"] = {"between": [f"{upper.name}_low", f"{pad.name}_top"], "tie": True}
    tables["holders"]["arm0"]["surface"] = f"{upper.name}_top"
    if "heat" in tables:
        cooling = tables["heat"]["cooling"]
        cooling[f"{upper.name}_top"] = cooling.pop(f"{pad.name}_top")
    return scene, Other(other, None)


def pair(seed: int) -> tuple[Scene, Other]:
    """As a case of a pair: load, motion and supports without names."""
    scene = random_scene(seed, pads=1, tilting=False)
    scene.tables["motions"]["plate"].pop("across", None)  # not a key of pairs on meshes of users
    return scene, Other(scene.changed(pair=True), LABELS)


def pointwise(seed: int) -> tuple[Scene, Other]:
    """Contact conditions at each point instead of in the mean."""
    still = {"hot": False, "worn": False, "sliding": False, "tilting": False}
    scene = random_scene(seed, analyses=("initial",), pads=1, **still).changed(pair=True)
    other = scene.changed()
    other.tables["contact"] = {"method": "pointwise"}
    return scene, Other(other, None)


def in_python(seed: int) -> tuple[Scene, Other]:
    """The same bodies, faces, holders and motions in Python."""
    scene = random_scene(seed)
    return scene, Other(scene, LABELS, run=lambda scene, folder: run_in_python(scene))


def resumed(seed: int) -> tuple[Scene, Other]:
    """Continued from the state after a third of the steps."""
    scene = random_scene(seed, analyses=ALL[2:])
    scene.tables["analysis"]["checkpoint_every"] = ("time", 1e-9)
    return scene, Other(scene, LABELS, run=run_resumed)


def run_resumed(scene: Scene, folder) -> Result:
    """Result of a running-in that goes on from a checkpoint."""
    folder.mkdir(parents=True, exist_ok=True)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", CaseNote)
        case, watched = tw.load(scene.case(folder)), Watched()
        run_case(case, None, watched)
        state = watched.checkpoints[len(watched.checkpoints) // 3].state(0)
        return run_case(case, None, None, None, state)


def run_in_python(scene: Scene) -> Result:
    """Result of the model that a program in Python makes of the same bodies."""
    tagged, tables = scene.mesh(), scene.tables
    mesh, cells, facets = own_mesh(tagged)
    tag = dict(zip(tagged.surfaces, FACETS, strict=False))
    materials = [
        {key: value if isinstance(value, float) else value[1] for key, value in table.items()}
        for table in ({**tables["bodies"][name], "fixed": 0.0} for name in tagged.bodies)
    ]
    bodies = {}
    for name, own, material in zip(tagged.bodies, CELLS, materials, strict=False):
        del material["fixed"]
        fixed = (tag["plate_low"],) if name == "plate" else ()
        bodies[name] = tw.Body(name, mesh, cells, facets, {own: tw.Material(**material)}, fixed)

    def surface(name):
        return bodies[name.partition("_")[0]].surface(tag[name])

    heat, laws = tables.get("heat"), {}
    if heat is not None:
        laws = {"conductance": heat["conductance"][1], "partition": heat["partition"]}
    faces = [
        tw.Interface(
            *(surface(face) for face in contact["between"]),
            name=name,
            friction=tables["contact"]["friction"],
            method=ContactMethod(tables["contact"].get("method", "condensed")),
            wear={
                body: tw.PowerWear(_coefficient(tables, body.name))
                for body in (surface(face).body for face in contact["between"])
                if body.name in tables["wear"]
            },
            **laws,
        )
        for name, contact in tables["contacts"].items()
    ]
    holders = [
        tw.Holder(
            surface(one["surface"]),
            free=tuple(one.get("free", ("z",))),
            force=one["force"][1],
            direction=tuple(one["direction"]),
            pivot=tuple(x for _, x in one["pivot"]) if "pivot" in one else None,
        )
        for one in tables["holders"].values()
    ]
    motion = tables["motions"]["plate"]
    if "velocity" in motion:
        motion = tw.Translation(motion["velocity"][1], across=motion.get("across", False))
    else:
        axis = motion.get("axis", {"point": [], "direction": None})
        centre = [x for _, x in axis["point"]] or (0.0, 0.0)
        motion = tw.Rotation(motion["angular_velocity"][1], tuple(centre), axis["direction"])
    model = tw.Model(
        faces,
        holders,
        {bodies["plate"]: motion},
        None
        if heat is None
        else tw.Heat(
            ambient=AMBIENT,
            transient=heat.get("transient", False),
            **{
                key: {surface(name): value[1] for name, value in heat.get(key, {}).items()}
                for key in ("cooling", "temperature")
            },
        ),
        kinematics=None if scene.model == "3d" else scene.model,
        thickness=scene.thickness if scene.model.startswith("plane") else None,
        degree=tables["mesh"]["degree"],
    )
    analysis = tables["analysis"]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", CaseNote)
        if analysis["type"] == "transient":
            return model.transient(analysis["end_time"][1], tolerance=1e-2).result
        return getattr(model, analysis["type"])().result


def _coefficient(tables: dict[str, Any], body: str) -> float:
    """Wear per pressure [1/Pa]."""
    law = tables["wear"][body]
    share = 1.0 if law["per"] == "pressure" else tables["contact"]["friction"]
    return law["coefficient"][1] * share


CHANGES = {
    change.__name__: change
    for change in (
        *(order_of_bodies, order_of_contacts, order_of_files, faces_exchanged),
        *(body_that_moves, mirror, rotation, units, glued, pair, pointwise, in_python, resumed),
    )
}

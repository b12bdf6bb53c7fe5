"""Random cases of pads on a plate, meshed here: sections, rings and space, cold and hot."""

from __future__ import annotations

import copy
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from thermowear.geometry.mesh.tagged import TaggedMesh
from thermowear.geometry.reading.export import write_mesh

MODELS = ("plane-strain", "plane-stress", "axisymmetric", "3d")
ONCE = ("initial", "steady", "transient")
SMALL = (*ONCE, "reciprocating", "fretting")
ALL = (*SMALL, "deep")
"""Analyses; the wear is small in all but ``"deep"``, a running-in whose meshes follow it."""
CELLS = {2: "quadrilateral", 3: "hexahedron"}
_CORNERS = {
    2: ((0, 0), (1, 0), (1, 1), (0, 1)),
    3: tuple((x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))),
}
METRIC = {
    "length": (1e-3, "1 mm"),
    "coordinate": (1e-3, "mm"),
    "force": (1.0, "N"),
    "pressure": (1e6, "MPa"),
    "per pressure": (1e-6, "1/MPa"),
    "speed": (1.0, "m/s"),
    "rotation": (1.0, "rad/s"),
    "temperature": ((1.0, 273.15), "degC"),
    "conductivity": (1.0, "W/(m K)"),
    "expansion": (1.0, "1/K"),
    "transfer": (1.0, "W/(m^2 K)"),
    "density": (1.0, "kg/m^3"),
    "heat": (1.0, "J/(kg K)"),
    "time": (1.0, "s"),
    "frequency": (1.0, "Hz"),
}
"""Unit of each kind: its size in SI, for temperatures with the zero, and its name."""
_BTU, _FOOT, _POUND, _F = 1055.05585262, 0.3048, 0.45359237, 5 / 9
CUSTOMARY = {
    "length": (0.0254, "1 inch"),
    "coordinate": (0.0254, "inch"),
    "force": (_POUND * 9.80665, "lbf"),
    "pressure": (1e3 * _POUND * 9.80665 / 0.0254**2, "ksi"),
    "per pressure": (1e-3 * 0.0254**2 / (_POUND * 9.80665), "1/ksi"),
    "speed": (_FOOT / 60, "ft/min"),
    "rotation": (2 * np.pi / 60, "rpm"),
    "temperature": ((_F, 459.67 * _F), "degF"),
    "conductivity": (_BTU / (3600 * _FOOT * _F), "Btu_it/(hour foot delta_degF)"),
    "expansion": (1 / _F, "1/delta_degF"),
    "transfer": (_BTU / (3600 * _FOOT**2 * _F), "Btu_it/(hour foot^2 delta_degF)"),
    "density": (_POUND / _FOOT**3, "lb/foot^3"),
    "heat": (_BTU / (_POUND * _F), "Btu_it/(lb delta_degF)"),
    "time": (60.0, "min"),
    "frequency": (1 / 60, "1/min"),
}


@dataclass(frozen=True)
class Block:
    """Grid of a body: nodes along each axis [m], shape ``(nx, ny[, nz])`` with coordinates last.

    The last axis of the grid is upwards: its surfaces are ``NAME_low`` and ``NAME_top``, of which
    the latter may be of several parts, ``NAME_top0`` and so on.

    Attributes
    ----------
    ends : tuple of int
        Numbers of the nodes along the first axis where such parts end.
    """

    name: str
    nodes: np.ndarray
    ends: tuple[int, ...] = ()

    @property
    def dim(self) -> int:
        return self.nodes.ndim - 1

    @property
    def surfaces(self) -> tuple[str, ...]:
        parts = [str(k) for k in range(len(self.ends))] or [""]
        return f"{self.name}_low", *(f"{self.name}_top{k}" for k in parts)

    def mesh(self) -> TaggedMesh:
        *shape, dim = self.nodes.shape
        number = np.arange(np.prod(shape)).reshape(shape)
        corners = [
            number[tuple(slice(c, c + n - 1) for c, n in zip(corner, shape, strict=True))].ravel()
            for corner in _CORNERS[dim]
        ]
        cells = np.column_stack(corners)
        points = self.nodes.reshape(-1, dim)
        edges = points[cells[0]][[1, 3, 4][:dim]] - points[cells[0, 0]]
        if np.linalg.det(edges) < 0:  # of a mirror image
            cells = cells[:, [0, 3, 2, 1, 4, 7, 6, 5][: 2**dim]]
        cuts = [0, *(self.ends or [len(number) - 1])]
        layers = [number[..., 0], *(number[a : b + 1, ..., -1] for a, b in pairwise(cuts))]
        around = _CORNERS[2][: 2 if dim == 2 else 4]
        ends = [
            np.column_stack(
                [
                    layer[
                        tuple(slice(c, c + n - 1) for c, n in zip(at, layer.shape, strict=False))
                    ].ravel()
                    for at in around
                ]
            )
            for layer in layers
        ]
        tags = np.repeat(np.arange(1, len(ends) + 1, dtype=np.int32), [len(end) for end in ends])
        return TaggedMesh(
            points,
            CELLS[dim],
            cells,
            np.ones(len(cells), np.int32),
            np.concatenate(ends),
            tags,
            (self.name,),
            self.surfaces,
        )

    def cut(self, at: int) -> tuple[Block, Block]:
        """The parts below and above a row of nodes."""
        upper = Block(f"{self.name}_back", self.nodes[..., at:, :])
        return replace(self, nodes=self.nodes[..., : at + 1, :]), upper


@dataclass(frozen=True)
class Scene:
    """Case by blocks and tables whose quantities are pairs of a kind of `METRIC` and a number.

    Attributes
    ----------
    blocks : tuple of Block
    tables : dict
        Tables without the geometry.
    units : dict
    paths : bool
        A file for each body.
    pair : bool
        One pad on the plate as a case of a pair.
    """

    model: str
    blocks: tuple[Block, ...]
    tables: dict[str, Any]
    units: dict[str, Any]
    thickness: float
    paths: bool = False
    pair: bool = False

    def changed(self, **changes: Any) -> Scene:
        """Copy whose tables can be changed."""
        return replace(self, tables=copy.deepcopy(self.tables), **changes)

    def mesh(self) -> TaggedMesh:
        """All bodies in one mesh."""
        parts = [block.mesh() for block in self.blocks]
        starts = np.cumsum([0] + [len(part.points) for part in parts])
        before = np.cumsum([0] + [len(part.surfaces) for part in parts])
        return TaggedMesh(
            np.concatenate([part.points for part in parts]),
            parts[0].cell_type,
            np.concatenate([p.cells + s for p, s in zip(parts, starts, strict=False)]),
            np.concatenate([k * p.cell_tags for k, p in enumerate(parts, 1)]),
            np.concatenate([p.facets + s for p, s in zip(parts, starts, strict=False)]),
            np.concatenate([p.facet_tags + n for p, n in zip(parts, before, strict=False)]),
            tuple(block.name for block in self.blocks),
            tuple(name for part in parts for name in part.surfaces),
        )

    def case(self, folder) -> dict[str, Any]:
        """Tables of the case, its mesh written into a folder."""
        length, unit = self.units["length"]
        geometry: dict[str, Any] = {
            "type": "file",
            "length_unit": unit,
            "bodies": {block.name: block.name for block in self.blocks},
            "surfaces": {block.name: list(block.surfaces) for block in self.blocks},
        }
        if self.model.startswith("plane"):
            geometry["thickness"] = ("coordinate", self.thickness)
        scaled = [replace(b, nodes=b.nodes / length) for b in self.blocks]
        if self.paths:
            for block in scaled:
                write_mesh(block.mesh(), folder / f"{block.name}.msh")
            geometry["paths"] = {b.name: str(folder / f"{b.name}.msh") for b in self.blocks}
        else:
            write_mesh(replace(self, blocks=tuple(scaled)).mesh(), folder / "all.msh")
            geometry["path"] = str(folder / "all.msh")
        tables = {"model": self.model, "geometry": geometry} | copy.deepcopy(self.tables)
        return self._texts(_as_pair(tables) if self.pair else tables)

    def _texts(self, given):
        if isinstance(given, dict):
            return {key: self._texts(value) for key, value in given.items()}
        if isinstance(given, list):
            return [self._texts(value) for value in given]
        return text(given, self.units) if isinstance(given, tuple) else given


def _as_pair(tables: dict[str, Any]) -> dict[str, Any]:
    """Tables of one pad that is pressed down on a plate, without names of contact and holder."""
    (between,), (held,) = (list(tables.pop(name).values()) for name in ("contacts", "holders"))
    names = [name for own in tables["geometry"]["surfaces"].values() for name in own]
    tables["geometry"] |= {
        "contact": between["between"],
        "held": held["surface"],
        "fixed": tables["bodies"]["plate"].pop("fixed"),
        "surfaces": {name: name for name in names},
    }
    tables["load"] = {"force": held["force"]}
    if "motions" in tables:
        motion = tables.pop("motions")["plate"]
        speeds = {k: (v[0], -v[1]) for k, v in motion.items() if isinstance(v, tuple)}
        if "angular_velocity" in speeds:  # of a ring, given without a sign
            speeds = {k: (kind, abs(v)) for k, (kind, v) in speeds.items()}
        tables["motion"] = motion | speeds
    return tables


def text(given: tuple[str, float], units: dict[str, Any]) -> str:
    """A quantity with its unit."""
    kind, value = given
    size, name = units[kind]
    size, zero = size if isinstance(size, tuple) else (size, 0.0)
    return f"{float((value - zero) / size)!r} {name}"


def grid(*lines: np.ndarray) -> np.ndarray:
    return np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1)


def random_scene(
    seed: int,
    *models: str,
    analyses: Sequence[str] = ONCE,
    pads: int | None = None,
    **given: bool,
) -> Scene:
    """One or two pads, their faces a little crowned, on a wider plate.

    Parameters
    ----------
    models : str
        Those to draw from; all of them by default.
    analyses : sequence of str
        Those to draw from.
    pads : int, optional
        Their number; by default one or two.
    **given : bool
        Of ``hot`` and ``tilting`` (pads of plane sections turn freely), which are drawn by default,
        and of ``worn`` and ``sliding``, by default true.
    """
    rng = np.random.default_rng(seed)
    model = str(rng.choice(models or MODELS))
    analysis = str(rng.choice(analyses))
    cycles = analysis in ("reciprocating", "fretting")
    if cycles and model == "axisymmetric":
        model = "plane-strain"
    dim = 3 if model == "3d" else 2
    if cycles:
        given = {"hot": False, "tilting": False} | given
    hot, pads = given.get("hot", bool(rng.random() < 0.5)), pads or int(rng.integers(1, 3))
    unit, most = 1e-2, 3 if dim == 3 else 5
    start = 3.0 * unit if model == "axisymmetric" else -unit
    blocks, left, edges = [], start, [start - 0.4 * unit]
    crown = 1e-6 * rng.uniform(0, 3) * (analysis != "steady")
    depth = unit * rng.uniform(0.8, 1.5)
    for k in range(pads):
        width, height = unit * rng.uniform(0.7, 1.3, 2)
        lines = [left + np.linspace(0, width, int(rng.integers(2, most)) + 1)]
        if dim == 3:
            lines.append(np.linspace(-depth / 2, depth / 2, 3))
        nodes = grid(*lines, np.linspace(0, height, 3))
        away = 2 * (nodes[..., 0] - left) / width - 1 + rng.uniform(-0.3, 0.3)
        nodes[..., -1] += crown * away**2 * (1 - nodes[..., -1] / height)
        blocks.append(Block(f"pad{k}", nodes))
        between = unit * rng.uniform(0.2, 0.5)
        left += width + between
        edges.append(left - between / 2)
    across = [np.linspace(-0.7 * depth, 0.7 * depth, 4)] if dim == 3 else []
    low = unit * rng.uniform(0.6, 1.5)
    counts = rng.integers(2, most + 1, pads)
    parts = [np.linspace(*ab, n, False) for ab, n in zip(pairwise(edges), counts, strict=True)]
    lines = [np.append(np.concatenate(parts), edges[-1]), *across, np.linspace(-low, 0, 3)]
    plate = Block("plate", grid(*lines), tuple(np.cumsum(counts).tolist()))
    tables = _tables(rng, model, analysis, hot, pads)
    _histories(rng, tables)
    tilting = bool(rng.random() < 0.4)
    if given.get("tilting", tilting) and model.startswith("plane"):
        for block, holder in zip(blocks, tables["holders"].values(), strict=True):
            x, y = block.nodes[:, -1].mean(axis=0).tolist()
            holder["free"] = ["z", "rotation"]
            holder["pivot"] = [("coordinate", x), ("coordinate", y)]
    if not given.get("worn", True):
        del tables["wear"]
    if not given.get("sliding", True):
        del tables["motions"], tables["contact"]
    return Scene(model, (*blocks, plate), tables, METRIC, 0.01 * rng.uniform(1, 3))


def _histories(rng, tables: dict[str, Any]) -> None:
    """Make the tables those of deep wear or of repeated motions, where these are asked for."""
    kind, rates = tables["analysis"]["type"], tables["wear"].values()
    if kind == "deep":
        tables["analysis"] = {"type": "transient", "tolerance": 1e-2}
        tables["analysis"]["end_time"] = ("time", rng.uniform(20, 60))
        for law in rates:
            law["coefficient"] = (law["coefficient"][0], 50 * law["coefficient"][1])
        tables["wear"]["update"] = 2e-3
    elif kind == "reciprocating":
        stroke = {"amplitude": ("coordinate", 1e-3 * rng.uniform(0.3, 0.8))}
        tables["motions"] = {"plate": stroke | {"frequency": ("frequency", 2.0)}}
        tables["analysis"] |= {"cycles": 2000, "positions": int(rng.integers(2, 5))}
    elif kind == "fretting":
        del tables["motions"]
        for holder in tables["holders"].values():
            away = ("coordinate", 1e-6 * rng.uniform(0.1, 3))
            places = [("coordinate", 0.0), away, ("coordinate", -away[1]), ("coordinate", 0.0)]
            times = [("time", float(t)) for t in range(4)]
            holder["history"] = {"time": times, "tangential_displacement": places}
        tables["wear"]["cycles"] = 100
        tables["analysis"]["increments"] = 2


def _material(rng, hot: bool) -> dict[str, Any]:
    found = {
        "young_modulus": ("pressure", 10 ** rng.uniform(9.5, 11.3)),
        "poisson_ratio": rng.uniform(0.1, 0.4),
    }
    if hot:
        found |= {
            "conductivity": ("conductivity", 10 ** rng.uniform(0.5, 2)),
            "expansion": ("expansion", 1e-6 * rng.uniform(3, 20)),
            "density": ("density", rng.uniform(2000, 8000)),
            "specific_heat": ("heat", rng.uniform(400, 1000)),
        }
    return found


def _tables(rng, model: str, analysis: str, hot: bool, pads: int) -> dict[str, Any]:
    names = [f"pad{k}" for k in range(pads)]
    both = [*names, "plate"]
    bodies: dict[str, Any] = {name: _material(rng, hot) for name in both}
    bodies["plate"]["fixed"] = "plate_low"
    speed = float(rng.choice([-1, 1]) * rng.uniform(0.05, 0.3) / (20 if hot else 1))
    motion: dict[str, Any] = {"velocity": ("speed", speed)}
    if model == "axisymmetric":
        motion = {"angular_velocity": ("rotation", 20 * speed)}
    elif model != "3d" and rng.random() < 0.5:
        motion["across"] = True
    k = 10 ** rng.uniform(-14, -13) * (20 if hot else 1)
    worn = [n for n in both if n != "plate" or rng.random() < 0.3]
    per = str(rng.choice(["pressure", "friction-stress"]))
    wear = {n: {"coefficient": ("per pressure", k), "per": per} for n in worn}
    down = [0.0, 0.0, -1.0] if model == "3d" else [0.0, -1.0]
    found = {
        "mesh": {"degree": int(rng.integers(1, 3 if model == "3d" else 4))},
        "bodies": bodies,
        "contact": {"friction": float(rng.uniform(0.05, 0.4))},
        "contacts": {
            f"face{i}": {"between": [f"{n}_low", f"plate_top{i}"]} for i, n in enumerate(names)
        },
        "holders": {
            f"arm{i}": {
                "surface": f"{n}_top",
                "force": ("force", 10 ** rng.uniform(2, 3)),
                "direction": down,
            }
            for i, n in enumerate(names)
        },
        "motions": {"plate": motion},
        "wear": wear,
        "analysis": {"type": analysis},
    }
    if analysis == "transient":
        found["analysis"] |= {"end_time": ("time", rng.uniform(20, 100)), "tolerance": 1e-2}
    if hot:
        share = float(rng.uniform(0.2, 0.8))
        found["heat"] = {
            "conductance": ("transfer", 10 ** rng.uniform(3, 5)),
            "partition": share,
            "ambient": ("temperature", 293.15),
            "cooling": {
                surface: ("transfer", rng.uniform(100, 2000))
                for surface in (*(f"{n}_top" for n in names), "plate_low")
            },
        }
        if rng.random() < 0.3:
            del found["heat"]["cooling"]["plate_low"]
            found["heat"]["temperature"] = {"plate_low": ("temperature", rng.uniform(280, 330))}
        if analysis in ("transient", "deep") and rng.random() < 0.5:
            found["heat"]["transient"] = True
    return found

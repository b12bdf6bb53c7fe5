"""Two pads with glued back plates on a turning disk in space, and the half above its mid-plane.

Meshes of back plates and pads do not match, nor do those of pads and disk. As a module: the hot
steady state on the ranks of mpirun.
"""

import math
import sys
from dataclasses import fields
from pathlib import Path

from mpi4py import MPI

import numpy as np

import thermowear as tw

from ..ring_meshes import WHOLE, Ring, write_rings

ANGLE = math.radians(30)
FORCE, SPEED, FRICTION, K = 500.0, 2.0, 0.4, 1e-13
STEEL = {"young_modulus": "200 GPa", "poisson_ratio": 0.3, "conductivity": "45 W/(m K)"}
STEEL |= {"expansion": "1.2e-5 1/K", "density": "7800 kg/m^3", "specific_heat": "470 J/(kg K)"}
LINING = {"young_modulus": "0.3 GPa", "poisson_ratio": 0.25, "conductivity": "2 W/(m K)"}
LINING |= {"expansion": "1e-5 1/K", "density": "2500 kg/m^3", "specific_heat": "900 J/(kg K)"}


def write_mesh(path, half=False, order=2):
    """Write the brake, or the half of it above the mid-plane of the disk, in millimetres."""
    rings = []
    for name, sign in (("LEFT", 1), ("RIGHT", -1))[: 1 if half else 2]:
        inner, glued, outer = (sign * z for z in (6, 14, 18))
        ends = tuple(sorted((inner, glued))), tuple(sorted((glued, outer)))
        rings.append(Ring(name, (80, 130), ends[0], (-ANGLE, ANGLE), (2, 5, 1)))
        rings.append(Ring(f"{name}_PLATE", (78, 132), ends[1], (-ANGLE, ANGLE), (2, 4, 1)))
    low, layers = (0, 1) if half else (-6, 2)
    rings.append(Ring("DISK", (65, 75, 135, 140), (low, 6), WHOLE, (2, 24, layers)))
    write_rings(path, rings, order)
    return path


def tables(path, half=False, heat=None):
    """Tables of the case.

    Parameters
    ----------
    path : Path
        Mesh file.
    half : bool
        The model above the mid-plane alone.
    heat : dict, optional
        Keys of the table ``heat`` in addition to the usual ones; None: no heat.
    """
    sides = {"left": ("TOP", "BOTTOM", -1.0), "right": ("BOTTOM", "TOP", 1.0)}
    if half:
        del sides["right"]
    beside = ["DISK_INSIDE", "DISK_OUTSIDE", "DISK_TOP_REST", "DISK_BOTTOM_REST", "DISK_BOTTOM"]
    case = {
        "model": "3d",
        "geometry": {
            "type": "file",
            "path": str(path),
            "length_unit": "1 mm",
            "bodies": {"disk": "DISK"},
            "surfaces": {"disk": ["DISK_TOP", *beside]},
        },
        "mesh": {"degree": 2},
        "bodies": {"disk": STEEL | {"fixed": "DISK_INSIDE"}},
        "contact": {"friction": FRICTION},
        "contacts": {},
        "holders": {},
        "motions": {"disk": {"angular_velocity": f"{SPEED} rad/s"}},
        "wear": {},
        "analysis": {"type": "steady"},
    }
    if half:
        case["bodies"]["disk"]["mid_plane"] = ["DISK_BOTTOM", "DISK_BOTTOM_REST"]
    cooled = ["DISK_OUTSIDE", "DISK_TOP_REST"] + ["DISK_BOTTOM_REST"] * (not half)
    for side, (top, bottom, down) in sides.items():
        pad, plate, name = side, f"{side}_plate", side.upper()
        case["geometry"]["bodies"] |= {pad: name, plate: f"{name}_PLATE"}
        case["geometry"]["surfaces"] |= {
            pad: {f"{pad}_face": f"{name}_{bottom}", f"{pad}_back": f"{name}_{top}"},
            plate: {
                f"{plate}_face": f"{name}_PLATE_{bottom}",
                f"{plate}_back": f"{name}_PLATE_{top}",
            },
        }
        case["bodies"] |= {pad: LINING, plate: STEEL}
        case["contacts"] |= {
            side: {"between": [f"{pad}_face", f"DISK_{top}"]},
            f"{side}_joint": {"between": [f"{plate}_face", f"{pad}_back"], "tie": True},
        }
        case["holders"][side] = {
            "surface": f"{plate}_back",
            "direction": [0.0, 0.0, down],
            "force": f"{FORCE} N",
        }
        case["wear"][pad] = {"coefficient": f"{K} 1/Pa", "per": "pressure"}
        cooled.append(f"{plate}_back")
    if heat is not None:
        case["heat"] = {"conductance": "1e4 W/(m^2 K)", "partition": 0.1, "ambient": "20 degC"}
        case["heat"] |= {"cooling": dict.fromkeys(cooled, "50 W/(m^2 K)")} | heat
    return case


RUNNING_IN = {
    "heat": {"transient": True},
    "analysis": {"type": "transient", "end_time": "100 s", "tolerance": 1e-2},
}


def running_in(path, half=False):
    """Tables of the hot running-in with temperatures in time."""
    case = tables(path, half, RUNNING_IN["heat"])
    return case | {"analysis": RUNNING_IN["analysis"]}


def columns(result):
    """Columns of the interface."""
    return {f.name: getattr(result.interface, f.name) for f in fields(result.interface)}


if __name__ == "__main__":
    mesh, folder = map(Path, sys.argv[1:])
    found = tw.run(tw.load(tables(mesh, heat={})), MPI.COMM_WORLD)
    np.savez(folder / f"found_{MPI.COMM_WORLD.rank}.npz", **columns(found))

"""Rims of the contact faces of two boxes; the program started by `test_rim` on two ranks."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from thermowear.contact.faces.rim import rim

from .solids import COMM, SIZE, gathered, two_solids

DIVISIONS = ((4, 3, 2), (4, 2, 2))
BORDER = SIZE[0] / 2


def kinked(degrees):
    """Map of a body whose surface is inclined from the border on."""

    def place(p):
        x, y, z = np.moveaxis(p, -1, 0)
        return np.stack([x, y, z + np.tan(np.radians(degrees)) * np.maximum(x - BORDER, 0)], -1)

    return place


def cut(tagged, surface, onto):
    """Mesh in which a contact face ends at the border: its other facets are of another surface."""
    tag, other = (tagged.surfaces.index(name) + 1 for name in (surface, onto))
    middles = tagged.points[tagged.facets].mean(axis=1)
    moved = (tagged.facet_tags == tag) & (middles[:, 0] > BORDER)
    return replace(tagged, facet_tags=np.where(moved, other, tagged.facet_tags).astype(np.int32))


def found(cell_type, order, degrees, paired=("upper_face", "lower_face")):
    """Face of the upper body cut at its kink, and its sharp and open edges."""
    solids = two_solids(DIVISIONS, order, (kinked(degrees), kinked(degrees)), cell_type)
    bodies, (face, _) = gathered(cut(solids, "upper_face", "upper_end"))
    return face, *rim(face, bodies.each[face.body], paired)


def main():
    _, sharp, goes_on = found("hexahedron", 2, 5.0)
    path = Path(sys.argv[1]) / f"found_{COMM.rank}.npz"
    np.savez(path, sharp=1.0 * sharp, goes_on=1.0 * goes_on)


if __name__ == "__main__":
    main()

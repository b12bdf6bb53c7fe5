"""Abaqus input files: every side of a named surface is read, or the line at fault is named."""

import os

import numpy as np
import pytest

from thermowear.errors import CaseNote
from thermowear.geometry.mesh.mixed import AnyMesh
from thermowear.geometry.reading.abaqus import read_abaqus
from thermowear.geometry.reading.assembly import bodies_in
from thermowear.geometry.reading.contents import Named

COLUMNS = 4
SAMPLE = int(os.environ.get("THERMOWEAR_MUTATIONS", "3"))
HEAD = """\
*NODE, NSET=ALL
{nodes}
*ELEMENT, TYPE=CPE4, ELSET=Strip
{elements}
*ELSET, ELSET=Left
1, 2
*ELSET, ELSET="Right half", GENERATE
3, 4
"""
WHOLE = "*SURFACE, NAME=Face\n" + "\n".join(f"{k}, S1" for k in range(1, COLUMNS + 1))


def deck(surface: str) -> str:
    """A strip of four squares above y = 0, and text of its surface."""
    places = [(x, y) for y in (0, 1) for x in range(COLUMNS + 1)]
    above = COLUMNS + 1
    nodes = [f"{k}, {x}., {y}." for k, (x, y) in enumerate(places, start=1)]
    cells = [f"{k}, {k}, {k + 1}, {k + 1 + above}, {k + above}" for k in range(1, COLUMNS + 1)]
    return HEAD.format(nodes="\n".join(nodes), elements="\n".join(cells)) + surface


def mesh_of(text: str, surface: str = "FACE", body: str = "STRIP") -> AnyMesh:
    named = [Named(surface, (surface,), "geometry.contact", 0)]
    return bodies_in(read_abaqus(text), {"strip": (body,)}, named, {})


def length(mesh: AnyMesh) -> float:
    """Length of the surface, from the ends of its edges."""
    (block,) = mesh.blocks
    ends = block.points[block.facets[:, :2]]
    assert np.all(ends[..., 1] == 0.0)
    return float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum())


@pytest.mark.parametrize(
    "surface",
    [
        WHOLE,
        '*SURFACE, NAME=Face, TYPE=ELEMENT\nLEFT, S1\n"Right half", S1',
        "*surface, name=face,\n type=element\nleft, s1\n3, S1\n4, s1\nLeft, S1",
        "*ELSET, ELSET=bottom\nleft, 3\n*ELSET, ELSET=BOTTOM\n4\n*SURFACE, NAME=FACE\nBottom, S1",
        "*ELSET, ELSET=bottom,\nGENERATE\n1, 4, 1\n*SURFACE, NAME=FACE\nBottom, S1",
        "*INSTANCE, NAME=A-1\n*END INSTANCE\n*SURFACE, NAME=FACE\nA-1.Left, S1\na-1.3, S1\n4, S1",
        "*NSET, NSET=face, GENERATE\n1, 5, 1",
        "*NSET, NSET=half\n1, 2, 3\n*NSET, NSET=Face\nHALF, 4\n*NSET, NSET=FACE\n5",
        "*NSET, NSET=Half\n3, 4, 5\n*SURFACE, TYPE=NODE, NAME=face\nhalf,\n1, 1.0\n2",
        "*ELEMENT, TYPE=T2D2, ELSET=Skin\n11, 1, 2\n12, 2, 3\n13, 3, 4\n14, 5, 4\n"
        "*SURFACE, NAME=FACE\nSKIN, SPOS",
        "*ELEMENT, TYPE=T2D2, ELSET=Skin\n11, 1, 2\n12, 2, 3\n13, 3, 4\n14, 5, 4\n"
        "*NSET, NSET=FACE, ELSET=SKIN",
    ],
)
def test_all_sides_of_a_surface(surface):
    """
    requirement: labels are not case-sensitive, may be quoted, refer to other sets, continue on the
    next line: the surface is the whole lower side, of the length of four squares.
    """
    assert length(mesh_of(deck(surface))) == pytest.approx(4.0, rel=1e-12)


def test_free_sides():
    """
    requirement: a line without a side stands for the sides of its elements without a neighbour.
    """
    mesh = mesh_of(deck("*SURFACE, NAME=FACE\nSTRIP,"))
    (block,) = mesh.blocks
    ends = block.points[block.facets[:, :2]]
    assert np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum() == pytest.approx(10.0)


@pytest.mark.parametrize(
    ("surface", "expected"),
    [
        ("*SURFACE, NAME=FACE\nLEFT, S1\nRIGHT, S1", "line 23: the element set 'RIGHT' of"),
        ('*SURFACE, NAME=FACE\nLEFT, S1\n"RIGHT HALF", S1', "line 23: the element set 'RIGHT H"),
        ("*SURFACE, NAME=FACE\n1, S1\n77, S1", "line 23: element 77 of the surface 'FACE' is not"),
        ("*ELSET, ELSET=B\nLEFT,\n3, 44", "line 23: element 44 of the set 'B' is not defined"),
        ("*ELSET, ELSET=B\nLEFT, RIGHT", "line 22: the element set 'RIGHT' of the set 'B' is not"),
        ("*ELSET, ELSET=B, GENERATE\n5, 9", "line 22: the set 'B' has a range without defined"),
        ("*NSET, NSET=B\n1, 2\n\n3, 99", "line 24: node 99 of the set 'B' is not defined"),
        ("*NSET, NSET=B, ELSET=NO", "line 21: the element set 'NO' of the set 'B' is not defined"),
        ("*SURFACE, NAME=FACE\n1, S5", "line 22: the surface 'FACE' has elements without the side"),
        (WHOLE + "\n" + WHOLE, "line 26: the surface 'Face' is defined twice"),
        ("*SURFACE\n1, S1", "line 21: *SURFACE has no NAME="),
    ],
)
def test_what_is_not_defined(surface, expected):
    """
    requirement: a set, element, node or side that the file does not have is an error with its name
    and line, not a smaller surface.
    """
    with pytest.raises(ValueError, match="line ") as error:
        read_abaqus(deck(surface))
    assert str(error.value).startswith(expected)


def test_node_sets_with_gaps():
    """
    requirement: nodes of a set on no facet with all nodes in it are noted.
    """
    with pytest.warns(CaseNote, match="1 of 4 nodes of 'FACE' lie on no facet .* at \\(4 m, 0 m"):
        mesh = mesh_of(deck("*NSET, NSET=FACE\n1, 2, 3, 5"))
    assert length(mesh) == pytest.approx(2.0)


def test_no_side_is_lost():
    """
    requirement: a deck with a word of its surface changed is refused, or has the whole surface.
    """
    rng = np.random.default_rng(7)
    text = deck('*SURFACE, NAME=Face\nLEFT, S1\n3, S1\n"Right half", S1\n')
    start = text.index("*SURFACE")
    words = [word for word in ("LEFT", "Right half", "S1", "3", "Face") if word in text[start:]]
    for _ in range(10 * SAMPLE):
        word = words[rng.integers(len(words))]
        k = int(rng.integers(len(word)))
        other = word[:k] + "aZ0 9-é"[rng.integers(7)] + word[k + int(rng.integers(2)) :]
        changed = text[:start] + text[start:].replace(word, other, 1)
        try:
            mesh = mesh_of(changed, other if word == "Face" else "FACE")
        except Exception as error:
            assert "\n" not in str(error), other
        else:
            assert length(mesh) == pytest.approx(4.0), other

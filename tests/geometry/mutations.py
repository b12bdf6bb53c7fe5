"""Ways to spoil mesh files: as bytes, and as meshes."""

from __future__ import annotations

import copy

import numpy as np

from .plain import Plain

EXTREMES = [
    *("nan", "inf", "-inf", "1e300", "-1e300", "1e-320", "0", "-1", "abc", "", "0x10", "1e999"),
    *("99999999999", "-99999999999", "2147483648", "1" * 400, "1,5", "1;", "$End", "*NODE", "<a>"),
]
LINES = [
    b'SystemCall "true";',
    b"$Nodes",
    b"$EndElements",
    b"*INCLUDE, INPUT=/dev/zero",
    b"*NSET, NSET=ALL, GENERATE\n1, 99999999999",
    b"</Piece>",
    b"<!DOCTYPE a>",
    b"\0\0\0",
]


def flip(data: bytes, rng) -> bytes:
    """Some bits of some bytes."""
    found = bytearray(data)
    for at in rng.integers(len(found), size=rng.integers(1, 6)):
        found[at] ^= 1 << int(rng.integers(8))
    return bytes(found)


def cut_out(data: bytes, rng) -> bytes:
    """A span is missing."""
    a = int(rng.integers(len(data)))
    return data[:a] + data[a + int(rng.integers(1, 200)) :]


def repeated(data: bytes, rng) -> bytes:
    """A span is there twice."""
    a = int(rng.integers(len(data)))
    return data[: a + int(rng.integers(1, 200))] + data[a:]


def truncated(data: bytes, rng) -> bytes:
    """The end is missing."""
    return data[: int(rng.integers(len(data)))]


def _lines(data: bytes) -> list[bytes]:
    return data.split(b"\n")


def line_lost(data: bytes, rng) -> bytes:
    """A line is missing."""
    lines = _lines(data)
    del lines[int(rng.integers(len(lines)))]
    return b"\n".join(lines)


def line_twice(data: bytes, rng) -> bytes:
    """A line is there twice."""
    lines = _lines(data)
    k = int(rng.integers(len(lines)))
    return b"\n".join([*lines[:k], lines[k], *lines[k:]])


def lines_swapped(data: bytes, rng) -> bytes:
    """Two lines stand in each other's place."""
    lines = _lines(data)
    a, b = rng.integers(len(lines), size=2)
    lines[a], lines[b] = lines[b], lines[a]
    return b"\n".join(lines)


def line_put_in(data: bytes, rng) -> bytes:
    """A line of another format, or a command."""
    lines = _lines(data)
    k = int(rng.integers(len(lines)))
    return b"\n".join([*lines[:k], LINES[int(rng.integers(len(LINES)))], *lines[k:]])


def word_replaced(data: bytes, rng) -> bytes:
    """A number is another one, or none."""
    lines = _lines(data)
    k = int(rng.integers(len(lines)))
    words = lines[k].split(b" ")
    words[int(rng.integers(len(words)))] = EXTREMES[int(rng.integers(len(EXTREMES)))].encode()
    return b"\n".join([*lines[:k], b" ".join(words), *lines[k + 1 :]])


def number_shifted(data: bytes, rng) -> bytes:
    """A number of a node, an element or a set is one more or less."""
    lines = _lines(data)
    whole = [
        (k, j)
        for k, line in enumerate(lines)
        for j, word in enumerate(line.split(b" "))
        if word.strip(b",").isdigit()
    ]
    if not whole:
        return flip(data, rng)
    k, j = whole[int(rng.integers(len(whole)))]
    words = lines[k].split(b" ")
    comma = b"," if words[j].endswith(b",") else b""
    words[j] = str(int(words[j].strip(b",")) + int(rng.choice([-1, 1]))).encode() + comma
    return b"\n".join([*lines[:k], b" ".join(words), *lines[k + 1 :]])


AS_BYTES = [
    *(flip, cut_out, repeated, truncated, line_lost, line_twice, lines_swapped, line_put_in),
    *(word_replaced, number_shifted),
]


def _of(sequence, rng) -> int:
    return int(rng.integers(len(sequence)))


def node_moved(mesh: Plain, rng) -> None:
    """A node goes up to three cells away."""
    k = _of(mesh.points, rng)
    mesh.points[k] = [x + 0.03 * rng.uniform(-1, 1) for x in mesh.points[k]]


def nodes_jittered(mesh: Plain, rng) -> None:
    """All nodes go a little away."""
    size = 10.0 ** rng.uniform(-5, -2)
    mesh.points = [[x + size * rng.uniform(-1, 1) for x in p] for p in mesh.points]


def nodes_merged(mesh: Plain, rng) -> None:
    """One node stands for two."""
    a, b = _of(mesh.points, rng), _of(mesh.points, rng)
    mesh.cells = [(name, [a if n == b else n for n in of]) for name, of in mesh.cells]


def cell_shuffled(mesh: Plain, rng) -> None:
    """The nodes of a cell in any order."""
    k = _of(mesh.cells, rng)
    mesh.cells[k] = (mesh.cells[k][0], rng.permutation(mesh.cells[k][1]).tolist())


def cell_turned(mesh: Plain, rng) -> None:
    """A cell listed the other way round, which is harmless."""
    k = _of(mesh.cells, rng)
    mesh.cells[k] = (mesh.cells[k][0], mesh.cells[k][1][::-1])


def cell_lost(mesh: Plain, rng) -> None:
    """Some cells are missing."""
    for _ in range(rng.integers(1, 4)):
        del mesh.cells[_of(mesh.cells, rng)]


def cell_twice(mesh: Plain, rng) -> None:
    """A cell is there twice, perhaps listed otherwise."""
    name, nodes = mesh.cells[_of(mesh.cells, rng)]
    mesh.cells.append((name, np.roll(nodes, int(rng.integers(4))).tolist()))


def cell_of_the_other(mesh: Plain, rng) -> None:
    """A cell of one body is among those of the other."""
    k = _of(mesh.cells, rng)
    name, nodes = mesh.cells[k]
    mesh.cells[k] = ("PLATE" if name == "PUNCH" else "PUNCH", nodes)


def cell_of_anything(mesh: Plain, rng) -> None:
    """One more cell between any nodes."""
    nodes = rng.choice(len(mesh.points), 4, replace=False).tolist()
    mesh.cells.append(("PUNCH", nodes))


def node_doubled(mesh: Plain, rng) -> None:
    """Cells that should share a node each have one of their own there."""
    k = _of(mesh.cells, rng)
    name, nodes = mesh.cells[k]
    j = int(rng.integers(4))
    mesh.points.append(list(mesh.points[nodes[j]]))
    mesh.cells[k] = (name, [*nodes[:j], len(mesh.points) - 1, *nodes[j + 1 :]])


def line_of_another(mesh: Plain, rng) -> None:
    """A line has another name."""
    k = _of(mesh.lines, rng)
    mesh.lines[k] = (mesh.lines[_of(mesh.lines, rng)][0], mesh.lines[k][1])


def line_of_anything(mesh: Plain, rng) -> None:
    """A line between any nodes."""
    k = _of(mesh.lines, rng)
    mesh.lines[k] = (mesh.lines[k][0], rng.integers(len(mesh.points), size=2).tolist())


def line_gone(mesh: Plain, rng) -> None:
    """A line is missing."""
    del mesh.lines[_of(mesh.lines, rng)]


def stretched(mesh: Plain, rng) -> None:
    """A wrong unit along one or both axes."""
    x, y = 10.0 ** rng.choice([-12, -6, -3, -1, 0, 1, 3, 6, 12], size=2)
    mesh.points = [[x * p, y * q] for p, q in mesh.points]


def mirrored(mesh: Plain, rng) -> None:
    """Left is right, or up is down."""
    x, y = rng.choice([-1.0, 1.0], size=2)
    mesh.points = [[x * p, y * q] for p, q in mesh.points]


def body_moved(mesh: Plain, rng) -> None:
    """A body lies somewhere else."""
    size = 10.0 ** rng.uniform(-6, 1)
    x, y = size * rng.uniform(-1, 1, size=2)
    mesh.points = mesh.moved("PUNCH", float(x), float(y)).points


def body_turned(mesh: Plain, rng) -> None:
    """A body is turned about its middle."""
    nodes = mesh.nodes("PUNCH")
    middle = np.mean([mesh.points[n] for n in nodes], axis=0)
    c, s = np.cos(angle := rng.uniform(-np.pi, np.pi)), np.sin(angle)
    for n in nodes:
        x, y = np.array(mesh.points[n]) - middle
        mesh.points[n] = (middle + [c * x - s * y, s * x + c * y]).tolist()


def renumbered(mesh: Plain, rng) -> None:
    """Nodes and cells in another order, which is harmless."""
    order = rng.permutation(len(mesh.points))
    place = np.argsort(order)
    mesh.points = [mesh.points[k] for k in order]
    mesh.cells = [(name, place[of].tolist()) for name, of in mesh.cells]
    mesh.lines = [(name, place[of].tolist()) for name, of in mesh.lines]
    rng.shuffle(mesh.cells)


AS_MESH = [
    *(node_moved, nodes_jittered, nodes_merged, cell_shuffled, cell_turned, cell_lost, cell_twice),
    *(cell_of_the_other, cell_of_anything, node_doubled, line_of_another, line_of_anything),
    *(line_gone, stretched, mirrored, body_moved, body_turned, renumbered),
]
HARMLESS = (cell_turned, renumbered)


def spoilt(mesh: Plain, change, rng) -> Plain:
    result = copy.deepcopy(mesh)
    change(result, rng)
    return result

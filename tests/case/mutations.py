"""Case files with something wrong in them, at random: the classes of mutation of the fuzzer.

Each class takes the tables of a sound case and a random generator, and gives the bytes of a case
file, with overrides as behind ``--set``.
"""

from __future__ import annotations

import copy
import datetime
from collections.abc import Callable
from random import Random
from typing import Any

import tomli_w

from thermowear.case.starters import starters

from .starter import tables

Mutated = tuple[bytes, tuple[str, ...]]

NAMES = tuple(starters())
UNITS = (
    *("Pa", "MPa", "GPa", "psi", "N", "kN", "m", "mm", "um", "km", "inch", "s", "ms", "h", "min"),
    *("m/s", "mm/s", "rad/s", "rpm", "deg", "rad", "K", "degC", "degF", "W/(m K)", "W/(m^2 K)"),
    *("1/K", "kg/m^3", "J/(kg K)", "1/MPa", "1/MPa^2", "mm^3/(N m)", "Hz", "%", "dB", "1", ""),
    *("m^9^9^9", "m^(9^9)", "m⁹⁹⁹", "(", ")", "m/", "/m", "m m", "furlong", "Pa^0.5", "m^1e9"),
    *("degC/m", "delta_degC", "1/degC", "bit", "mol", "m**-2", "2 m", "µm", "Ω", "\u202e", "\x00"),
)
NUMBERS = (
    *("0", "-0.0", "1e-320", "1e-30", "1e-12", "1e-6", "1e-3", "-1", "1", "1e3", "1e6", "1e12"),
    *("1e30", "1e300", "1e400", "-1e300", "nan", "inf", "-inf", "0x10", "1_000", "١٢", "1,5"),
    *("9" * 400, "1e", ".", "+", "--1", "1e-400", "0.1.2"),
)
WORDS = (
    *("axisymmetric", "plane-strain", "plane-stress", "3d", "initial", "steady", "transient"),
    *("fretting", "reciprocating", "stability", "condensed", "penalty", "nitsche", "lobatto"),
    *("auto", "never", "track", "in-place", "pressure", "friction-stress", "effusivity", "table"),
    *("resolved", "spread", "none", "x", "y", "z", "rotation", "punch", "plate", "block", "a.b"),
    *(
        "",
        " ",
        "../../etc/passwd",
        "/dev/zero",
        "x" * 3000,
        "é\u0301",
        "\n",
        "\t",
        "\\",
        '"""',
        "\ud7ff",
    ),
)
KEYS = (
    *("elements", "degree", "friction", "like", "type", "bodies", "at", "factor", "history"),
    *("time", "force", "approach", "cycles", "half", "thickness", "conductance", "zone", "unit"),
    *("", " ", "a.b", "x\ny", "=", "é", "k" * 300, "__class__", "model_config", "type "),
)


def _leaves(table: dict, above: tuple = ()) -> list[tuple]:
    """Paths of all values that are no tables, those in lists too."""
    found: list[tuple] = []
    entries = table.items() if isinstance(table, dict) else enumerate(table)
    for key, value in entries:
        path = (*above, key)
        found += _leaves(value, path) if isinstance(value, dict | list) and value else [path]
    return found


def _branches(table: dict, above: tuple = ()) -> list[tuple]:
    """Paths of all tables, the whole one included."""
    below = [_branches(v, (*above, k)) for k, v in table.items() if isinstance(v, dict)]
    return [above, *(path for paths in below for path in paths)]


def _at(table: Any, path: tuple) -> Any:
    for key in path:
        table = table[key]
    return table


def _put(table: dict, path: tuple, value: Any) -> None:
    _at(table, path[:-1])[path[-1]] = value


def _written(case: dict) -> Mutated:
    return tomli_w.dumps(case).encode(), ()


def _junk(random: Random) -> Any:
    return random.choice(
        [
            lambda: random.choice(WORDS),
            lambda: f"{random.choice(NUMBERS)} {random.choice(UNITS)}",
            lambda: random.choice([True, False, 0, 1, -1, 2**63, 10**40, 0.5, 1e300, -0.0]),
            lambda: random.choice([float("nan"), float("inf")]),
            lambda: random.choice([[], {}, [[]], [{}], {"type": "x"}, [1, "a"], ["1 s"] * 50]),
            lambda: random.choice([datetime.date(2020, 2, 2), datetime.time(12)]),
        ]
    )()


def another_kind(case: dict, random: Random) -> Mutated:
    """A value, or a whole table, becomes something of any kind."""
    path = random.choice([*_leaves(case), *_branches(case)[1:]])
    _put(case, path, _junk(random))
    return _written(case)


def left_out(case: dict, random: Random) -> Mutated:
    """One to three keys or tables are left out."""
    for _ in range(random.randint(1, 3)):
        paths = [path for path in [*_leaves(case), *_branches(case)[1:]] if path]
        if paths:
            path = random.choice(paths)
            del _at(case, path[:-1])[path[-1]]
    return _written(case)


def added(case: dict, random: Random) -> Mutated:
    """A key is added somewhere: unknown, or of another table."""
    table = _at(case, random.choice(_branches(case)))
    table[random.choice(KEYS)] = _junk(random)
    return _written(case)


def renamed(case: dict, random: Random) -> Mutated:
    """A key is misspelt."""
    path = random.choice([*_leaves(case), *_branches(case)[1:]])
    table, key = _at(case, path[:-1]), path[-1]
    if isinstance(key, str):
        k = random.randrange(len(key))
        spoilt = random.choice([key[:k] + key[k + 1 :], key[:k] + key[k] + key[k:], key.upper()])
        table[spoilt] = table.pop(key)
    return _written(case)


def _quantities(case: dict) -> list[tuple]:
    return [
        path
        for path in _leaves(case)
        if isinstance(_at(case, path), str) and _at(case, path)[:1] in "-.0123456789"
    ]


def another_unit(case: dict, random: Random) -> Mutated:
    """A quantity has another unit: of its dimension, of another, none, or one that is no unit."""
    for path in random.sample(_quantities(case), min(2, len(_quantities(case)))):
        number = _at(case, path).partition(" ")[0]
        _put(case, path, f"{number} {random.choice(UNITS)}")
    return _written(case)


def another_number(case: dict, random: Random) -> Mutated:
    """A quantity has another number: none, negative, tiny, huge, not finite, or no number."""
    path = random.choice(_quantities(case))
    _, space, unit = _at(case, path).partition(" ")
    _put(case, path, f"{random.choice(NUMBERS)}{space}{unit}")
    return _written(case)


def another_size(case: dict, random: Random) -> Mutated:
    """Numbers are off by orders, as after a slip in a unit."""
    for _ in range(random.randint(1, 3)):
        path = random.choice(_leaves(case))
        value, factor = _at(case, path), 10.0 ** random.choice([-9, -6, -3, -2, 2, 3, 6, 9])
        if isinstance(value, bool):
            continue
        if isinstance(value, int | float):
            _put(case, path, type(value)(value * factor))
        elif path in _quantities(case):
            number, space, unit = value.partition(" ")
            try:
                _put(case, path, f"{float(number) * factor!r}{space}{unit}")
            except ValueError:
                continue
    return _written(case)


def exchanged(case: dict, random: Random) -> Mutated:
    """Two values change places."""
    one, other = (random.choice(_leaves(case)) for _ in range(2))
    first, second = _at(case, one), _at(case, other)
    _put(case, one, second)
    _put(case, other, first)
    return _written(case)


def crossed(case: dict, random: Random) -> Mutated:
    """Tables come from other cases."""
    for _ in range(random.randint(1, 2)):
        other = tables(random.choice(NAMES))
        key = random.choice(list(other))
        case[key] = other[key]
    return _written(case)


def another_word(case: dict, random: Random) -> Mutated:
    """A word is one of those that other keys take."""
    words = [
        p for p in _leaves(case) if isinstance(_at(case, p), str) and p not in _quantities(case)
    ]
    _put(case, random.choice(words), random.choice(WORDS))
    return _written(case)


def another_list(case: dict, random: Random) -> Mutated:
    """A list is emptied, turned round, shuffled, shortened, or has a value twice."""
    lists = [p[:-1] for p in _leaves(case) if isinstance(p[-1], int)]
    if not lists:
        _put(case, random.choice(_leaves(case)), [_junk(random) for _ in range(3)])
        return _written(case)
    path = random.choice(lists)
    values = list(_at(case, path))
    change: Callable[[list], Any] = random.choice(
        [
            lambda v: [],
            lambda v: v[::-1],
            lambda v: random.sample(v, len(v)),
            lambda v: v[:-1],
            lambda v: v + v[-1:],
            lambda v: v * 2000,
            lambda v: {"0": v},
        ]
    )
    _put(case, path, change(values))
    return _written(case)


def spoilt_text(case: dict, random: Random) -> Mutated:
    """Lines are missing or there twice, the file ends early, characters are others."""
    text = tomli_w.dumps(case)
    lines = text.splitlines()
    k = random.randrange(len(lines))
    change = random.choice(
        [
            lambda: "\n".join(lines[:k] + lines[k + 1 :]),
            lambda: "\n".join(lines[:k] + [lines[k]] + lines[k:]),
            lambda: text[: random.randrange(len(text))],
            lambda: "\n".join(random.sample(lines, len(lines))),
            lambda: text.replace(random.choice('="[].'), random.choice('="[].\n# \x00'), 1),
            lambda: text.replace("\n", random.choice(["\r\n", "\r", "\x0b", "\u2028"])),
            lambda: text + random.choice(['"""', "[", "a", "= 1", "[[bodies]]", "[bodies]", "\\"]),
        ]
    )
    return change().encode(), ()


def spoilt_bytes(case: dict, random: Random) -> Mutated:
    """Bytes are others, or the encoding is."""
    text = tomli_w.dumps(case | {"title": "µ"})
    content = bytearray(text.encode())
    if random.random() < 0.3:
        return text.encode(random.choice(["utf-16", "utf-8-sig", "latin-1", "utf-32"])), ()
    for _ in range(random.randint(1, 20)):
        content[random.randrange(len(content))] = random.randrange(256)
    return bytes(content), ()


def endless(case: dict, random: Random) -> Mutated:
    """Keys, values, tables and numbers are very long or very deep."""
    count = random.choice([30, 300, 30_000])
    path = random.choice(_leaves(case))
    text = random.choice(
        [
            ".".join("a" * count) + " = 1",
            "b = " + "[" * count + "]" * count,
            "b = " + "9" * count,
            "b = 0x" + "f" * count,
            "a" * count + " = 1",
            f"[{'.'.join('a' * count)}]",
            "b = [" + "1, " * count + "]",
        ]
    )
    if random.random() < 0.5:
        _put(case, path, random.choice("x9 ") * count)
        return _written(case)
    return f"{text}\n{tomli_w.dumps(case)}".encode(), ()


def overridden(case: dict, random: Random) -> Mutated:
    """Something stands behind --set, sound or not."""
    keys = [".".join(map(str, path)) for path in _leaves(case)]
    found = []
    for _ in range(random.randint(1, 3)):
        key = random.choice([*keys, *KEYS, f"{random.choice(keys)}.{random.choice(KEYS)}"])
        value = random.choice([*WORDS, *NUMBERS, "[1, 2]", "{a = 1}", "6\nb = 2", '"1 MPa"', "[["])
        found.append(f"{key}{random.choice(['=', '=', '=', ''])}{value}")
    return tomli_w.dumps(case).encode(), tuple(found)


CLASSES = (
    *(another_kind, left_out, added, renamed, another_unit, another_number, another_size),
    *(exchanged, crossed, another_word, another_list, spoilt_text, spoilt_bytes, endless),
    overridden,
)


def coarsened(case: dict) -> None:
    """Make a case a matter of a second: few elements of a low degree, a loose tolerance in time."""
    own_mesh = "path" in case["geometry"]
    case["mesh"] = {"degree": 2} if own_mesh else {"degree": 3, "elements": 6}
    if case["analysis"]["type"] in ("transient", "reciprocating"):
        case["analysis"]["tolerance"] = 0.1


def mutated(seed: int, coarse: bool = False) -> tuple[str, Mutated]:
    """A case by its number: the class of mutation, the bytes of the file, and overrides.

    Where `coarse`, the case is made quick to compute before it is mutated.
    """
    random = Random(seed)
    case = copy.deepcopy(tables(random.choice(NAMES)))
    if coarse:
        coarsened(case)
    kind = CLASSES[seed % len(CLASSES)]
    return kind.__name__, kind(case, random)

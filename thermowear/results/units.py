"""SI units in the names of keys and columns, and engineering units that suit a size."""

from __future__ import annotations

_MULTIPLES: dict[str, tuple[tuple[float, str, float], ...]] = {
    "Pa": ((1e10, "GPa", 1e-9), (0.0, "MPa", 1e-6)),
    "N": ((1e3, "kN", 1e-3), (0.0, "N", 1.0)),
    "N m": ((1e3, "kN m", 1e-3), (0.0, "N m", 1.0)),
    "m": ((1e-3, "mm", 1e3), (0.0, "µm", 1e6)),
    "m²": ((0.0, "mm²", 1e6),),
    "m³": ((0.0, "mm³", 1e9),),
    "m/s": ((1.0, "m/s", 1.0), (1e-3, "mm/s", 1e3), (1e-6, "µm/s", 1e6), (0.0, "nm/s", 1e9)),
    "W": ((1e3, "kW", 1e-3), (0.0, "W", 1.0)),
    "W/m²": ((1e3, "kW/m²", 1e-3), (0.0, "W/m²", 1.0)),
    "J": ((1e3, "kJ", 1e-3), (1.0, "J", 1.0), (1e-3, "mJ", 1e3), (0.0, "µJ", 1e6)),
    "rad": ((1.0, "rad", 1.0), (1e-3, "mrad", 1e3), (0.0, "µrad", 1e6)),
    "rad/s": ((1e-3, "rad/s", 1.0), (0.0, "nrad/s", 1e9)),
}
"""Engineering units by SI unit: smallest size [SI], unit, and scale from the SI unit."""

_IN_KEYS = {
    **{unit: unit for unit in ("Pa", "N", "m", "s", "K", "W", "J", "rad", "Hz", "kg")},
    **{"Nm": "N m", "m2": "m²", "m3": "m³"},
}
"""SI units by their spelling in the keys of results."""
_SPELLED = {unit: spelling for spelling, unit in _IN_KEYS.items()}


def key(name: str, si: str) -> str:
    """Key of a quantity: its name and its SI unit, such as ``wear_rate_1_m_per_s``."""
    above, _, below = si.partition("/")
    words = [name, _SPELLED.get(above, ""), *(["per", _SPELLED[below]] if below else [])]
    return "_".join(filter(None, words))


def split_key(key: str) -> tuple[str, str]:
    """Name and SI unit of a key such as ``wear_rate_1_m_per_s``: ``wear rate 1`` and ``m/s``."""
    *words, last = key.split("_")
    unit = _IN_KEYS.get(last, "")
    if unit and len(words) >= 2 and words[-1] == "per":
        above = _IN_KEYS.get(words[-2], "1")
        words, unit = words[: -1 if above == "1" else -2], f"{above}/{unit}"
    if not unit or not words:
        return key.replace("_", " "), ""
    return " ".join(words), unit


def multiple(si: str, size: float) -> tuple[str, float]:
    """Engineering unit for numbers up to a size [SI], and its scale from the SI unit."""
    for least, unit, scale in _MULTIPLES.get(si, ((0.0, si, 1.0),)):
        if abs(size) >= least:
            return unit, scale
    return si, 1.0  # the size is not a number


def scale_of(unit: str, si: str) -> tuple[float, float]:
    """Scale and offset of a unit: value = scale · SI value + offset."""
    if unit == "°C":
        return 1.0, -273.15
    known = {name: scale for _, name, scale in _MULTIPLES.get(si, ())}
    return (1.0, 0.0) if unit == (si or "1") else (known[unit], 0.0)

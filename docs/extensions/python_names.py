"""Reference of the Python interface: the names of the package and of its rooms."""

from __future__ import annotations

import importlib
import inspect
from typing import Any

import thermowear

_ROOMS = {
    "laws": "Laws of friction, wear and conductance; the principle of steady wear",
    "case": "Case files",
    "geometry": "Geometries",
    "bulk": "Elasticity and heat conduction",
    "contact": "Contact: pairing, condensation, solvers",
    "results": "Tables and summary of the results",
    "inference": "Inference from measurements, uncertain inputs",
}
_OF_LAWS = "_PRINCIPLE"


def public_names() -> dict[str, list[str]]:
    """Names of the public classes and functions by their module."""
    rooms = set(thermowear._ROOMS)
    found = {"thermowear": [name for name in thermowear.__all__ if name not in rooms]}
    for room in _ROOMS:
        module = importlib.import_module(f"thermowear.{room}")
        names = [name for name, value in vars(module).items() if _is_public(name, value)]
        for lazy in getattr(module, _OF_LAWS, {}).values():
            names += lazy
        found[f"thermowear.{room}"] = sorted(set(names).difference(*found.values()), key=str.lower)
    return found


def _is_public(name: str, value: Any) -> bool:
    of_us = getattr(value, "__module__", "").startswith("thermowear")
    return not name.startswith("_") and of_us and (inspect.isclass(value) or callable(value))


def python_pages() -> dict[str, str]:
    """Pages of the reference by name."""
    names = public_names()
    pages = {"index": _index()}
    for module, own in names.items():
        room = module.rpartition(".")[2]
        title = _ROOMS.get(room, "Cases, models and analyses")
        entries = "\n".join(_entry(module, name) for name in own)
        pages[room] = f"# `{module}`: {title}\n\n{entries}"
    return pages


def _index() -> str:
    pages = "\n".join(["thermowear", *_ROOMS])
    return (
        "# Python interface\n\n`import thermowear as tw` has the names of the first page; those of "
        "the rooms are `tw.laws`, `tw.contact` and so on. A [guide](../../guides/python.md) shows "
        "how they are used.\n\n"
        f"```{{toctree}}\n:maxdepth: 1\n\n{pages}\n```\n"
    )


def _entry(module: str, name: str) -> str:
    value = getattr(importlib.import_module(module), name)
    kind = "autoclass" if inspect.isclass(value) else "autofunction"
    options = ":members:\n   :exclude-members: model_config\n" if kind == "autoclass" else ""
    return f"```{{eval-rst}}\n.. {kind}:: {module}.{name}\n   {options}```\n"

"""Largest pressure of contacts that grow by wear, at every step, against the closed form.

    scripts/env python3 tests/benchmarks/growing_contacts.py [cylinder|sphere] [METHOD] [ELEMENTS…]

The range of the ratio is that over all accepted steps between 3 and 6 times the first half-width,
so wherever the edge of the contact stands in its element. Asked for: 0.95 to 1.05 on any mesh.
Meshes of 160 elements take the full methods a quarter of an hour of processor time and more.
"""

from __future__ import annotations

import sys
import time

import numpy as np

from thermowear.verification.cases.wear.growing import CYLINDER, SPEED, SPHERE
from thermowear.verification.check import run_starter

SHAPES = {"cylinder": CYLINDER, "sphere": SPHERE}
METHODS = ("condensed", "penalty", "nitsche")
FIRST, LAST = 3, 6
"""Range of the half-width over that of the unworn contact, by the closed form."""


def ratios(shape: str, method: str, elements: int) -> tuple[int, np.ndarray]:
    """Number of steps, and the largest pressure over the uniform one from `FIRST` on."""
    case = SHAPES[shape]
    law = case.law(case.coefficient)
    end = float(law.distance(law.start * LAST)) / SPEED
    overrides = (
        f"analysis.end_time={end!r} s",
        f"mesh.elements={elements}",
        f'contact.method="{method}"',
    )
    history = run_starter(case.starter, *overrides).history
    distance = np.array([row.time for row in history]) * SPEED
    late = law.half_width(distance) >= FIRST * law.start
    peak = np.array([row.max_pressure for row in history])[late]
    return len(history) - 1, peak * law.elastic_half_width(distance[late]) ** case.power / case.load


def main(arguments: list[str]) -> None:
    shapes = [a for a in arguments if a in SHAPES] or list(SHAPES)
    methods = [a for a in arguments if a in METHODS] or list(METHODS)
    meshes = [int(a) for a in arguments if a.isdigit()] or [40, 80, 160]
    print("shape     method     elements  steps  from 3 a0 on: number, smallest, largest    cpu s")
    for shape in shapes:
        for method in methods:
            for elements in meshes:
                began = time.process_time()
                steps, found = ratios(shape, method, elements)
                print(
                    f"{shape:8}  {method:9}  {elements:8}  {steps:5}  {len(found):20}"
                    f"  {found.min():8.4f}  {found.max():7.4f}  {time.process_time() - began:7.0f}",
                    flush=True,
                )


if __name__ == "__main__":
    main(sys.argv[1:])

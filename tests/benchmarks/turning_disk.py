"""How fine a mesh must be under a block on a disk that turns at Péclet numbers of 10 to 5 000.

    scripts/env python3 tests/benchmarks/turning_disk.py

The Péclet number is the disk's radius times its rim speed over its diffusivity; the force falls
with the speed, so that the friction heat is always the same.
"""

from __future__ import annotations

import time

import thermowear as tw

CASE = "demos/block_on_disk_turning.toml"
PECLET = (10, 100, 1000, 5000)
MESHES = ((3, 8), (5, 12), (6, 16), (8, 24))
"""Degree and elements along the contact; the second is that of the case."""
RADIUS, DIFFUSIVITY, POWER = 0.02, 50 / (7800 * 460), 105.0  # m, m²/s, W
FRICTION = 0.3


def hottest(peclet: float, degree: int, elements: int) -> tuple[tuple[float, float], dict, float]:
    """Largest rise of both faces [K], the summary, and wall seconds."""
    speed = peclet * DIFFUSIVITY / RADIUS
    began = time.perf_counter()
    result = tw.run(
        tw.load(
            CASE,
            (
                f'motion.angular_velocity="{speed / RADIUS} rad/s"',
                f'load.force="{POWER / (FRICTION * speed)} N"',
                f"mesh.degree={degree}",
                f"mesh.elements={elements}",
            ),
        )
    )
    faces = result.interface.temperature_1, result.interface.temperature_2
    seconds = time.perf_counter() - began
    return (faces[0].max() - 293.15, faces[1].max() - 293.15), result.summary, seconds


def main() -> None:
    print(
        "Péclet  degree  elements  cell Péclet          way  T1 - T0    T2 - T0   to the one before"
    )
    for peclet in PECLET:
        before = None
        for degree, elements in MESHES:
            rises, summary, seconds = hottest(peclet, degree, elements)
            changes = zip(rises, before or rises, strict=True)
            change = max(abs(a - b) / a for a, b in changes)
            print(
                f"{peclet:6}  {degree:6}  {elements:8}  {summary['max_cell_peclet_number']:11.3g}"
                f"  {summary['heat_advection']:>11}  {rises[0]:7.4f} K  {rises[1]:7.4f} K"
                f"  {'' if before is None else f'{change:.1e}':>9}   {seconds:.2f} s"
            )
            before = rises


if __name__ == "__main__":
    main()

"""Checks that every mesh of a geometry must pass."""

from __future__ import annotations

import numpy as np
import pytest

from thermowear.case.values.section import KeyFault

from .measure import areas, edges, scaled_jacobians


def check_mesh(mesh, sections: dict[str, float], rel: float = 1e-12, shape: float = 0.1) -> None:
    """Cells are well shaped and fill sections of known areas [m²]; no surface is empty or shared.

    Parameters
    ----------
    mesh : thermowear.geometry.mesh.tagged.TaggedMesh
    sections : dict of str to float
        Area of each body [m²].
    rel : float
        Tolerance of the areas.
    shape : float
        Least sine of the angle between the grid lines of a cell.
    """
    assert scaled_jacobians(mesh).min() > shape
    assert tuple(sections) == mesh.bodies
    for body, area in sections.items():
        assert areas(mesh, body).sum() == pytest.approx(area, rel=rel), body
    tags = np.bincount(mesh.facet_tags, minlength=len(mesh.surfaces) + 1)[1:]
    assert np.all(tags > 0), dict(zip(mesh.surfaces, tags, strict=True))
    ends = np.sort(mesh.facets[:, :2], axis=1)
    assert len(np.unique(ends, axis=0)) == len(ends)


def check_surfaces(mesh, expected: dict[str, tuple[int, float]]) -> None:
    """Surfaces lie where they should: by name, a coordinate (0 or 1) and its value [m]."""
    assert set(expected) == set(mesh.surfaces)
    for surface, (axis, value) in expected.items():
        found = edges(mesh, surface)[..., axis]
        np.testing.assert_allclose(found, value, rtol=0, atol=1e-12, err_msg=surface)


def spans(mesh, surface: str) -> list[tuple[float, float]]:
    """Ranges of x that a level surface covers, joined where they meet [m]."""
    found = np.sort(edges(mesh, surface)[:, :2, 0], axis=1)
    found = found[found[:, 0].argsort()]
    apart = np.flatnonzero(found[1:, 0] - found[:-1, 1] > 1e-9) + 1
    return [(float(part[0, 0]), float(part[-1, 1])) for part in np.split(found, apart)]


def fault(make, **keys) -> tuple[str, str]:
    """Key and message of the one fault that a geometry finds in its keys."""
    with pytest.raises(
        ValueError, match=r"must be|must lie|missing|requires|not symmetric"
    ) as error:
        make(**keys)
    (found,) = error.value.errors()
    inner = found["ctx"]["error"]
    key = inner.key if isinstance(inner, KeyFault) else found["loc"][0]
    return key, str(inner)

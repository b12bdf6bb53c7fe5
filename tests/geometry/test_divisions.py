"""Graded division of lines."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from thermowear.geometry.meshing.divisions import graded_face, growing, growing_from_both


@given(n=st.integers(1, 60), g=st.floats(0.1, 1.0))
def test_graded_face_has_the_asked_elements_and_ratio(n, g):
    """requirement: `elements` along the contact; up to three at each edge shrink by `grading`."""
    h = np.diff(graded_face(0.02, 0.12, n, g))
    assert len(h) == n
    assert h.sum() == pytest.approx(0.1, rel=1e-12)
    np.testing.assert_allclose(h, h[::-1], rtol=1e-9)
    layers = min(3, (n - 1) // 2)
    ratios = h[1 : layers + 1] / h[:layers]
    np.testing.assert_allclose(ratios, 1 / g, rtol=1e-9)


@given(
    span=st.floats(1e-3, 1.0), first=st.floats(1e-5, 1e-2), g=st.floats(0.1, 1.0), up=st.booleans()
)
def test_growing_fills_the_span(span, first, g, up):
    """requirement: blocks tile their span, listed upwards, thin elements at the start."""
    end = span if up else -span
    ends = growing(0.0, end, min(first, span), g, 0.2 * span)
    h = np.diff(ends)
    assert np.all(h > 0)
    assert h.sum() == pytest.approx(span, rel=1e-9)
    assert ends[0] == pytest.approx(min(0.0, end))
    assert ends[-1] == pytest.approx(max(0.0, end))
    at_start = h[0] if up else h[-1]
    assert at_start <= h.max() * (1 + 1e-9)


def test_growing_from_both_is_thin_at_both_ends():
    """requirement: clamped edges are graded too."""
    ends = growing_from_both(-0.1, 0.0, (2e-3, 1e-3), 0.3, 0.03)
    h = np.diff(ends)
    assert h[0] < 4e-3
    assert h[-1] < 2e-3

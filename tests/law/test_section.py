# SPDX-License-Identifier: BSD-3-Clause
"""The projection on sections of the friction cone: feasible, nearest, and its first-order form."""

import numpy as np
from hypothesis import strategies as st

from signorini.law.section import nearest_point
from tests.helpers.contact_samples import for_all

NUMBER = st.floats(-10, 10)
AXIS = st.sampled_from([0.0, 0.01, 0.3, 0.5, 1.0, 7.0, 1e6])


def corners(facets):
    angle = 2 * np.pi * np.arange(facets) / max(facets, 1)
    return np.column_stack([np.cos(angle), np.sin(angle)])


def support(a, facets, direction):
    """Largest component along a direction that the section holds."""
    if facets:
        return (corners(facets) * a @ direction).max()
    return np.linalg.norm(a * direction)


@for_all(
    300, y=st.tuples(NUMBER, NUMBER), m=st.tuples(AXIS, AXIS), s=st.floats(0, 3), facets=st.sampled_from([0, 4, 12])
)
def test_the_projection_is_the_nearest_point_of_the_section(y, m, s, facets):
    y, a = np.array(y), np.array(m) * s
    r = np.array(nearest_point(*y, *m, s, facets)[:2])
    size = max(1.0, *np.abs(y), *a)  # rounding of a point on a boundary so long
    for angle in np.linspace(0, 2 * np.pi, 17):
        direction = np.array([np.cos(angle), np.sin(angle)])
        assert direction @ r <= support(a, facets, direction) + 1e-13 * size
    # nearest: the section lies behind the line through r across y - r
    away = y - r
    assert support(a, facets, away) <= away @ r + 1e-13 * size**2


@for_all(100, y=st.tuples(NUMBER, NUMBER), m=st.tuples(AXIS, AXIS), seed=st.integers(0, 1000))
def test_the_first_order_form_predicts_the_projection_of_a_point_near_by(y, m, seed):
    d = 1e-5 * np.random.default_rng(seed).normal(size=3)
    s = 1.0
    r_1, r_2, left, *tau, kappa = nearest_point(*y, *m, s, 0)
    *near, left_there, _, _, _ = nearest_point(y[0] + d[0], y[1] + d[1], *m, s + d[2], 0)
    near = np.array(near)
    if left_there != left or left == 2:
        return
    r, tau = np.array([r_1, r_2]), np.array(tau)
    predicted = (s + d[2]) / s * r
    if left:
        # tau . (y' - r') = kappa q with r' = s' e + q tau
        q = tau @ (np.array(y) + d[:2] - predicted) / (1 + kappa)
        predicted = predicted + q * tau
    np.testing.assert_allclose(near, predicted, atol=1e-7 / max(min(m), 0.01))

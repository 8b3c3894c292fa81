# SPDX-License-Identifier: BSD-3-Clause
"""A curved punch moved there and back on a half-plane, through full sliding."""

import numpy as np
import pytest

from tests.helpers.path_samples import Springs

MU = 0.5


def punch(pairs, coupling):
    """Compliance of a half-plane, tilted by the coupling; and nodal forces that move the punch as a whole."""
    x = np.linspace(-1.0, 1.0, pairs)
    A = -np.log(np.abs(x[:, None] - x) + 0.5 / pairs) + 1.2
    B = 0.3 * coupling * np.sign(x[:, None] - x)
    compliance = np.block([[A, B], [B.T, A]])
    compliance += max(0.0, 0.05 - np.linalg.eigvalsh(compliance)[0]) * np.eye(2 * pairs)
    S = np.linalg.inv(compliance)
    S = (S + S.T) / 2
    body = Springs(S, np.full(pairs, MU), 0.3 * x**2)
    return body, lambda u_n, u_t: S @ np.append(np.full(pairs, u_n), np.full(pairs, u_t))


@pytest.mark.parametrize("pairs", [20, 61])
@pytest.mark.parametrize("coupling", [0.0, 0.2])
def test_there_and_back(pairs, coupling):
    body, moved = punch(pairs, coupling)
    forces = [moved(-0.2, 0.0), *(moved(-0.2, way) for way in (1.0, -1.0, 1.0, -1.0, 1.0))]
    segments = body.run(*forces)
    assert len(segments) == len(forces)
    assert segments[-1].followed
    assert max(segment.factorisations for segment in segments) <= 2
    for segment in segments[1:]:
        p, friction = segment.end.r
        assert abs(friction.sum()) == pytest.approx(MU * p.sum(), rel=1e-12)
        assert set(segment.end.state) <= {0, 2, 3}
    for first, second in ((segments[2], segments[4]), (segments[3], segments[5])):
        np.testing.assert_allclose(second.end.r, first.end.r, rtol=0, atol=1e-12)
        np.testing.assert_allclose(second.end.h, first.end.h, rtol=0, atol=1e-12)
        assert second.pivots == first.pivots
    end = segments[-1].end
    stored = body.strain_energy(end) + end.dissipation.sum()
    assert body.work(segments, forces) == pytest.approx(stored, rel=1e-11)

# SPDX-License-Identifier: BSD-3-Clause
"""Pairs on the way from one place to another."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp

import signorini as sg
from signorini.engine.examine import examine
from signorini.interface.interface import Interface
from signorini.interface.mean_pairs import MeanPairs


@pytest.fixture(scope="module")
def pairs() -> Interface:
    """A block on a bed whose nodes are not opposite its own."""
    top = sg.rectangle(x=np.linspace(0.0, 1.0, 4), y=np.linspace(0.0, 1.0, 2))
    bed = sg.rectangle(x=np.linspace(-1.0, 2.0, 6), y=np.linspace(-1.0, 0.0, 2))
    return examine(
        sg.Model(
            mesh=sg.join({"top": top, "bed": bed}),
            kind="plane strain",
            bodies=[sg.Body("top", sg.Elastic(E=1.0, nu=0.3)), sg.Body("bed", sg.Elastic(E=1.0, nu=0.3))],
            supports=[sg.Support("bed.bottom", u=(0.0, 0.0)), sg.Support("top.top", u=(0.1, -0.01))],
            contacts=[sg.Contact("top.bottom", "bed.top", friction=0.3, sliding="finite")],
        )
    ).interface


def test_gaps_grow_by_what_they_do(pairs: Interface) -> None:
    """Through the mean, of pairs that slide; and rows of the end are the mean and the rest."""
    n = len(pairs)
    turned = replace(pairs, B=sp.csr_array(pairs.B + 0.01 * sp.vstack([pairs.B[n:], -pairs.B[:n]])))
    way = np.random.default_rng(1).normal(size=pairs.B.shape[1])
    opened = np.linspace(-1e-3, 2e-3, n) + (0.5 * (pairs.B + turned.B) @ way)[:n]
    mean = MeanPairs.between(pairs, turned, way, opened, least=1e-6)
    assert (mean.interface.B @ way)[:n] == pytest.approx(opened, abs=1e-13)
    assert abs(mean.interface.B[n:] + mean.rest[n:] - turned.B[n:]).max() < 1e-15
    assert abs(mean.rest - 0.5 * (turned.B - pairs.B)).max() < 1e-15


def test_what_does_not_slide_is_not_tilted(pairs: Interface) -> None:
    """Nor what is not known; and no normal is tilted by more than a twentieth."""
    n = len(pairs)
    way = np.random.default_rng(1).normal(size=pairs.B.shape[1])
    opened = (pairs.B @ way)[:n] + 10.0
    assert abs(MeanPairs.between(pairs, pairs, way, opened, least=1e3).interface.B - pairs.B).max() == 0.0
    assert abs(MeanPairs.between(pairs, pairs, way, opened * np.nan, least=0.0).interface.B - pairs.B).max() == 0.0
    steep = MeanPairs.between(pairs, pairs, way, opened, least=0.0).interface
    tilt = (steep.B - pairs.B)[:n].toarray() / np.where(pairs.B[n:].toarray(), pairs.B[n:].toarray(), np.inf)
    assert np.abs(tilt).max() == pytest.approx(0.05)

# SPDX-License-Identifier: BSD-3-Clause
"""Pairs kept instead of contact nodes: the same interface, and only where supports hold the bodies."""

from dataclasses import replace
from unittest.mock import Mock

import numpy as np
import pytest

from signorini.condense import condensed as module
from signorini.condense.response import ByNodes, ByPairs
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve
from signorini.gallery.cubes import cubes
from signorini.linalg import NotPositiveDefinite

MODELS = {"matching": lambda: cubes(3), "not matching": lambda: cubes(4, 3)}


def by_nodes(monkeypatch, model):
    with monkeypatch.context() as patch:
        patch.setattr(module, "takes_borders", lambda _: False)
        return prepare(model)


@pytest.mark.parametrize("name", MODELS)
def test_both_ways_give_the_same_interface(monkeypatch, name):
    model = MODELS[name]()
    pairs, nodes = prepare(model), by_nodes(monkeypatch, model)
    assert isinstance(pairs.condensed.response, ByPairs)
    assert isinstance(nodes.condensed.response, ByNodes)
    few = np.arange(len(pairs.interface)) % 3 > 0
    for one, two in ((pairs.condensed, nodes.condensed), (pairs.condensed.among(few), nodes.condensed.among(few))):
        rng = np.random.default_rng(2)
        f, (h, r, offset) = (
            rng.standard_normal(pairs.constraints.transform.shape[1]),
            rng.standard_normal((3, len(one.W))),
        )
        np.testing.assert_allclose(one.A, two.A, rtol=0, atol=1e-12 * np.abs(two.A).max())
        np.testing.assert_allclose(one.W, two.W, rtol=0, atol=1e-12)
        b = two.right_hand_side(two.reduce(f).load, offset)
        found = one.right_hand_side(one.reduce(f).load, offset)
        np.testing.assert_allclose(found, b, rtol=0, atol=1e-11 * np.abs(b).max())
        u = two.displacement(two.reduce(f), h, r, offset)
        np.testing.assert_allclose(
            one.displacement(one.reduce(f), h, r, offset), u, rtol=0, atol=1e-11 * np.abs(u).max()
        )


def test_bodies_that_contact_holds_keep_their_nodes():
    model = cubes(3)
    pressed = replace(model.supports[1], u=(0.018, 0.006, None))
    assert isinstance(prepare(model).condensed.response, ByPairs)
    assert isinstance(prepare(replace(model, supports=[model.supports[0], pressed])).condensed.response, ByNodes)


def test_what_moves_without_contact_is_condensed_by_its_nodes(monkeypatch):
    model = cubes(3)
    expected = solve(model).last

    monkeypatch.setattr(module, "keep_pairs", Mock(side_effect=NotPositiveDefinite(0)))
    assert isinstance(prepare(model).condensed.response, ByNodes)
    np.testing.assert_allclose(solve(model).last.displacement, expected.displacement, rtol=0, atol=1e-12)

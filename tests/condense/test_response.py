# SPDX-License-Identifier: BSD-3-Clause
"""Pairs kept instead of contact nodes: the same interface, held or floating."""

from dataclasses import replace
from unittest.mock import Mock

import numpy as np
import pytest

from signorini.condense import condensed as module
from signorini.condense.response import ByNodes, ByPairs
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve, solve_prepared
from signorini.gallery.cubes import cubes
from signorini.linalg import NotPositiveDefinite
from signorini.model.conditions import Load, Support


def floating(model):
    """The upper body, free to fall and to turn, pressed and pushed by a force on its top."""
    return replace(
        model,
        supports=[model.supports[0]],
        loads=[Load("upper.top", force=(0.001, 0.0, -0.01))],
    )


def guided(model):
    """The upper body, held along x alone."""
    return replace(model, supports=[model.supports[0], Support("upper.top", u=(0.018, None, None))])


MODELS = {
    "matching": lambda: cubes(3),
    "not matching": lambda: cubes(4, 3),
    "floating": lambda: floating(cubes(4, 3)),
    "sliding": lambda: replace(
        cubes(4, 3), supports=[cubes(1).supports[0], Support("upper.top", u=(0.018, None, None))]
    ),
}


def by_nodes(monkeypatch, model):
    with monkeypatch.context() as patch:
        patch.setattr(module, "takes_borders", lambda _: False)
        return prepare(model)


@pytest.mark.parametrize("name", MODELS)
def test_both_ways_give_the_same_interface(monkeypatch, name):
    model = MODELS[name]()
    pairs, nodes = prepare(model), by_nodes(monkeypatch, model)
    assert isinstance(pairs.paths.condensed.response, ByPairs)
    assert isinstance(nodes.paths.condensed.response, ByNodes)
    T, rng = pairs.constraints.transform, np.random.default_rng(2)
    few = np.arange(len(pairs.interface)) % 3 > 0
    for one, two in (
        (pairs.paths.condensed, nodes.paths.condensed),
        (pairs.paths.condensed.among(few), nodes.paths.condensed.among(few)),
    ):
        u, (r, offset) = rng.standard_normal(T.shape[1]), rng.standard_normal((2, 3, len(one.root)))
        B = (pairs.interface.B @ T)[pairs.interface.rows(one.active)]
        f = T.T @ (pairs.K @ (T @ u)) - B.T @ r.ravel()
        h = (B @ u).reshape(r.shape) + offset + one.compliance * r
        np.testing.assert_allclose(one.image.A, two.image.A, rtol=0, atol=1e-12 * np.abs(two.image.A).max())
        np.testing.assert_allclose(one.image.W, two.image.W, rtol=0, atol=1e-12)
        b = two.right_hand_side(two.reduce(f).load, offset)
        found = one.right_hand_side(one.reduce(f).load, offset)
        np.testing.assert_allclose(found, b, rtol=0, atol=1e-11 * np.abs(b).max())
        for way in (one, two):
            np.testing.assert_allclose(way.displacement(way.reduce(f), h, r, offset), u, rtol=0, atol=1e-10)


def test_tied_bodies_keep_their_nodes():
    model = cubes(3)
    tied = replace(model, contacts=[replace(model.contacts[0], friction="tied")])
    assert isinstance(prepare(model).paths.condensed.response, ByPairs)
    assert isinstance(prepare(tied).paths.condensed.response, ByNodes)


def test_a_floating_body_is_pressed_alike(monkeypatch):
    model = floating(cubes(4, 3))
    expected = solve_prepared(by_nodes(monkeypatch, model)).last
    found = solve(model).last
    assert found.certificate.passed
    size = np.abs(expected.displacement).max()
    np.testing.assert_allclose(found.displacement, expected.displacement, rtol=0, atol=1e-10 * size)


def test_what_moves_without_contact_is_condensed_by_its_nodes(monkeypatch):
    model = cubes(3)
    expected = solve(model).last

    monkeypatch.setattr(module, "keep_pairs", Mock(side_effect=NotPositiveDefinite(0)))
    assert isinstance(prepare(model).paths.condensed.response, ByNodes)
    np.testing.assert_allclose(solve(model).last.displacement, expected.displacement, rtol=0, atol=1e-12)

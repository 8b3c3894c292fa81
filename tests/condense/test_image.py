# SPDX-License-Identifier: BSD-3-Clause
"""The interface from its compliance and from its image form: the same, and W is formed only where it is asked for."""

from dataclasses import replace
from functools import cached_property

import numpy as np
import pytest

import signorini as sg
from signorini.condense.operator import InterfaceOperator, Single
from signorini.gallery.blocks import dragged_block, four_blocks
from signorini.gallery.cubes import cubes


def interface(seed, size=6, floats=2, locked=(2,)):
    """W and its rigid motions, with rows that supports lock."""
    rng = np.random.default_rng(seed)
    moving = np.setdiff1d(np.arange(size), locked)
    Q, _ = np.linalg.qr(rng.normal(size=(len(moving), len(moving))))
    values = np.append(np.ones(floats), rng.uniform(0.05, 0.95, len(moving) - floats))
    W, motions = np.zeros((size, size)), np.zeros((size, floats))
    W[np.ix_(moving, moving)] = (Q * values) @ Q.T
    motions[moving] = Q[:, :floats] @ rng.normal(size=(floats, floats))
    return (W + W.T) / 2, motions


@pytest.mark.parametrize("floats", [0, 1, 2, 4])
def test_the_compliance_gives_the_image_form_back(floats):
    W, motions = interface(0, floats=floats)
    posed = InterfaceOperator.of_form(W, motions)
    soft = InterfaceOperator.of_compliance(posed.A, motions, posed.R)
    x = np.random.default_rng(1).normal(size=len(W))
    np.testing.assert_allclose(soft.applied(x), W @ x, atol=1e-13)
    assert "W" not in soft.__dict__
    np.testing.assert_allclose(soft.W, W, atol=1e-13)
    np.testing.assert_allclose(soft.A @ posed.R, 0.0, atol=1e-12)


@pytest.mark.parametrize("seed", range(3))
def test_what_is_applied_does_not_know_what_was_made_before(seed):
    """A tree or a path forms the image; a history that is cut behind it and gone on with has not, and is the same."""
    W, motions = interface(seed)
    x, given = np.random.default_rng(1).normal(size=len(W)), InterfaceOperator.of_form(W, motions)
    for make in (
        lambda: InterfaceOperator.of_form(W, motions),
        lambda: InterfaceOperator.of_compliance(given.A, motions, given.R),
    ):
        used = make()
        _ = used.W, used.A, used.factor, used.single
        assert np.array_equal(used.applied(x), make().applied(x))
        assert np.array_equal(used.still, make().still)


@pytest.mark.parametrize("locked", [(0,), (2,), (1, 5)])
@pytest.mark.parametrize("seed", range(4))
def test_locked_rows_stay_exactly_zero(seed, locked):
    """Also those among the first, which the factorisation of the motions mixes with others but for rounding."""
    W, motions = interface(seed, floats=3, locked=locked)
    posed = InterfaceOperator.of_form(W, motions)
    for image in (posed, InterfaceOperator.of_compliance(posed.A, motions, posed.R)):
        assert np.flatnonzero(image.still).tolist() == list(locked)
        assert not image.W[list(locked)].any()


def test_what_far_pairs_feel_of_each_other_leaves_no_numbers_that_processors_are_slow_with():
    """As in a strip that its base holds: exp(-133) from end to end, which single precision does not know."""
    place = np.arange(400.0)
    A = np.exp(-np.abs(place[:, None] - place) / 3.0)
    single, x = Single.of(A, 0.1), np.random.default_rng(0).normal(size=len(A))
    assert np.abs(single.matrix).min() > 1e-19  # so that products are above 1e-38
    np.testing.assert_allclose(single.product(x), A @ x, atol=1e-5)
    np.testing.assert_allclose(single.solve(A @ x + 0.1 * x), x, atol=1e-4)


def followed_exactly():
    return replace(dragged_block(), steps=[sg.Step(scale={"press": 1.0}), sg.Step(scale={"push": 0.5})])


def in_space(**step):
    return replace(cubes(2), steps=[sg.Step(**step)])


@pytest.mark.parametrize(
    "make",
    [four_blocks, dragged_block, followed_exactly, in_space, lambda: in_space(increments=2), lambda: cubes(2)],
)
def test_what_is_solved_as_usual_forms_no_image_form(make, monkeypatch):
    """Compliance and its factor do: a third matrix of that size would be made and kept for nothing."""

    def formed(image):
        raise AssertionError(f"W of {len(image.R)} rows was formed")

    never = cached_property(formed)
    never.__set_name__(InterfaceOperator, "W")
    monkeypatch.setattr(InterfaceOperator, "W", never)
    assert sg.solve(make()).solved

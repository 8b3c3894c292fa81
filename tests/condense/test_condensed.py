# SPDX-License-Identifier: BSD-3-Clause
"""The condensed interface against dense equations of the whole body: held or floating, exact or compliant."""

from dataclasses import replace

import numpy as np
import pytest

from signorini.engine.prepare import prepare
from signorini.engine.solve import solve
from signorini.errors import InputError
from signorini.gallery.blocks import dragged_block, four_blocks
from signorini.gallery.cylinder import zhu_cylinder
from signorini.gallery.press_fit import press_fit


def with_compliance(model, compliance):
    contacts = [replace(c, normal_compliance=compliance, tangential_compliance=3 * compliance) for c in model.contacts]
    return replace(model, contacts=contacts)


def seen(prepared):
    """Rigid motions that supports leave, as the active pairs see them, scaled."""
    condensed, rows = prepared.paths.condensed, prepared.interface.rows(prepared.paths.condensed.active)
    return np.tile(condensed.root, 2)[:, None] * (prepared.interface.B @ prepared.motions @ prepared.floating)[rows]


FLOATING = [four_blocks, zhu_cylinder, dragged_block]
EXACT_TO_SOFT = [(make, c) for make in [press_fit, *FLOATING] for c in (0.0, 1e-16, 1e-6, 1e-2)]
SOFTER_AND_HELD = [(press_fit, 1e6), (press_fit, 1e16)]


@pytest.mark.parametrize(("make", "compliance"), EXACT_TO_SOFT + SOFTER_AND_HELD)
def test_the_image_form_is_equilibrium(make, compliance):
    """Any forces r and displacements u in equilibrium obey ``G h - W r = b`` with ``h = B u + C r + h_0``."""
    prepared = prepare(with_compliance(make(), compliance))
    condensed, interface, T = prepared.paths.condensed, prepared.interface, prepared.constraints.transform
    rows, rng = interface.rows(condensed.active), np.random.default_rng(1)
    u = rng.standard_normal(T.shape[1])
    r, offset = rng.standard_normal((2, 2, len(condensed.root)))
    B = (interface.B @ T).toarray()[rows]
    f = T.T @ prepared.K @ T @ u - B.T @ r.ravel()
    C = np.stack([interface.normal_compliance, interface.tangential_compliance]) / interface.area
    h = (B @ u).reshape(r.shape) + C[:, condensed.active] * r + offset
    b = condensed.right_hand_side(condensed.reduce(f).load, offset)
    H, R = (condensed.root * h).ravel(), (r / condensed.root).ravel()
    size = np.abs(b).max() + np.abs(H).max() + np.abs(R).max()
    np.testing.assert_allclose(H - condensed.image.W @ (H + R), b, rtol=0, atol=1e-11 * size)
    found = condensed.displacement(condensed.reduce(f), h, r, offset)
    np.testing.assert_allclose(found, u, rtol=0, atol=1e-8 * np.abs(u).max())


def test_the_interface_has_its_factor_in_the_memory_of_a_body():
    """As equilibrium, above, says, neither harms the other."""
    condensed = prepare(dragged_block()).paths.condensed
    (block,) = condensed.response.parts.blocks
    assert np.shares_memory(condensed.image.factor, block.upper)


@pytest.mark.parametrize(("make", "compliance"), EXACT_TO_SOFT + SOFTER_AND_HELD)
def test_the_spectrum_lies_between_0_and_1(make, compliance):
    """1 belongs to rigid motions alone, whatever the compliance: nothing becomes ill-conditioned."""
    prepared = prepare(with_compliance(make(), compliance))
    values, R = np.linalg.eigvalsh(prepared.paths.condensed.image.W), seen(prepared)
    assert values.min() > -1e-12
    assert values.max() < 1 + 1e-12
    np.testing.assert_allclose(prepared.paths.condensed.image.W @ R, R, rtol=0, atol=1e-11 * np.abs(R).max(initial=1.0))
    if compliance <= 1e-2:
        assert (values > 1 - 1e-9).sum() == R.shape[1]


@pytest.mark.parametrize("make", [four_blocks, dragged_block])
def test_a_compliance_that_hardly_holds_a_body_is_refused_in_words(make):
    with pytest.raises(InputError, match="contact: the compliance of the contacts is so large"):
        prepare(with_compliance(make(), 1e16))


@pytest.mark.parametrize("backend", ["superlu", "multifrontal"])
def test_back_ends_agree(backend):
    model = zhu_cylinder(refine=2)
    here, there = solve(model).last, solve(model, backend=backend).last
    np.testing.assert_allclose(there.contacts[0].pressure, here.contacts[0].pressure, rtol=0, atol=1e-9)
    np.testing.assert_allclose(there.displacement, here.displacement, rtol=0, atol=1e-11)


def test_a_pair_held_on_both_sides_is_left_out():
    """A pair that supports hold along its normal has no row; forces are found for the others."""
    model = zhu_cylinder(friction=0.0)
    held = model.mesh.points[model.mesh.nodes_of("arc")][1]
    support = replace(model.supports[0], on=tuple(held), u=(None, 0.0), name="pin")
    prepared = prepare(replace(model, supports=[*model.supports, support])).widened()
    for pairs in (prepared.paths.condensed.held, ~prepared.paths.condensed.active):
        assert prepared.interface.node[pairs].tolist() == [model.mesh.nodes_of("arc")[1]]
    assert len(prepared.paths.condensed.image.W) == 2 * (len(prepared.interface) - 1)


@pytest.mark.parametrize("factor", [1e-3, 1e-5, 1e-9])
def test_gaps_far_larger_than_the_displacements(factor):
    """An arc that leaves its foundation by its radius, under a load that moves it by less than a millionth of that."""
    model = zhu_cylinder(friction=0.0, force=156.0 * factor)
    certificate = solve(model).last.certificate
    assert certificate.passed

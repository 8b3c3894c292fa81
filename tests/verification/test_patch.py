# SPDX-License-Identifier: BSD-3-Clause
"""Patch tests P1, P2, P4: a uniform stress goes through interfaces exactly, whether their meshes match or not."""

from dataclasses import replace

import numpy as np
import pytest

from signorini.engine.solve import solve
from signorini.fem.space import make_space
from signorini.fem.stress import body_stresses
from signorini.gallery.blocks import block_on_foundation, four_blocks, stacked_blocks

EXACT = 1e-10

every_cell = pytest.mark.parametrize("cells", ["quad", "triangle", "quad8", "quad9", "triangle6"])
with_and_without_friction = pytest.mark.parametrize("friction", [0.0, 0.3])


def assert_uniform(history, expected, size):
    """Every nodal stress of every body has the components xx, yy, zz, xy."""
    model = history.model
    for body in body_stresses(make_space(model.mesh), model, history.last.displacement):
        for i, value in zip((0, 1, 2, 3), expected, strict=True):
            np.testing.assert_allclose(body.stress[:, i], value, rtol=0, atol=EXACT * size)


def assert_flat_contact(contact, pressure, length):
    np.testing.assert_allclose(contact.pressure, pressure, rtol=EXACT)
    np.testing.assert_allclose(contact.traction, 0.0, atol=EXACT * pressure)
    np.testing.assert_allclose(contact.gap, 0.0, atol=EXACT * length)
    assert contact.closed.all()


@every_cell
@with_and_without_friction
@pytest.mark.parametrize("across", [(4, 4), (4, 7)])
def test_stacked_blocks(cells, friction, across):
    history = solve(stacked_blocks(friction=friction, cells=cells, across=across))
    contact = history.contact("interface")
    assert_flat_contact(contact, 1e5, 0.1)
    np.testing.assert_allclose(history.last.displacement[contact.node, 1], -0.05, rtol=EXACT)
    np.testing.assert_allclose(history.last.displacement[:, 1], -0.05 * history.model.mesh.points[:, 1], atol=1e-12)
    assert_uniform(history, (0.0, -1e5, 0.0, 0.0), 1e5)


@every_cell
@pytest.mark.parametrize(("across", "swap"), [((3, 3), False), ((2, 3), False), ((4, 3), True)])
def test_block_on_foundation(cells, across, swap):
    model = block_on_foundation(friction=0.3, cells=cells, across=across)
    if swap:
        seat = replace(model.contacts[0], nonmortar="foundation.seat", mortar="block.bottom")
        model = replace(model, contacts=[seat])
    history = solve(model)
    E, nu = 2000.0, 0.3
    strain = -25.0 * (1 - nu**2) / E, 25.0 * nu * (1 + nu) / E  # yy and xx in plane strain, free sideways
    contact = history.contact("interface")
    assert_flat_contact(contact, 25.0, 0.01)
    x, y = history.model.mesh.points.T
    np.testing.assert_allclose(history.last.displacement[:, 1], strain[0] * y, atol=EXACT)
    np.testing.assert_allclose(history.last.displacement[:, 0], strain[1] * (x - 1.0), atol=EXACT)
    assert_uniform(history, (0.0, -25.0, -25.0 * nu, 0.0), 25.0)


@every_cell
@pytest.mark.parametrize("across", [(3, 3, 3, 3), (2, 3, 4, 5)])
def test_four_blocks(cells, across):
    history = solve(four_blocks(cells=cells, across=across))
    for contact, pressure in zip(history.last.contacts, (10.0, 10.0, 20.0, 20.0), strict=True):
        assert_flat_contact(contact, pressure, 0.1)
    assert_uniform(history, (-10.0, -20.0, 0.3 * -30.0, 0.0), 20.0)
    x, y = history.model.mesh.points.T
    E, nu = 1000.0, 0.3
    xx, yy = ((1 - nu**2) * s - nu * (1 + nu) * t for s, t in ((-10.0, -20.0), (-20.0, -10.0)))
    np.testing.assert_allclose(history.last.displacement, np.column_stack([xx * x, yy * y]) / E, atol=EXACT)


@pytest.mark.parametrize("cells", ["quad8", "triangle6"])
@pytest.mark.parametrize("across", [(4, 7), (5, 3)])
def test_quadratic_sides_need_mortar(cells, across):
    """Patch test P5: on quadratic sides that do not match nodes on facets fail where mortar is exact."""
    model = stacked_blocks(friction=0.3, cells=cells, across=across)
    simple = replace(model, contacts=[replace(model.contacts[0], coupling="node-to-segment")])
    wrong, right = (solve(each).contact("interface").pressure / 1e5 - 1.0 for each in (simple, model))
    assert np.abs(wrong).max() > 1e-2
    assert np.abs(right).max() < EXACT

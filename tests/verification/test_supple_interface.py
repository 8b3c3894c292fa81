# SPDX-License-Identifier: BSD-3-Clause
"""Supports that hold both sides of a contact: only the interface gives way, by its compliance."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg

BACKENDS = ("multifrontal", "superlu", "iterative")
COMPLIANCE, OVERLAP, DRAG, FRICTION = 1e-4, 0.01, 0.002, 0.3


def held_blocks(*, solid=False, friction=0.0, drag=0.0, scale=1.0, compliance=COMPLIANCE):
    """Two blocks, all nodes of their sides held; the upper one is driven into the lower one, and along it."""
    d = 3 if solid else 2
    x = np.linspace(0.0, 1.0, 3)
    block = sg.box(x=x, y=x, z=x) if solid else sg.rectangle(x=x, y=x)
    up = np.eye(d)[-1]
    upper = replace(block, points=block.points * (scale if solid else 1.0) + up)  # of another size: sides do not match
    sides = {"lower.bottom": 0.0, "lower.top": 0.0, "upper.bottom": 1.0, "upper.top": 1.0}
    along = np.eye(d)[0] * drag - up * OVERLAP
    return sg.Model(
        sg.join({"lower": block, "upper": upper}),
        bodies=[sg.Body(name, sg.Elastic(E=1e3, nu=0.3)) for name in ("lower", "upper")],
        supports=[sg.Support(name, u=tuple(part * along)) for name, part in sides.items()],
        contacts=[
            sg.Contact("upper.bottom", "lower.top", name="c", friction=friction, normal_compliance=compliance),
        ],
    )


@pytest.mark.parametrize("friction", [0.0, FRICTION])
@pytest.mark.parametrize(("solid", "backend"), [(False, "auto"), *((True, name) for name in BACKENDS)])
def test_the_pressure_is_the_overlap_over_the_compliance(solid, backend, friction):
    contact = sg.solve(held_blocks(solid=solid, friction=friction, scale=0.6), backend=backend).contact("c")
    np.testing.assert_allclose(contact.pressure, OVERLAP / COMPLIANCE, rtol=1e-7)
    np.testing.assert_allclose(contact.traction, 0.0, atol=1e-5)


@pytest.mark.parametrize(("solid", "backend"), [(False, "auto"), *((True, name) for name in BACKENDS)])
def test_what_is_dragged_rubs(solid, backend):
    model = held_blocks(solid=solid, friction=FRICTION, drag=DRAG)
    contact = sg.solve(model, backend=backend).contact("c")
    rubs = np.linalg.norm(np.atleast_2d(contact.traction.T), axis=0)
    np.testing.assert_allclose(rubs, FRICTION * OVERLAP / COMPLIANCE, rtol=1e-6)
    assert contact.tangential_force[0] < 0.0
    assert set(contact.status) == {"slip"}


def test_without_compliance_no_force_can_part_them():
    with pytest.raises(sg.SolveFailed, match="no way out"):
        sg.solve(held_blocks(compliance=0.0))

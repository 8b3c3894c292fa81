# SPDX-License-Identifier: BSD-3-Clause
"""Bodies wholly rigid and held by contact alone: the limit of ever stiffer ones, and statics where nothing deforms."""

import numpy as np
import pytest

import signorini as sg
from signorini.engine.examine import examine

ELASTIC = sg.Elastic(E=1000.0, nu=0.3)


def boxes(dimension: int, **bodies: tuple[list[float], list[float]]) -> sg.Mesh:
    """Bodies from their coordinates along the contact and across it."""
    if dimension == 2:
        return sg.join({name: sg.rectangle(x=along, y=up) for name, (along, up) in bodies.items()})
    return sg.join({name: sg.box(x=along, y=along, z=up) for name, (along, up) in bodies.items()})


def punched(dimension: int, narrow: list[float], *, modulus: float | None) -> sg.Model:
    """A block that a punch presses on and drags; without a modulus the punch is rigid."""
    mesh = boxes(dimension, block=([0.0, 1.0, 2.0, 3.0], [-1.0, -0.5, 0.0]), punch=(narrow, [0.0, 0.5, 1.0]))
    push = (0.4, 0.2, -5.0) if dimension == 3 else (0.4, -5.0)
    centre = 0.5 * (narrow[0] + narrow[-1])
    rigid = sg.RigidBody("rigid", "punch", (*[centre] * (dimension - 1), 1.0))
    onto_rigid = sg.Load("rigid", force=push + (0.0,) * (3 if dimension == 3 else 1))
    return sg.Model(
        mesh,
        kind="3d" if dimension == 3 else "plane strain",
        bodies=[sg.Body("block", ELASTIC), sg.Body("punch", sg.Elastic(E=modulus or 7.0, nu=0.3))],
        supports=[sg.Support("block.bottom", u=(0.0,) * dimension)],
        rigid_bodies=[] if modulus else [rigid],
        loads=[sg.Load("punch.top", force=push)] if modulus else [onto_rigid],
        contacts=[sg.Contact("punch.bottom", "block.top", friction=0.3)],
        steps=[sg.Step(increments=1)],
    )


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("narrow", [[1.0, 2.0], [0.6, 1.45, 2.3]], ids=["on nodes", "between nodes"])
def test_a_rigid_punch_is_the_limit_of_stiff_ones(dimension, narrow):
    rigid = sg.solve(punched(dimension, narrow, modulus=None)).last.contacts[0]
    stiff = sg.solve(punched(dimension, narrow, modulus=1e9)).last.contacts[0]
    assert np.abs(rigid.pressure - stiff.pressure).max() < 1e-4 * stiff.pressure.max()
    assert np.abs(rigid.traction - stiff.traction).max() < 1e-4 * stiff.pressure.max()


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("ground", ["plane", "rigid body", "held block"])
@pytest.mark.parametrize("backend", ["auto", "iterative"])
def test_statics_where_nothing_deforms(dimension, ground, backend):
    """Resultant and moment of the pressures are those of the load; what the pressures are one by one is open."""
    d = dimension
    mesh = boxes(d, a=([0.0, 3.0], [-1.0, 0.0]), b=([0.0, 0.5, 1.0], [0.0, 1.0]))
    rigid, supports, other = [sg.RigidBody("b", "b", (0.5,) * d)], [], "a.top"
    if ground == "plane":
        other = sg.Plane(point=(0.0,) * d, normal=(0.0,) * (d - 1) + (1.0,))
    if ground == "rigid body":
        rigid.append(sg.RigidBody("a", "a", (0.0,) * d))
        supports = [sg.Support("a", u=(0.0,) * (6 if d == 3 else 3))]
    else:
        supports = [sg.Support(f"a.{side}", u=(0.0,) * d) for side in ("bottom", "top")]
    solution = sg.solve(
        sg.Model(
            mesh,
            kind="3d" if d == 3 else "plane strain",
            bodies=[sg.Body(name, ELASTIC) for name in "ab"],
            supports=supports,
            rigid_bodies=rigid,
            loads=[sg.Load("b", force=(0.1,) * (d - 1) + (-1.0,) + (0.0,) * (3 if d == 3 else 1))],
            contacts=[sg.Contact("b.bottom", other, friction=0.3)],
            steps=[sg.Step(increments=1)],
        ),
        backend=backend,
    )
    pressing = solution.last.contacts[0]
    forces = pressing.pressure * pressing.area
    assert forces.sum() == pytest.approx(1.0, abs=1e-12)
    # the force at (1/2, 1/2) that pushes by a tenth goes through the ground at 0.55
    assert forces @ pressing.points[:, : d - 1] == pytest.approx(np.full(d - 1, 0.55), abs=1e-12)


def test_parts_that_are_held_are_at_rest_in_motions_of_the_others():
    """Of a stack whose top alone floats; rounding here became springs on what supports hold."""
    mesh = boxes(
        2, a=([0.0, 1.0, 2.0, 3.0], [-1.0, 0.0]), b=([0.5, 1.2, 2.5], [0.0, 1.0]), c=([0.5, 1.6, 2.5], [1.0, 2.0])
    )
    model = sg.Model(
        mesh,
        bodies=[sg.Body(name, ELASTIC) for name in "abc"],
        supports=[sg.Support("a.bottom", u=(0, 0))],
        rigid_bodies=[sg.RigidBody("rigid", "b.bottom", (1.5, 0.5))],
        loads=[sg.Load("c.top", force=(0.5, -5.0))],
        contacts=[
            sg.Contact("b.bottom", "a.top", friction="tied", name="lower"),
            sg.Contact("c.bottom", "b.top", friction=0.4, name="upper"),
        ],
        steps=[sg.Step(increments=1)],
    )
    examined = examine(model)
    top = np.array([part.label == "body 'c'" for part in examined.parts]).repeat([p.motions for p in examined.parts])
    assert examined.floating.shape[1] == 3
    assert not examined.floating[~top].any()
    assert sg.solve(model).last.certificate.worst < 1e-12


def test_a_body_that_equations_make_rigid_does_not_feel_its_modulus():
    """All its nodes move alike: rounding of its stiffness gave another answer, and a length that excused it."""
    mesh = boxes(2, a=([0.0, 0.75, 1.5, 2.25, 3.0], [-1.0, -0.5, 0.0]), b=([0.6, 1.1, 1.7, 2.3], [0.0, 0.5, 1.0]))
    first, *others = mesh.labels[15:].tolist()
    alike = [sg.Equation([(node, axis, 1.0), (first, axis, -1.0)]) for node in others for axis in "xy"]
    found = []
    for modulus in (1.0, 1e3, 1e7):
        model = sg.Model(
            mesh,
            bodies=[sg.Body("a", ELASTIC), sg.Body("b", sg.Elastic(E=modulus, nu=0.3))],
            supports=[sg.Support("a.bottom", u=(0, 0))],
            equations=alike,
            loads=[sg.Load("b.top", force=(0.5, -5.0))],
            contacts=[sg.Contact("b.bottom", "a.top", friction=0.3)],
            steps=[sg.Step(increments=1)],
        )
        found.append(sg.solve(model).last.contacts[0].pressure)
    np.testing.assert_allclose(found, [found[2]] * 3, rtol=1e-6, atol=1e-6)

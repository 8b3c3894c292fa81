# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that yield under contacts that slide far: pairs follow, and every stride is an increment of the flow."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.gallery.rolled_beds import rolled_bed

E, NU = 1000.0, 0.3


@pytest.mark.slow
def test_a_wheel_leaves_a_track_that_the_next_pass_adds_less_to() -> None:
    """Above first yield and below shakedown; every stride is certified, forces balance, energies close."""
    steps = sg.solve(rolled_bed(3.7, n=4, run=0.5, strokes=2)).steps
    force = 0.5 * np.pi * 3.7
    pressed, there, back = (step.plastic.dissipation for step in steps[1:] if step.plastic is not None)
    assert there > 0.1 * pressed > 0.0
    assert back < 0.3 * there
    for step in steps[2:]:
        contact = step.contacts[0]
        assert float(contact.pressure @ contact.area) == pytest.approx(force, rel=1e-3)
        assert abs(step.energy_defect) < 0.02 * force * step.yielding.largest
        assert sum(instant.what == "handover" for instant in step.instants) > 4


def test_what_does_not_yield_slides_as_elastic_bodies_do() -> None:
    model, ends = rolled_bed(1.0, n=4, run=0.25, strokes=1), []
    for law in (None, sg.Plastic(100.0)):
        bodies = [sg.Body(body.name, sg.Elastic(E=E, nu=NU, plastic=law), "mean dilatation") for body in model.bodies]
        ends.append(sg.solve(replace(model, bodies=bodies)).last)
    elastic, strong = ends
    assert strong.yielding.largest == 0.0
    np.testing.assert_allclose(strong.displacement, elastic.displacement, rtol=0.0, atol=1e-9)
    assert strong.contacts[0].pressure == pytest.approx(elastic.contacts[0].pressure, abs=1e-6)


LINEAR = sg.Plastic(1.0, hardening=20.0)
PRESS, DRAG = {"press": 1.0, "drag": 0.0}, {"press": 1.0, "drag": 1.0}


def dragged(kind: str, *, pressure: float = 0.9, increments: int = 1) -> sg.Model:
    """A block that yields is pressed on a bed that yields, with friction, and dragged by most of an element.

    Parameters
    ----------
    kind : of the model
    pressure : mean
    increments : of the way
    """
    x, bed, high = np.linspace(0.0, 1.0, 4), np.linspace(-0.5, 2.0, 8), np.linspace(0.0, 0.5, 3)
    across: tuple[float | None, ...] = ()
    if kind == "3d":
        parts = {"top": sg.box(x=x, y=high, z=high), "bed": sg.box(x=bed, y=high, z=high - 0.5)}
        across = (0.0,)
    else:
        parts = {"top": sg.rectangle(x=x, y=high), "bed": sg.rectangle(x=bed, y=high - 0.5)}
    sides = [f"{body}.{side}" for body in parts for side in ("front", "back")] if across else []
    force = ("free", *("free" for _ in across), -pressure * (0.5 if across else 1.0))
    return sg.Model(
        mesh=sg.join(parts),
        kind=kind,
        bodies=[sg.Body(name, sg.Elastic(E=E, nu=NU, plastic=LINEAR)) for name in parts],
        supports=[
            sg.Support("bed.bottom", u=(0.0, *across, 0.0)),
            sg.Support("top.top", u=(0.3, *across, "free"), name="drag"),
            *(sg.Support(side, u=(None, 0.0, None)) for side in sides),
        ],
        loads=[sg.Load(on="top.top", force=force, spread="displacement", name="press")],
        contacts=[sg.Contact("top.bottom", "bed.top", friction=0.3, sliding="finite", name="sole")],
        steps=[sg.Step(scale=PRESS, increments=1), sg.Step(scale=DRAG, increments=increments)],
    )


def hub(increments: int) -> sg.Model:
    """A ring that yields is shrunk on a shaft and driven along it, with friction."""
    shaft = sg.rectangle(x=np.linspace(0.5, 1.0, 4), y=np.linspace(0.0, 3.0, 13))
    ring = sg.rectangle(x=np.linspace(0.998, 1.6, 4), y=np.linspace(0.5, 1.3, 4))
    steel = sg.Elastic(E=E, nu=NU)
    return sg.Model(
        mesh=sg.join({"shaft": shaft, "hub": ring}),
        kind="axisymmetric",
        bodies=[sg.Body("shaft", steel), sg.Body("hub", replace(steel, plastic=sg.Plastic(1.0, hardening=10.0)))],
        supports=[sg.Support("shaft.bottom", u=(None, 0.0)), sg.Support("hub.right", u=(None, 0.3), name="drag")],
        contacts=[sg.Contact("hub.left", "shaft.right", friction=0.2, sliding="finite", name="fit")],
        steps=[sg.Step(scale={"drag": 0.0}, increments=2), sg.Step(increments=increments)],
    )


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["plane strain", "plane stress", "3d", "axisymmetric"])
def test_meshed_sides_that_yield_slide_with_friction(kind: str) -> None:
    """Friction is that of the pressure, and energies close as increments are made finer, in first order."""
    friction, missed = (0.2 if kind == "axisymmetric" else 0.3), []
    for increments in (6, 24):
        steps = sg.solve(hub(increments) if kind == "axisymmetric" else dragged(kind, increments=increments)).steps
        drag, contact = steps[-1], steps[-1].contacts[0]
        pressed = float(contact.pressure @ contact.area)
        assert np.linalg.norm(contact.tangential_force) == pytest.approx(friction * pressed, rel=1e-2)
        assert drag.certificate.passed
        assert drag.yielding.largest > 1e-4
        assert sum(instant.what == "handover" for instant in drag.instants) > 2
        missed.append(abs(drag.energy_defect) / drag.work)
    assert missed[1] < 0.4 * missed[0] < 0.04


def test_what_wears_does_not_yield() -> None:
    model = dragged("plane strain")
    with pytest.raises(
        sg.InputError, match="wear: is given, but 'top' yields; expected elastic bodies where sides wear"
    ):
        replace(model, contacts=[replace(model.contacts[0], wear=sg.Wear(1e-3))])


def test_bodies_that_may_turn_do_not_yield() -> None:
    block, bed = sg.rectangle(width=1.0, nx=2, ny=2), sg.rectangle(width=3.0, nx=6, ny=2, origin=(-1.0, -1.0))
    steel = sg.Elastic(E=E, nu=NU, plastic=sg.Plastic(1.0))
    model = sg.Model(
        mesh=sg.join({"block": block, "bed": bed}),
        kind="plane strain",
        bodies=[sg.Body("block", steel), sg.Body("bed", sg.Elastic(E=E, nu=NU))],
        supports=[sg.Support("bed.bottom", u=(0.0, 0.0))],
        loads=[sg.Load("block.top", pressure=0.1)],
        contacts=[sg.Contact("block.bottom", "bed.top", friction=0.3, sliding="finite", name="c")],
    )
    with pytest.raises(sg.InputError, match=r"contact\[0\].sliding: is \"finite\", a body yields and one may turn"):
        sg.solve(model)

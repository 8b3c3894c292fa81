# SPDX-License-Identifier: BSD-3-Clause
"""What goes with contacts that slide far: other laws, ties and contacts beside them, changes between steps, heat."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg

pytestmark = pytest.mark.slow

STEEL = sg.Elastic(E=200.0, nu=0.3, expansion=1e-5)


def block_on_bed(*, at: float = 0.0, **contact: object) -> sg.Model:
    """A block of 1 x 0.5 that a force of 1 presses on a bed, dragged by 0.4; the bed is tied to a base."""
    top = sg.rectangle(x=at + np.linspace(0.0, 1.0, 5), y=np.linspace(0.0, 0.5, 3))
    bed = sg.rectangle(x=np.linspace(-0.5, 2.0, 9), y=np.linspace(-0.5, 0.0, 3))
    base = sg.rectangle(x=np.linspace(-0.5, 2.0, 6), y=np.linspace(-1.0, -0.5, 3))
    return sg.Model(
        mesh=sg.join({"top": top, "bed": bed, "base": base}),
        kind="plane strain",
        bodies=[sg.Body(name, STEEL) for name in ("top", "bed", "base")],
        supports=[
            sg.Support("base.bottom", u=(0.0, 0.0)),
            sg.Support("top.top", u=(0.4, "free"), name="drag"),
        ],
        loads=[sg.Load(on="top.top", force=("free", -1.0), spread="displacement", name="press")],
        contacts=[
            sg.Contact("top.bottom", "bed.top", **{"friction": 0.3, "sliding": "finite", "name": "sole", **contact}),
            sg.Contact("bed.bottom", "base.top", friction="tied", name="tie"),
        ],
        steps=[
            sg.Step(name="press", scale={"press": 1.0, "drag": 0.0}),
            sg.Step(name="drag", scale={"press": 1.0, "drag": 1.0}),
        ],
    )


def resultants(step: sg.StepResult) -> tuple[float, float]:
    """Normal and tangential force of the sole."""
    contact = step.contacts[0]
    return float(contact.pressure @ contact.area), abs(float(contact.traction @ contact.area))


def test_a_tie_beside_it_goes_along() -> None:
    drag = sg.solve(block_on_bed()).last
    assert resultants(drag) == pytest.approx((1.0, 0.3), rel=2e-3)
    assert drag.certificate.passed
    tie = drag.contacts[1]
    assert tie.tangential_force[0] == pytest.approx(-drag.reactions["drag"][0], rel=1e-10)
    # directions of pairs stand for those of their facets, which the corners of the block bend
    assert tie.tangential_force[0] == pytest.approx(drag.contacts[0].tangential_force[0], rel=3e-3)


@pytest.mark.parametrize(
    ("law", "bound"),
    [
        ({"shear_limit": 0.2}, lambda p: np.minimum(0.3 * p, 0.2)),
        ({"adhesion": 0.05}, lambda p: 0.05 + 0.3 * p),
    ],
)
def test_limits_of_the_shear_and_adhesion_hold_at_every_pair(law: dict[str, float], bound: object) -> None:
    drag = sg.solve(block_on_bed(**law)).last
    contact = drag.contacts[0]
    assert (contact.status == "slip").any()
    slips = contact.status == "slip"
    assert np.abs(contact.traction)[slips] == pytest.approx(bound(contact.pressure[slips]), rel=1e-9)


def test_a_contact_beside_it_stays_where_it_is() -> None:
    """The tie gives way to friction of its own, with small slips."""
    model = block_on_bed()
    beside = replace(model.contacts[1], friction=0.9)
    drag = sg.solve(replace(model, contacts=[model.contacts[0], beside])).last
    assert resultants(drag) == pytest.approx((1.0, 0.3), rel=2e-3)
    assert drag.certificate.passed


def test_it_may_be_switched_off_and_on() -> None:
    """Dragged off, let loose and switched on again it presses where it is, and rubs nothing."""
    model = block_on_bed()
    driven = sg.Support("top.top", u=(0.4, -0.004), name="drag")
    steps = [
        sg.Step(name="drag", scale={"drag": 1.0}),
        sg.Step(name="off", inactive=["sole"]),
        sg.Step(name="on", active=["sole"]),
    ]
    drag, off, on = sg.solve(replace(model, supports=[model.supports[0], driven], loads=[], steps=steps)).steps
    assert resultants(off) == (0.0, 0.0)
    normal, tangential = resultants(drag)
    assert tangential == pytest.approx(0.3 * normal, rel=1e-9)
    there = block_on_bed(at=0.4)
    pressed = sg.Support("top.top", u=(0.0, -0.004), name="press")
    fresh = replace(there, supports=[there.supports[0], pressed], loads=[], steps=[sg.Step(increments=1)])
    assert resultants(on)[0] == pytest.approx(resultants(sg.solve(fresh).last)[0], rel=0.01)
    assert resultants(on)[1] < 0.05 * tangential
    assert on.certificate.passed


def test_a_crown_goes_along_with_its_side() -> None:
    """An interference that varies over the nonmortar side belongs to its nodes, wherever they are."""

    def crowned(at: float) -> sg.Model:
        return block_on_bed(at=at, friction=0.0, interference=lambda x: -0.02 * (x[:, 0] - at - 0.5) ** 2)

    dragged = sg.solve(crowned(0.0)).last.contacts[0].pressure
    fresh = sg.solve(replace(crowned(0.4), steps=crowned(0.4).steps[:1])).last.contacts[0].pressure
    assert dragged == pytest.approx(fresh, abs=0.02 * fresh.max())


def test_friction_with_an_axis_turns_with_the_nonmortar_side() -> None:
    """Along the axis, across it and askew, where friction is against the normal of its ellipse."""
    top = sg.box(x=np.linspace(0.0, 1.0, 3), y=np.linspace(0.0, 1.0, 3), z=np.linspace(0.0, 0.6, 2))
    bed = sg.box(x=np.linspace(-0.5, 2.0, 6), y=np.linspace(-0.5, 2.0, 6), z=np.linspace(-0.6, 0.0, 2))
    for way, wanted in (
        ((0.4, 0.0), (0.3, 0.0)),
        ((0.0, 0.4), (0.0, 0.1)),
        ((0.3, 0.3), (0.09 / 0.1**0.5, 0.01 / 0.1**0.5)),
    ):
        model = sg.Model(
            mesh=sg.join({"top": top, "bed": bed}),
            bodies=[sg.Body("top", STEEL), sg.Body("bed", STEEL)],
            supports=[
                sg.Support("bed.bottom", u=(0.0, 0.0, 0.0)),
                sg.Support("top.top", u=(*way, "free"), name="drag"),
            ],
            loads=[sg.Load(on="top.top", force=("free", "free", -1.0), spread="displacement", name="press")],
            contacts=[
                sg.Contact(
                    "top.bottom", "bed.top", friction=(0.3, 0.1), friction_axis=(1.0, 0.0, 0.0), sliding="finite"
                )
            ],
            steps=[
                sg.Step(scale={"press": 1.0, "drag": 0.0}),
                sg.Step(scale={"press": 1.0, "drag": 1.0}, increments=4),
            ],
        )
        contact = sg.solve(model).last.contacts[0]
        assert np.linalg.norm(contact.normal_force) == pytest.approx(1.0, rel=2e-3)
        assert contact.tangential_force[:2] == pytest.approx(-np.array(wanted), abs=1e-3)


def test_what_does_not_go_with_models_that_slide_is_refused_by_name() -> None:
    model = block_on_bed()
    with pytest.raises(sg.InputError, match="wellposed: does not know contacts that slide far"):
        sg.solve(model, wellposed=True)
    with pytest.raises(sg.InputError, match="back end 'iterative' does not know contacts that slide far"):
        sg.prepare(model, backend="iterative")
    with pytest.raises(sg.InputError, match="coupling is 'node-to-segment'"):
        block_on_bed(coupling="node-to-segment")


@pytest.mark.parametrize("given", [{"gap": "zero"}, {"adjust": 0.1}, {"gap": 0.0}])
def test_a_gap_that_is_given_goes_along(given: dict[str, object]) -> None:
    """A sole that is drawn too high slides as one that is not; its gap is given where it is, at the beginning."""
    drawn = block_on_bed()
    points = drawn.mesh.points.copy()
    points[points[:, 1] > 1e-9, 1] += 0.05
    points[drawn.mesh.nodes_of("top.bottom"), 1] += 0.05
    lifted = block_on_bed(**given)
    one, two = (sg.solve(model).last for model in (drawn, replace(lifted, mesh=replace(lifted.mesh, points=points))))
    assert resultants(two) == pytest.approx(resultants(one), rel=1e-6)
    # normals that strain tilts cross the gap that is drawn
    assert two.work == pytest.approx(one.work, rel=1e-5)
    assert np.abs(two.displacement - one.displacement).max() < 1e-5 * np.abs(one.displacement).max()


def test_friction_that_is_lowered_lets_go_gradually() -> None:
    """What it held back fades away where sides hand over next, and what that sets free is no work of loads."""
    model = block_on_bed()
    *_, drag, oil = sg.solve(replace(model, steps=[*model.steps, sg.Step(name="oil", friction={"sole": 0.1})])).steps
    assert resultants(oil) == pytest.approx((1.0, 0.1), rel=2e-3)
    assert 0.0 < oil.released < oil.contacts[0].dissipation + drag.strain_energy - oil.strain_energy
    assert abs(oil.energy_defect) < 1e-12 * drag.work


def test_supports_let_go_beside_it() -> None:
    model = block_on_bed()
    stop = sg.Support("bed.left", u=(0.0, None), name="stop")
    steps = [*model.steps, sg.Step(name="let go", release=["stop"])]
    _, drag, loose = sg.solve(replace(model, supports=[*model.supports, stop], steps=steps)).steps
    assert resultants(drag) == pytest.approx((1.0, 0.3), rel=2e-3)
    normal, tangential = resultants(loose)
    assert normal == pytest.approx(1.0, rel=2e-3)
    assert 0.2 < tangential < 0.3 * normal
    assert loose.certificate.passed


def test_heat_beside_it() -> None:
    model = block_on_bed()
    warm = sg.Load("top", temperature=50.0, name="heat")
    steps = [model.steps[0], sg.Step(name="drag", scale={"press": 1.0, "drag": 1.0, "heat": 1.0})]
    drag = sg.solve(replace(model, loads=[*model.loads, warm], steps=steps)).last
    assert resultants(drag) == pytest.approx((1.0, 0.3), rel=2e-3)
    assert abs(drag.energy_defect) < 1e-9 * drag.work

# SPDX-License-Identifier: BSD-3-Clause
"""Energies of bodies that yield: nothing is left over without contact, and results say how far they have flowed."""

import numpy as np
import pytest

import signorini as sg

LAWS = {
    "perfect": sg.Plastic(2.0),
    "isotropic": sg.Plastic([(0.0, 2.0), (0.01, 2.5), (0.1, 3.0)], hardening=2.0),
    "kinematic": sg.Plastic(2.0, backstresses=[(10.0, 0.0)]),
    "combined": sg.Plastic(2.0, hardening=1.0, backstresses=[(50.0, 25.0), (5.0, 0.0)]),
}


def cycled(law, kind="plane strain", *, thermal=False, cells="quad8", **parts):
    """A plate drawn and sheared to and fro by its edge, a body that no contact touches; heated more on its one side."""
    material = sg.Elastic(E=200.0, nu=0.3, plastic=law, expansion=1e-3 if thermal else 0.0)
    loads = [sg.Load("block", temperature=lambda points: 2.0 * points[:, 0] ** 2, name="heat")] if thermal else []
    reverse = [{"edge": 1.0}, {"edge": 0.2}, {"edge": -1.0}, {"edge": 0.0}]
    heats = {"heat": 1.0} if thermal else {}
    return sg.Model(
        sg.rectangle(x=[1, 1.4, 2], y=[0, 0.5, 1], cells=cells),
        kind=kind,
        bodies=[sg.Body("block", material, **parts)],
        supports=[sg.Support("bottom", u=(0, 0)), sg.Support("top", u=(0.02, 0.03), name="edge")],
        loads=loads,
        steps=[sg.Step(scale=scale | (heats if i == 1 else {}), increments=2) for i, scale in enumerate(reverse)],
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("law", "kind"),
    [*((law, "plane strain") for law in LAWS), ("combined", "axisymmetric"), ("perfect", "plane stress")]
    + [("combined", "plane stress")],
)
def test_energies_of_a_body_balance(law, kind):
    law = LAWS[law]
    solution = sg.solve(cycled(law, kind))
    work = sum(abs(step.work) for step in solution.steps)
    assert solution.steps[0].yielding.first is not None
    assert solution.steps[2].yielding.first is not None
    for step in solution.steps:
        assert abs(step.energy_defect) <= 1e-9 * work
        assert step.plastic.dissipation >= 0.0
        if not law.backstresses:
            assert step.plastic.stored == 0.0
    assert sum(step.plastic.dissipation for step in solution.steps) > 0.1 * work


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["plane strain", "axisymmetric", "plane stress"])
@pytest.mark.parametrize("formulation", [None, "incompatible"])
def test_energies_balance_where_bodies_are_heated(formulation, kind):
    cells = "quad" if formulation else "quad8"
    solution = sg.solve(cycled(LAWS["combined"], kind, thermal=True, formulation=formulation, cells=cells))
    work = sum(abs(step.work) for step in solution.steps)
    for step in solution.steps:
        assert abs(step.energy_defect) <= 1e-9 * work


def test_prager_stores_its_share_of_a_bar():
    """Of a bar drawn to the plastic strain e back stresses hold ``C e^2 / 2`` of the work ``Y e + C e^2 / 2``."""
    law, e = sg.Plastic(2.0, backstresses=[(10.0, 0.0)]), 0.05
    model = sg.Model(
        sg.rectangle(width=2.0, height=1.0),
        kind="plane stress",
        bodies=[sg.Body("block", sg.Elastic(E=200.0, nu=0.3, plastic=law))],
        supports=[sg.Support("left", u=(0, None)), sg.Support("bottom", u=(None, 0))],
        loads=[sg.Load("right", traction=(2.0 + 10.0 * e, 0.0))],
    )
    (step,) = sg.solve(model).steps
    assert step.plastic.stored == pytest.approx(2.0 * 10.0 * e**2 / 2, rel=1e-8)
    assert step.plastic.dissipation == pytest.approx(2.0 * (2.0 * e + 10.0 * e**2 / 2), rel=1e-8)
    assert step.yielding.first == pytest.approx(2.0 / 2.5, rel=1e-9)
    assert step.yielding.largest == pytest.approx(e, rel=1e-8)
    assert step.yielding.share == pytest.approx(1.0)
    assert step.strain_energy == pytest.approx(2.0 * 2.5**2 / 400.0, rel=1e-8)
    assert any("plastic strains of up to 5%" in note for note in step.notes) == (step.yielding.largest > 0.05)


def test_flow_that_lower_friction_sets_off_is_no_energy_set_free():
    model = sg.Model(
        sg.rectangle(x=np.linspace(0, 1, 5), y=np.linspace(0, 2, 9)),
        bodies=[sg.Body("block", sg.Elastic(E=200.0, nu=0.3, plastic=sg.Plastic(2.0, hardening=1.0)))],
        supports=[sg.Support("top", u=(0.0, 0.0))],
        loads=[sg.Load("right", traction=(0.62, 0), name="push")],
        obstacles=[sg.Rigid("floor", sg.Plane((0, 0), (0, 1)), u=(0, 0.008))],
        contacts=[sg.Contact("bottom", "floor", friction=0.8, name="foot")],
        steps=[sg.Step(increments=8), sg.Step(friction={"foot": 0.01})],
    )
    step = sg.solve(model).last
    assert step.plastic.dissipation > 0.5 * step.work
    assert 0.0 < step.released < step.work
    assert abs(step.energy_defect) <= 1e-9 * step.work
    assert step.increments <= 4, "loads do not change behind the slip"

# SPDX-License-Identifier: BSD-3-Clause
"""Contacts that slide far: pairs follow the bodies from stride to stride on one factorisation."""

from __future__ import annotations

from dataclasses import replace
from math import pi
from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.gallery import sliding as gallery
from signorini.gallery.sliding import PRESSING, dragged_cylinder
from signorini.linalg import registry
from signorini.output.archive import read_archive

STEEL = sg.Elastic(E=200.0, nu=0.3)


def block_on_bed(
    stroke: float,
    *,
    sliding: str = "finite",
    friction: float = 0.3,
    nonmortar: str = "top.bottom",
    back: bool = False,
) -> sg.Model:
    """A block of 2 x 1 that is pressed on a bed from -1 to 3 and dragged along it."""
    top = sg.rectangle(x=np.linspace(0.0, 2.0, 9), y=np.linspace(0.0, 1.0, 4))
    bed = sg.rectangle(x=np.linspace(-1.0, 3.0, 14), y=np.linspace(-1.0, 0.0, 4))
    mortar = "bed.top" if nonmortar == "top.bottom" else "top.bottom"
    ways: dict[str, float | list[float]] = {"press": 1.0, "drag": [1.0, 0.0] if back else 1.0}
    return sg.Model(
        mesh=sg.join({"top": top, "bed": bed}),
        kind="plane strain",
        bodies=[sg.Body("top", STEEL), sg.Body("bed", STEEL)],
        supports=[sg.Support("bed.bottom", u=(0.0, 0.0)), sg.Support("top.top", u=(stroke, "free"), name="drag")],
        loads=[sg.Load(on="top.top", force=("free", -1.0), spread="displacement", name="press")],
        contacts=[sg.Contact(nonmortar, mortar, friction=friction, sliding=sliding, coupling="mortar", name="c")],
        steps=[sg.Step(name="press", scale={"press": 1.0, "drag": 0.0}), sg.Step(name="drag", scale=ways)],
    )


def wheel_on_bed(stroke: float, *, rolls: bool) -> sg.Model:
    """A rigid wheel of radius 10 under a force of 10, on a bed that moves away under it."""
    fine = np.arange(-1.6, stroke + 1.6, 0.1)
    far = np.array([0.4, 1.0, 2.0, 3.5, 6.0])
    x = np.concatenate([fine[0] - far[::-1], fine, fine[-1] + far])
    bed = sg.rectangle(x=x, y=np.concatenate([-0.8 - far[::-1], np.linspace(-0.8, 0.0, 9)]))
    wheel = sg.Rigid(
        "wheel", sg.Circle((0.0, 10.0), 10.0), u=(0.0, None), force=(None, -10.0), rotation=None if rolls else 0.0
    )
    return sg.Model(
        mesh=bed,
        kind="plane strain",
        bodies=[sg.Body(next(iter(bed.bodies)), STEEL)],
        supports=[sg.Support("bottom", u=(-stroke, 0.0), name="drag")],
        obstacles=[wheel],
        contacts=[sg.Contact("top", "wheel", friction=0.3, sliding="finite", name="c")],
        steps=[sg.Step(scale={"wheel": 1.0, "drag": 0.0}), sg.Step(scale={"wheel": 1.0, "drag": 1.0})],
    )


def of_contact(instant: sg.Instant) -> tuple[float, float]:
    """Normal and tangential force of the contact of a model in the plane."""
    contact = instant.contacts[0]
    return float(contact.pressure @ contact.area), float(contact.traction @ contact.area)


@pytest.mark.slow
def test_a_dragged_cylinder_keeps_hertz_pressure_and_coulombs_force(monkeypatch: pytest.MonkeyPatch) -> None:
    """Half a half-width and more of sliding: pressure 1 % of Hertz's, Q = mu P to rounding, energy to rounding."""
    counted = []
    solve = registry.factorise
    monkeypatch.setattr("signorini.condense.condensed.factorise", lambda *a, **k: counted.append(1) or solve(*a, **k))
    solution = sg.solve(dragged_cylinder(stroke=1.0, spacing=0.2))
    assert len(counted) == 1
    peak = 2.0 * PRESSING / pi
    drag = solution.steps[-1]
    handed = [instant for instant in drag.instants if instant.what == "handover"]
    assert len(handed) > 15
    for instant in handed[4:]:
        normal, tangential = of_contact(instant)
        assert abs(instant.contacts[0].pressure.max() / peak - 1.0) < 0.01
        assert abs(tangential) == pytest.approx(0.3 * normal, rel=1e-12)
    spent = drag.contacts[0].dissipation
    assert abs(drag.energy_defect) < 1e-12 * drag.work
    assert abs(drag.released) < 1e-6 * spent
    # as long a way under as large a force; it begins to slip only when the bodies have given way
    assert spent == pytest.approx(0.3 * PRESSING * 1.0, rel=0.08)


@pytest.mark.parametrize("nonmortar", ["top.bottom", "bed.top"])
def test_short_slips_are_those_of_pairs_that_stay(nonmortar: str) -> None:
    """Below a tenth of a facet both say the same, to what bodies strain."""
    small, finite = (
        sg.solve(block_on_bed(0.02, sliding=sliding, nonmortar=nonmortar)) for sliding in ("small", "finite")
    )
    one, two = (of_contact(of.steps[-1].instants[-1]) for of in (small, finite))
    assert two == pytest.approx(one, rel=2e-3)
    spent = [of.steps[-1].contacts[0].dissipation for of in (small, finite)]
    assert spent[1] == pytest.approx(spent[0], rel=5e-3)


@pytest.mark.slow
@pytest.mark.parametrize("nonmortar", ["top.bottom", "bed.top"])
def test_a_block_is_pushed_over_the_edge_of_its_bed(nonmortar: str) -> None:
    """Nine tenths of its length beyond the edge all is borne by what is left, and the force of friction stays."""
    solution = sg.solve(block_on_bed(1.8, nonmortar=nonmortar))
    last = solution.steps[-1].instants[-1]
    normal, tangential = of_contact(last)
    assert normal == pytest.approx(1.0, rel=2e-3)
    assert abs(tangential) == pytest.approx(0.3 * normal, rel=1e-12)
    contact, moved = last.contacts[0], solution.steps[-1].displacement
    where = contact.points[:, 0] + moved[np.asarray(contact.node), 0]
    pressed = contact.pressure > 0.0
    assert where[pressed].min() > 1.7
    assert where[pressed].max() < 3.3
    assert solution.steps[-1].certificate.passed


@pytest.mark.slow
def test_there_and_back_again_leaves_the_block_where_it_was() -> None:
    """Friction turns round; corners run over facets, and set hardly anything free."""
    solution = sg.solve(block_on_bed(0.7, back=True))
    drag = solution.steps[-1]
    normal, tangential = of_contact(drag.instants[-1])
    assert tangential == pytest.approx(0.3 * normal, rel=1e-12)
    assert abs(drag.released) < 1e-5 * drag.contacts[0].dissipation
    assert drag.contacts[0].dissipation == pytest.approx(0.3 * 1.4, rel=0.02)


def test_a_wheel_that_is_dragged_over_a_flat_bed_sets_nothing_free() -> None:
    """A rigid wheel has no facets to hand over: energies close without any error of the mesh."""
    drag = sg.solve(wheel_on_bed(0.6, rolls=False)).steps[-1]
    normal, tangential = of_contact(drag.instants[-1])
    assert abs(tangential) == pytest.approx(0.3 * normal, rel=1e-12)
    assert abs(drag.energy_defect) < 1e-12 * drag.work
    assert abs(drag.released) < 1e-8 * drag.work


def test_sliding_without_friction_costs_no_work() -> None:
    """What facets that run over each other do on the way, of what friction would take."""
    drag = sg.solve(dragged_cylinder(stroke=1.0, spacing=0.2, friction=0.0)).steps[-1]
    assert abs(drag.released) < 1e-6 * 0.3 * PRESSING * 1.0
    assert abs(drag.work) < 1e-6 * 0.3 * PRESSING * 1.0


def test_a_wheel_that_is_free_to_turn_rolls() -> None:
    """Hardly any force; it turns as far as the bed goes, but for the strain of its surface; pressure goes along."""
    solution = sg.solve(wheel_on_bed(0.6, rolls=True))
    drag = solution.steps[-1]
    normal, tangential = of_contact(drag.instants[-1])
    assert abs(tangential) < 1e-3 * 0.3 * normal
    assert abs(drag.released) < 5e-6 * 0.3 * 10.0 * 0.6
    assert drag.obstacles["wheel"].rotation * 10.0 / -0.6 == pytest.approx(0.992, abs=0.002)
    contact = drag.instants[-1].contacts[0]
    assert float(contact.points[:, 0] @ (contact.pressure * contact.area)) / normal == pytest.approx(0.6, abs=0.01)


@pytest.mark.slow
def test_a_history_that_is_cut_goes_on_to_the_last_bit(tmp_path: Path) -> None:
    """From an archive, too."""
    model = block_on_bed(0.9)
    whole = sg.solve(model)
    first = sg.solve(replace(model, steps=model.steps[:1]))
    first.save_state(tmp_path / "first.npz")
    for start in (first, tmp_path / "first.npz"):
        second = sg.solve(replace(model, steps=model.steps[1:]), start=start)
        for one, two in zip(whole.steps[-1].instants, second.steps[-1].instants, strict=True):
            assert np.array_equal(one.contacts[0].pressure, two.contacts[0].pressure)
            assert np.array_equal(one.contacts[0].slip, two.contacts[0].slip)
    whole.write(tmp_path / "whole.h5")
    read = read_archive(tmp_path / "whole.h5")
    assert read.model.contacts[0].sliding == "finite"
    for one, two in zip(whole.steps[-1].instants, read.steps[-1].instants, strict=True):
        assert one.what == two.what
        assert np.array_equal(one.contacts[0].pressure, two.contacts[0].pressure)
        assert np.array_equal(one.contacts[0].normals, two.contacts[0].normals)


def test_a_hub_is_pushed_along_its_shaft() -> None:
    """Over three of its elements the press fit keeps its force, and the push is mu times it; axisymmetric."""
    shaft = sg.rectangle(x=np.linspace(0.0, 1.0, 4), y=np.linspace(-1.0, 3.0, 17))
    hub = sg.rectangle(x=np.linspace(1.0, 2.0, 4), y=np.linspace(0.0, 1.0, 6))
    model = sg.Model(
        mesh=sg.join({"shaft": shaft, "hub": hub}),
        kind="axisymmetric",
        bodies=[sg.Body("shaft", STEEL), sg.Body("hub", STEEL)],
        supports=[sg.Support("shaft.bottom", u=(None, 0.0)), sg.Support("hub.bottom", u=(None, 0.6), name="push")],
        contacts=[
            sg.Contact("hub.left", "shaft.right", friction=0.2, sliding="finite", interference=0.002, name="fit")
        ],
        steps=[sg.Step(scale={"push": 0.0}), sg.Step(scale={"push": 1.0})],
    )
    push = sg.solve(model).steps[-1]
    pushed = [of_contact(instant) for instant in push.instants if instant.what == "handover"][3:]
    assert len(pushed) > 5
    normal, tangential = np.transpose(pushed)
    assert np.abs(tangential) == pytest.approx(0.2 * normal, rel=1e-12)
    assert np.ptp(normal) < 0.01 * normal.mean()
    assert push.reactions["push"][1] == pytest.approx(0.2 * normal[-1], rel=0.01)


def test_a_block_in_space_slides_askew_and_keeps_its_axes() -> None:
    """Friction is against the way, whatever pairs are made anew; tangents do not turn with them."""
    top = sg.box(x=np.linspace(0.0, 1.0, 4), y=np.linspace(0.0, 1.0, 4), z=np.linspace(0.0, 0.6, 3))
    bed = sg.box(x=np.linspace(-0.5, 2.0, 7), y=np.linspace(-0.5, 1.5, 6), z=np.linspace(-0.6, 0.0, 3))
    model = sg.Model(
        mesh=sg.join({"top": top, "bed": bed}),
        kind="3d",
        bodies=[sg.Body("top", STEEL), sg.Body("bed", STEEL)],
        supports=[
            sg.Support("bed.bottom", u=(0.0, 0.0, 0.0)),
            sg.Support("top.top", u=(0.4, 0.12, "free"), name="drag"),
        ],
        loads=[sg.Load(on="top.top", force=("free", "free", -1.0), spread="displacement", name="press")],
        contacts=[sg.Contact("top.bottom", "bed.top", friction=0.3, sliding="finite", name="c")],
        steps=[
            sg.Step(scale={"press": 1.0, "drag": 0.0}),
            sg.Step(scale={"press": 1.0, "drag": 1.0}, increments=4),
        ],
    )
    drag = sg.solve(model).steps[-1]
    instants = [instant.contacts[0] for instant in drag.instants if instant.what == "handover"][2:]
    assert len(instants) > 4
    for contact in instants:
        tractions = np.einsum("ks,ksi->ki", contact.traction, contact.tangents) * contact.area[:, None]
        total, normal = tractions.sum(axis=0), contact.pressure @ contact.area
        assert np.linalg.norm(total) == pytest.approx(0.3 * normal, rel=2e-3)
        assert total[1] / total[0] == pytest.approx(0.3, rel=0.01)
        assert np.abs(contact.tangents - instants[0].tangents).max() < 0.02
    slip = np.einsum("ks,ksi->ki", instants[-1].slip, instants[-1].tangents)
    assert np.abs(slip[:, :2].mean(axis=0) / slip[:, 0].mean() - [1.0, 0.3]).max() < 0.02


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"friction": "tied"}, "a tied contact does not slide"),
        ({"coupling": "nodes"}, "coupling is 'nodes'"),
        ({"sliding": "far"}, "unknown sliding 'far'"),
    ],
)
def test_what_does_not_go_with_it_is_refused(given: dict[str, object], words: str) -> None:
    """By the key of the contact."""
    with pytest.raises(sg.InputError, match=words):
        sg.Contact("a", "b", **{"sliding": "finite", **given})


def test_a_wheel_on_a_bed_hundreds_of_half_widths_deep_keeps_its_digits(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pairs far from where it touches see more of how it turns than those that press."""
    monkeypatch.setattr(gallery, "_DEPTH", 400.0)
    wheel = gallery.free_wheel(friction=0.05, ways=(0.25, 0.25), across=1)
    (press,) = sg.solve(replace(wheel, steps=wheel.steps[:1])).steps
    assert press.path == "exact"
    assert press.certificate.worst < 1e-11

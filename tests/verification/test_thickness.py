# SPDX-License-Identifier: BSD-3-Clause
"""Bodies of different thickness: in series, under every load, where they touch, in decks."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.deck.write import write_deck
from signorini.engine.examine import examine
from signorini.engine.solve import solve
from signorini.errors import InputError
from signorini.fem.space import make_space
from signorini.fem.stress import body_stresses
from signorini.meshing.plane import rectangle
from signorini.model.body import Body
from signorini.model.conditions import Foundation, Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import join
from signorini.model.model import Model
from signorini.model.step import Step

E, WIDTH, HEIGHT, FORCE = (1000.0, 400.0), 2.0, (1.5, 0.5), 30.0


def series(*, thickness, across=(3, 3), cells="quad", swap=False, **contact):
    """The upper block pressed on the lower one, free sideways, plane stress."""
    upper = rectangle(width=WIDTH, height=HEIGHT[0], nx=across[0], ny=2, origin=(0.0, HEIGHT[1]), cells=cells)
    lower = rectangle(width=WIDTH, height=HEIGHT[1], nx=across[1], ny=2, cells=cells)
    sides = ("lower.top", "upper.bottom") if swap else ("upper.bottom", "lower.top")
    return Model(
        join({"upper": upper, "lower": lower}),
        kind="plane stress",
        bodies=[
            Body(name, Elastic(E=modulus, nu=0.3), thickness=own)
            for name, modulus, own in zip(("upper", "lower"), E, thickness, strict=True)
        ],
        supports=[
            Support("lower.bottom", u=(None, 0.0)),
            Support((0.0, 0.0), u=(0.0, None)),
            Support((0.0, sum(HEIGHT)), u=(0.0, None)),
        ],
        loads=[Load("upper.top", force=(0.0, -FORCE))],
        contacts=[Contact(*sides, name="interface", **contact)],
    )


@pytest.mark.parametrize("swap", [False, True])
@pytest.mark.parametrize(("thickness", "smaller"), [((0.5, 2.0), 0.5), ((3.0, None), 1.0)])
@pytest.mark.parametrize(
    ("cells", "across", "coupling"),
    [
        ("quad", (3, 3), "nodes"),
        ("quad", (3, 5), "mortar"),
        ("quad", (3, 3), "node-to-segment"),
        ("quad8", (2, 3), "mortar"),
        ("triangle6", (3, 3), "mortar"),
    ],
)
def test_blocks_in_series(cells, across, coupling, thickness, smaller, swap):
    """The force goes through both: ``F h / (E b t)`` each, ``F / (b t)`` inside, ``F / (b min t)`` between them."""
    history = solve(series(thickness=thickness, cells=cells, across=across, swap=swap, coupling=coupling))
    own = np.array([1.0 if t is None else t for t in thickness])
    shortened = FORCE * np.array(HEIGHT) / (np.array(E) * WIDTH * own)
    top = history.model.mesh.nodes_of("upper.top")
    np.testing.assert_allclose(history.last.displacement[top, 1], -shortened.sum(), rtol=1e-9)
    contact = history.contact("interface")
    np.testing.assert_allclose(contact.pressure, FORCE / (WIDTH * smaller), rtol=1e-9)
    assert contact.area.sum() == pytest.approx(WIDTH * smaller)
    stresses = body_stresses(make_space(history.model.mesh), history.model, history.last.displacement)
    for body, t in zip(stresses, own, strict=True):
        np.testing.assert_allclose(body.stress[:, 1], -FORCE / (WIDTH * t), rtol=1e-8)
    assert history.last.strain_energy == pytest.approx(0.5 * FORCE * shortened.sum())
    assert history.last.work == pytest.approx(history.last.strain_energy)
    assert history.last.certificate.passed


def test_compliance_and_limits_act_on_what_touches():
    """A layer on the smaller thickness; a shear limit holds as much as is pressed together."""
    compliance, stiff = 0.01, series(thickness=(0.5, 2.0))
    soft = series(thickness=(0.5, 2.0), normal_compliance=compliance)
    top = stiff.mesh.nodes_of("upper.top")
    sinks = solve(stiff).last.displacement[top, 1] - solve(soft).last.displacement[top, 1]
    np.testing.assert_allclose(sinks, compliance * FORCE / (WIDTH * 0.5), rtol=1e-9)

    limit = 2.0
    model = series(thickness=(0.5, 2.0), across=(3, 4), friction="stick", shear_limit=limit)
    dragged = replace(
        model,
        supports=[Support("lower.bottom", u=(0.0, 0.0)), Support("upper.top", u=(0.2, -0.1), name="drag")],
        loads=[],
        steps=[Step(scale={"drag": 1.0})],
    )
    force = solve(dragged).contact("interface").tangential_force
    assert abs(force[0]) == pytest.approx(limit * WIDTH * 0.5)


@pytest.mark.parametrize("swap", [False, True])
@pytest.mark.parametrize("coupling", ["nodes", "mortar", "node-to-segment"])
def test_a_side_of_two_thicknesses(coupling, swap):
    """Half the floor is thinner than the block on it, half thicker: areas are those that touch, piece by piece."""
    floor = rectangle(width=2.0, height=1.0, nx=4, ny=2)
    right = floor.points[floor.cells["quad"], 0].mean(axis=1) > 1.0
    floor = replace(floor, bodies={"left": np.flatnonzero(~right), "right": np.flatnonzero(right)})
    mesh = join({"block": rectangle(width=2.0, height=1.0, nx=4, ny=2, origin=(0.0, 1.0)), "floor": floor})
    names = {"block": 2.0, "floor.left": 1.0, "floor.right": 3.0}
    sides = ("floor.top", "block.bottom") if swap else ("block.bottom", "floor.top")
    model = Model(
        mesh,
        bodies=[Body(name, Elastic(E=100.0, nu=0.0), thickness=t) for name, t in names.items()],
        supports=[Support("floor.bottom", u=(0.0, 0.0)), Support("block.top", u=(0.0, -0.01))],
        contacts=[Contact(*sides, coupling=coupling, name="seat")],
    )
    pairs = examine(model).interface
    expected = np.array([0.25, 0.5, 0.25 + 0.5, 1.0, 0.5])
    np.testing.assert_allclose(pairs.area[np.argsort(mesh.points[pairs.node, 0])], expected, rtol=1e-12)
    assert solve(model).last.certificate.passed


def every_load(**own):
    """A block under every kind of load, on a foundation and a rigid plane."""
    elastic = Elastic(E=1000.0, nu=0.3, density=2.0, expansion=1e-3)
    return Model(
        rectangle(width=2.0, height=1.0, nx=4, ny=3, cells="quad8"),
        bodies=[Body("block", elastic, **own)],
        supports=[Support((0.0, 0.0), u=(0.0, None))],
        foundations=[Foundation("bottom", normal_stiffness=50.0, tangential_stiffness=3.0)],
        loads=[
            Load("top", pressure=3.0),
            Load("right", traction=(0.3, -0.2)),
            Load("block", body_force=(0.1, -0.4), name="body force"),
            Load("block", gravity=(0.0, -1.0), name="gravity"),
            Load("block", centrifugal=0.7, name="centrifugal"),
            Load("block", temperature=4.0, name="temperature"),
        ],
        contacts=[Contact("left", sg.Plane(point=(0.002, 0.0), normal=(1.0, 0.0)), friction=0.2)],
    )


def test_thickness_of_a_body_is_that_of_a_model_of_one():
    """All forces t times, displacements and stresses the same."""
    one, model, body = (
        solve(each).last for each in (every_load(), replace(every_load(), thickness=0.25), every_load(thickness=0.25))
    )
    np.testing.assert_array_equal(body.displacement, model.displacement)
    np.testing.assert_allclose(body.displacement, one.displacement, atol=1e-10 * np.abs(one.displacement).max())
    np.testing.assert_allclose(body.external, 0.25 * one.external, atol=1e-10 * np.abs(one.external).max())
    np.testing.assert_allclose(body.contacts[0].pressure, one.contacts[0].pressure, rtol=1e-8, atol=1e-9)
    assert body.work == pytest.approx(0.25 * one.work)
    assert one.contacts[0].normal_force[0] > 0.0


def test_decks_and_archives_keep_it(tmp_path):
    model = series(thickness=(0.5, None))
    write_deck(model, tmp_path / "deck.toml")
    again = sg.read(tmp_path / "deck.toml")
    assert [body.thickness for body in again.bodies] == [0.5, None]
    assert again.thicknesses == [0.5, 1.0]
    solution = sg.solve(model)
    solution.write(tmp_path / "all.h5")
    assert sg.load(tmp_path / "all.h5").model.bodies[0].thickness == 0.5


@pytest.mark.parametrize(("kind", "words"), [("axisymmetric", "an axisymmetric model has none"), ("3d", "in space")])
def test_only_plane_bodies_have_one(kind, words):
    mesh = rectangle() if kind == "axisymmetric" else sg.box(x=[0, 1], y=[0, 1], z=[0, 1])
    with pytest.raises(InputError, match=rf"body\[0\]\.thickness: is 2; .*{words}"):
        Model(mesh, kind=kind, bodies=[Body("block", Elastic(E=1.0, nu=0.0), thickness=2.0)])
    with pytest.raises(InputError, match=r"thickness: is 0.0; expected a number > 0"):
        Body("block", Elastic(E=1.0, nu=0.0), thickness=0.0)

# SPDX-License-Identifier: BSD-3-Clause
"""Bolts: stiffness diagram, locking, order of tightening, every kind of model, and what is no section."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import signorini as sg
from signorini.cli import main
from signorini.gallery.bolts import bolted_sleeve

SOFT = sg.Elastic(E=200.0, nu=0.0)


JOINT, BOLT, SLEEVE = bolted_sleeve()


def clamped(**given):
    """The joint, loaded otherwise."""
    return replace(JOINT, **({"loads": []} | given))


def test_the_stiffness_diagram_of_a_bolted_joint():
    """VDI 2230's triangle: a locked bolt takes k_b / (k_b + k_s) of what pulls, all of it once the sleeve is free."""
    share = BOLT / (BOLT + SLEEVE)
    opens = 6.0 / (1.0 - share)
    model = clamped(
        loads=[sg.Load("head", force=(0.0, 15.0, 0.0), name="pull")],
        steps=[
            sg.Step(name="tighten", scale={"bolt": 1.0, "pull": 0.0}),
            sg.Step(name="pull", hold=["bolt"], scale={"pull": 1.0}, at="events"),
            sg.Step(name="let go", scale={"pull": 0.0}),
        ],
    )
    solution = sg.solve(model)
    tight, pulled, back = solution.steps
    assert tight.bolts["bolt"].force == pytest.approx(6.0, rel=1e-12)
    assert tight.bolts["bolt"].shortening == pytest.approx(6.0 / BOLT + 6.0 / SLEEVE, rel=1e-10)
    assert tight.contacts[0].pressure == pytest.approx(6.0 / 1.5, rel=1e-10)
    assert pulled.bolts["bolt"].shortening == pytest.approx(tight.bolts["bolt"].shortening, rel=1e-12)
    assert pulled.bolts["bolt"].force == pytest.approx(15.0, rel=1e-10)  # the sleeve is free
    assert back.bolts["bolt"].force == pytest.approx(6.0, rel=1e-9)
    factors = [instant.factors["pull"] for instant in pulled.instants]
    assert np.abs(np.array(factors) - opens / 15.0).min() < 1e-9
    assert max(abs(step.energy_defect) for step in solution.steps) < 1e-12 * tight.work
    half = sg.solve(replace(model, steps=[model.steps[0], replace(model.steps[1], scale={"pull": 0.5})])).steps[1]
    assert half.bolts["bolt"].force == pytest.approx(6.0 + 7.5 * share, rel=1e-9)


def test_a_bolt_is_drawn_together_by_a_length_and_loosened():
    shortening = 6.0 / BOLT + 6.0 / SLEEVE
    bolts = [sg.Bolt("cut", shortening=shortening, name="bolt")]
    model = clamped(bolts=bolts, steps=[sg.Step(scale={"bolt": 1.0}), sg.Step(scale={"bolt": 0.0})])
    tight, loose = sg.solve(model).steps
    assert tight.bolts["bolt"].force == pytest.approx(6.0, rel=1e-10)
    assert loose.bolts["bolt"].force == pytest.approx(0.0, abs=1e-12)


def test_a_locked_bolt_that_is_released_is_what_its_force_says():
    steps = [
        sg.Step(scale={"bolt": 1.0}),
        sg.Step(hold=["bolt"], scale={"bolt": 0.5}),
        sg.Step(release=["bolt"], scale={"bolt": 0.5}),
    ]
    forces = [step.bolts["bolt"].force for step in sg.solve(clamped(steps=steps)).steps]
    assert forces == pytest.approx([6.0, 6.0, 3.0], rel=1e-10)


def test_a_history_that_is_cut_is_the_whole_one(tmp_path):
    pull = sg.Load("head", force=(0.0, 8.0, 0.0), name="pull")
    steps = [sg.Step(scale={"bolt": 1.0, "pull": 0.0}), sg.Step(hold=["bolt"], scale={"pull": 1.0})]
    whole = sg.solve(clamped(loads=[pull], steps=steps))
    first = sg.solve(clamped(loads=[pull], steps=steps[:1]))
    second = sg.solve(clamped(loads=[pull], steps=[replace(steps[1], scale={"pull": 1.0, "bolt": 1.0})]), start=first)
    assert (second.steps[-1].displacement == whole.steps[-1].displacement).all()
    whole.write(tmp_path / "whole.h5")
    assert sg.load(tmp_path / "whole.h5").steps[-1].bolts == whole.steps[-1].bolts


def flange(first, second):
    """Two bolts through a plate on a bed with friction, tightened in an order."""
    bed = sg.rectangle(x=np.linspace(-3.0, 3.0, 13), y=np.linspace(-2.0, 0.0, 5))
    plate = sg.rectangle(x=np.linspace(-3.0, 3.0, 13), y=np.linspace(0.0, 1.0, 3))
    stems = {}
    for name, x in (("left", -2.0), ("right", 1.5)):
        stems[name] = sg.rectangle(x=[x, x + 0.5], y=[1.0, 1.5, 2.0, 2.5])
    mesh = sg.join({"bed": bed, "plate": plate, **stems})
    for name, x in (("left", -2.0), ("right", 1.5)):
        mesh = sg.cut(mesh, name + ".cut", body=name, point=(x, 1.5), normal=(0.0, 1.0))
    steel = sg.Elastic(E=200.0, nu=0.3)
    return sg.Model(
        mesh=mesh,
        kind="plane strain",
        bodies=[sg.Body(name, steel) for name in ("bed", "plate", "left", "right")],
        supports=[sg.Support(on, u=(0.0, 0.0)) for on in ("bed.bottom", "left.top", "right.top")],
        contacts=[
            sg.Contact("plate.bottom", "bed.top", friction=0.3),
            sg.Contact("left.bottom", "plate.top", friction="tied"),
            sg.Contact("right.bottom", "plate.top", friction="tied"),
        ],
        bolts=[sg.Bolt("left.cut", force=-0.5), sg.Bolt("right.cut", force=-0.5)],
        steps=[
            sg.Step(scale={f"{first}.cut": 1.0, f"{second}.cut": 0.0}),
            sg.Step(hold=[f"{first}.cut"], scale={f"{second}.cut": 1.0}),
            sg.Step(hold=[f"{second}.cut"]),
        ],
    )


def test_the_order_of_tightening_matters_as_the_mirror_says():
    """The joint is its own mirror image but for the order: each order gives the mirror of the other."""
    one, other = (sg.solve(flange(*order)).steps[-1] for order in (("left", "right"), ("right", "left")))
    assert one.bolts["right.cut"].force == pytest.approx(-0.5, rel=1e-9)
    assert one.bolts["left.cut"].force != pytest.approx(-0.5, rel=1e-4)
    assert one.bolts["left.cut"].force == pytest.approx(other.bolts["right.cut"].force, rel=1e-8)
    pressure = [step.contacts[0].pressure for step in (one, other)]
    assert_allclose(pressure[0], pressure[1][::-1], atol=1e-8 * pressure[0].max())
    assert one.certificate.passed


KINDS = {
    "axisymmetric": lambda: (sg.rectangle(x=[0.0, 0.5, 1.0], y=np.linspace(0, 4, 5)), "axisymmetric", (0, 1), np.pi),
    "hexahedra": lambda: (sg.box(x=[0, 0.5, 1], y=[0, 0.5, 1], z=np.linspace(0, 4, 5)), "3d", (0, 0, 1), 1.0),
    "tetrahedra": lambda: (
        sg.box(x=[0, 0.5, 1], y=[0, 0.5, 1], z=np.linspace(0, 4, 5), cells="tetra10"),
        "3d",
        (0, 0, 1),
        1.0,
    ),
    "triangles": lambda: (
        sg.rectangle(x=[0.0, 0.5, 1.0], y=np.linspace(0, 4, 5), cells="triangle6"),
        "plane stress",
        (0, 1),
        1.0,
    ),
}


@pytest.mark.parametrize("kind", KINDS)
def test_a_bar_is_pulled_evenly_in_every_kind_of_model(kind):
    mesh, name, normal, area = KINDS[kind]()
    d = mesh.points.shape[1]
    middle = tuple(2.0 * part for part in normal)
    mesh = sg.cut(mesh, "cut", body="block", point=middle, normal=normal)
    hold = tuple(0.0 if part else None for part in normal)
    ends = ("bottom", "top")
    model = sg.Model(
        mesh=mesh,
        kind=name,
        bodies=[sg.Body("block", sg.Elastic(E=200.0, nu=0.3))],
        supports=[sg.Support(end, u=hold) for end in ends]
        + ([] if kind == "axisymmetric" else [sg.Support("left", u=(0.0, *(None,) * (d - 1)))])
        + ([sg.Support("front", u=(None, 0.0, None))] if d == 3 else []),
        bolts=[sg.Bolt("cut", force=3.0)],
    )
    step = sg.solve(model).steps[-1]
    assert step.bolts["cut"].shortening == pytest.approx(3.0 / area / 200.0 * 4.0, rel=1e-9)
    assert step.reactions["top"][np.flatnonzero(normal)[0]] == pytest.approx(3.0, rel=1e-9)


def test_a_bolt_at_an_angle_is_the_same_bolt():
    """Rotation of everything turns nothing of the result."""
    found = []
    for angle in (0.0, 0.7):
        c, s = np.cos(angle), np.sin(angle)
        turn = np.array([[c, -s], [s, c]])
        straight = sg.rectangle(x=np.linspace(0, 4, 9), y=np.linspace(0, 1, 3))
        bar = replace(straight, points=straight.points @ turn.T)
        bar = sg.cut(bar, "cut", body="block", point=tuple(turn @ [2.0, 0.0]), normal=tuple(turn @ [1.0, 0.0]))
        model = sg.Model(
            mesh=bar,
            kind="plane strain",
            bodies=[sg.Body("block", sg.Elastic(E=200.0, nu=0.3))],
            supports=[sg.Support("left", u=(0.0, 0.0)), sg.Support("right", u=(0.0, 0.0))],
            bolts=[sg.Bolt("cut", force=3.0)],
        )
        step = sg.solve(model).steps[-1]
        found.append((step.bolts["cut"].shortening, step.strain_energy))
    assert_allclose(found[0], found[1], rtol=1e-11)


def test_what_hangs_on_a_bolt_alone_is_held_by_it():
    bar = sg.cut(sg.rectangle(width=4.0, height=1.0, nx=4, ny=1), "cut", body="block", point=(2, 0), normal=(1, 0))
    model = sg.Model(
        mesh=bar,
        bodies=[sg.Body("block", SOFT)],
        supports=[sg.Support("left", u=(0.0, 0.0))],
        loads=[sg.Load("right", force=(2.0, 0.0), name="pull")],
        bolts=[sg.Bolt("cut", force=5.0)],
    )
    with pytest.raises(sg.InputError, match="without cut, body 'block' can move along x"):
        sg.solve(model)  # what has a force and not its length holds nothing
    step = sg.solve(replace(model, steps=[sg.Step(hold=["cut"])])).steps[-1]
    assert step.bolts["cut"].force == pytest.approx(2.0)
    assert step.reactions["left"] == pytest.approx([-2.0, 0.0], abs=1e-12)


BAR = sg.rectangle(width=4.0, height=1.0, nx=4, ny=2)
WRONG = {
    "outside": ({"point": (0.0, 0.0), "normal": (1.0, 0.0)}, "no facet of 'block' lies in the plane"),
    "between nodes": ({"point": (0.3, 0.0), "normal": (1.0, 0.0)}, "no facet of 'block' lies in the plane"),
    "no body": (
        {"body": "blok", "point": (1.0, 0.0), "normal": (1.0, 0.0)},
        "unknown body 'blok'; did you mean 'block'",
    ),
    "no normal": ({"point": (1.0, 0.0), "normal": (0.0, 0.0)}, "is zero; expected a direction"),
    "no boundary": ({}, "unknown boundary 'cut'"),
}


@pytest.mark.parametrize(("given", "said"), WRONG.values(), ids=WRONG.keys())
def test_what_is_no_section_is_told(given, said):
    with pytest.raises(sg.InputError, match=said):
        sg.cut(BAR, "cut", **({"body": "block"} | given))


def test_sections_that_end_inside_or_outside_are_told():
    inner = replace(BAR, boundaries=dict(BAR.boundaries) | {"half": [[2, 7]], "rim": [[0, 1]]})
    with pytest.raises(sg.InputError, match="does not cut the body apart: around its rim"):
        sg.cut(inner, "half")
    with pytest.raises(sg.InputError, match="has 1 facets that do not lie between two cells"):
        sg.cut(inner, "rim")


def test_wrong_bolts_are_told():
    with pytest.raises(sg.InputError, match="has both of force and shortening"):
        sg.Bolt("cut", force=1.0, shortening=1.0)
    with pytest.raises(sg.InputError, match="force: is 0, which tightens nothing"):
        sg.Bolt("cut", force=0.0)
    base = sg.Model(BAR, bodies=[sg.Body("block", SOFT)], supports=[sg.Support("left", u=(0.0, 0.0))])
    with pytest.raises(sg.InputError, match=r"bolt\[0\].section: 'shank' is no section along which the mesh is cut"):
        sg.solve(replace(base, bolts=[sg.Bolt("shank", force=1.0)]))
    with pytest.raises(sg.InputError, match="bolt: two are called 'b'"):
        replace(base, bolts=[sg.Bolt("x", force=1.0, name="b"), sg.Bolt("y", force=1.0, name="b")])


DECK = """\
kind = "plane stress"

[mesh]
generator = "rectangle"
width = 4.0
height = 1.0
nx = 4
ny = 2

[material.steel]
E = 200.0
nu = 0.0

[[body]]
name = "block"
material = "steel"

[[support]]
on = "left"
u = [0.0, 0.0]

[[support]]
on = "right"
u = [0.0, 0.0]

[[bolt]]
section = "cut"
plane = { body = "block", point = [2.0, 0.0], normal = [1.0, 0.0] }
force = 3.0
name = "bolt"
"""


def test_a_deck_has_bolts(tmp_path, capsys):
    deck = tmp_path / "deck.toml"
    deck.write_text(DECK)
    assert main(["run", str(deck), "-o", str(tmp_path / "out")]) == 0
    assert "bolt bolt: force 3, shortened by 0.06" in capsys.readouterr().out
    for wrong, line, said in (
        ("point = [9.0, 0.0]", 28, "bolt[0].plane: no facet of 'block' lies in the plane"),
        ("pont = [2.0, 0.0]", 28, "bolt[0].plane.pont: unknown key; did you mean 'point'?"),
    ):
        deck.write_text(DECK.replace("point = [2.0, 0.0]", wrong))
        assert main(["check", str(deck)]) == 2
        assert capsys.readouterr().err.startswith(f"signorini: {deck}:{line}: {said}")

# SPDX-License-Identifier: BSD-3-Clause
"""Wrong models and what is said about them: where, what was found, what is expected."""

from dataclasses import replace

import numpy as np
import pytest

from signorini.engine.prepare import prepare
from signorini.engine.solve import solve
from signorini.errors import InputError, SolveFailed
from signorini.meshing.plane import quarter_disk, rectangle
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import Mesh, join
from signorini.model.model import Model
from signorini.model.obstacle import Plane
from signorini.model.step import Step

SOFT = Elastic(E=100.0, nu=0.3)
FLOOR = Plane((0.0, 0.0), (0.0, 1.0))
BLOCK = rectangle(width=2.0, height=1.0, nx=2, ny=1)


def block(**parts):
    given = {
        "bodies": [Body("block", SOFT)],
        "supports": [Support("left", u=(0, None))],
        "loads": [Load("top", pressure=1.0)],
        "contacts": [Contact("bottom", FLOOR)],
    }
    return Model(parts.pop("mesh", BLOCK), **given | parts)


def pair(lower=None, upper=None, **parts):
    """Two blocks on each other."""
    lower = lower or rectangle(width=2.0, height=1.0, nx=2, ny=1)
    upper = upper or rectangle(width=2.0, height=1.0, nx=2, ny=1, origin=(0.0, 1.0))
    given = {
        "bodies": [Body("lower", SOFT), Body("upper", SOFT)],
        "supports": [Support("lower.bottom", u=(0, 0)), Support("upper.top", u=(0, -0.1))],
        "contacts": [Contact("upper.bottom", "lower.top")],
    }
    return Model(join({"lower": lower, "upper": upper}), **given | parts)


def test_the_models_below_are_right_but_for_one_thing():
    assert solve(block()).solved
    assert solve(pair()).solved


IN_THE_MODEL = [
    (lambda: Elastic(E=0.0, nu=0.3), "E: is 0.0; expected a number > 0"),
    (lambda: Elastic(E=1.0, nu=0.5), "nu: is 0.5; expected a number > -1 and < 0.5"),
    (lambda: Elastic(E=True, nu=0.3), "E: is True; expected a number > 0"),
    (lambda: Elastic(E="soft", nu=0.3), "E: is 'soft'; expected a number > 0"),
    (lambda: Elastic(E=float("nan"), nu=0.3), "E: is nan; expected a number > 0"),
    (lambda: Contact("bottom", FLOOR, friction=-0.1), "friction: is -0.1; expected a number >= 0"),
    (lambda: Contact("bottom", FLOOR, friction=(0.1, 0.2, 0.3)), "friction: has 3 coefficients; expected one, or two"),
    (lambda: Contact("bottom", FLOOR, friction=(0.1, -0.2)), "friction[1]: is -0.2; expected a number >= 0"),
    (lambda: Contact("bottom", FLOOR, friction=(0.1, 0.2)), "friction: has two coefficients; expected friction_axis"),
    (lambda: Contact("bottom", FLOOR, friction_axis=(0, 0, 0)), "friction_axis: is zero; expected a direction"),
    (lambda: Contact("bottom", FLOOR, facets=6), "facets: is 6; expected a multiple of 4, or 0 for the exact cone"),
    (lambda: Contact("bottom", FLOOR, facets=2.5), "facets: is 2.5; expected a whole number >= 0"),
    (lambda: Contact("a", "b", friction="tied", facets=8), "facets: is 8, but a tied contact has no friction cone"),
    (
        lambda: Contact("bottom", FLOOR, friction="rough"),
        "friction: is 'rough'; expected a number >= 0, 'stick' or 'tied'",
    ),
    (
        lambda: Contact("bottom", FLOOR, gap="none"),
        "gap: is 'none'; expected 'geometry', 'zero', a number or a formula",
    ),
    (
        lambda: Contact("bottom", FLOOR, normal_compliance=-1.0),
        "normal_compliance: is -1.0; expected a number >= 0",
    ),
    (lambda: Plane((0.0, 0.0), (0.0, 0.0)), "normal: is zero; expected a direction"),
    (
        lambda: Plane((0.0, 0.0), (0.0, 1.0, 0.0)),
        "normal: has 3 components, [0.0, 1.0, 0.0]; expected a list of 2 numbers",
    ),
    (
        lambda: Support("left", u=(None, None)),
        "u: leaves every component free; expected at least one number",
    ),
    (lambda: Support("left", u=0.0), 'u: is 0.0; expected a list of numbers or "free"'),
    (lambda: Support("", u=(0, 0)), "on: is ''; expected a name (text)"),
    (
        lambda: Load("top"),
        "has none of them; expected exactly one of force, nodal_forces, traction, pressure, bearing, body_force",
    ),
    (
        lambda: Load("top", force=(0, 1), pressure=1.0),
        "has force and pressure; expected exactly one of force, nodal_forces, traction, pressure, bearing, body_force",
    ),
    (
        lambda: Load("top", pressure=1.0, spread="displacement"),
        "spread: is 'displacement'; that goes with a total force only",
    ),
    (lambda: Step(increments=0), "increments: is 0; expected a whole number >= 1"),
    (lambda: Step(increments=2.0), "increments: is 2.0; expected a whole number >= 1"),
    (lambda: Step(scale=2.0), "scale: is 2.0; expected a table of names and factors"),
    (lambda: Mesh(points=[[0]], cells={}, bodies={}), "mesh.points: has shape (1, 1); expected (n, 2) or (n, 3)"),
    (
        lambda: Mesh(points=[[0, 0], [1, np.nan]], cells={}, bodies={}),
        "mesh.points: node 2 is at [ 1. nan]; expected finite numbers",
    ),
    (
        lambda: Mesh(points=[[0, 0]], cells={"hexahedron": []}, bodies={}),
        "mesh.cells: unknown family 'hexahedron'; expected one of triangle, quad",
    ),
    (
        lambda: Mesh(points=[[0, 0]], cells={"triangle": [[0, 1, 2]]}, bodies={}),
        "mesh.cells.triangle: holds indices from 0 to 2; expected 0 to 0",
    ),
    (
        lambda: Mesh(points=[[0, 0]], cells={"triangle": [[0, 0]]}, bodies={}),
        "mesh.cells.triangle: has shape (1, 2); expected (m, 3)",
    ),
    (lambda: block(kind="plain strain"), "kind: unknown kind 'plain strain'; did you mean 'plane strain'? Known:"),
    (lambda: block(thickness=0.0), "thickness: is 0.0; expected a number > 0"),
    (lambda: block(bodies=[]), "body: there is none; the mesh has block"),
    (
        lambda: block(bodies=[Body("blok", SOFT)]),
        "body[0].name: unknown body 'blok'; did you mean 'block'? Known: block",
    ),
    (
        lambda: block(bodies=[Body("block", SOFT), Body("block", SOFT)]),
        "body: cell 1 (quad) belongs to several bodies: block",
    ),
    (lambda: pair(bodies=[Body("lower", SOFT)]), "belongs to no body (it is in upper); give it a body and a material"),
    (
        lambda: block(supports=[Support("leftt", u=(0, 0))]),
        "support[0].on: unknown boundary or node set 'leftt'; did you mean 'left'? Known: bottom, left, right, top",
    ),
    (lambda: block(supports=[Support("left", u=(0, 0, 0))]), "support[0].u: has 3 components; expected 2"),
    (
        lambda: block(contacts=[Contact("bottom", FLOOR, friction=(0.1, 0.2), friction_axis=(1, 0, 0))]),
        "contact[0].friction: has two coefficients, which is for models in space (kind = '3d'); expected one",
    ),
    (
        lambda: block(contacts=[Contact("bottom", FLOOR, friction=0.1, friction_axis=(1, 0, 0))]),
        "contact[0].friction_axis: is (1.0, 0.0, 0.0), which is for models in space (kind = '3d'); expected none",
    ),
    (
        lambda: block(contacts=[Contact("bottom", FLOOR, friction=0.1, facets=8)]),
        "contact[0].facets: is 8, which is for models in space (kind = '3d'); expected none",
    ),
    (
        lambda: pair(steps=[Step(friction={"upper.bottom": (0.1, 0.2)})]),
        "step[0].friction.upper.bottom: has two coefficients; expected friction_axis in the contact",
    ),
    (
        lambda: block(loads=[Load("roof", pressure=1.0)]),
        "load[0].on: unknown boundary 'roof'. Known: bottom, left, right, top",
    ),
    (lambda: block(loads=[Load((0.0, 1.0), pressure=1.0)]), "load[0].on: is the point (0.0, 1.0); expected a boundary"),
    (
        lambda: block(loads=[Load("blok", body_force=(0, 1))]),
        "load[0].on: unknown body 'blok'; did you mean 'block'? Known: block",
    ),
    (lambda: block(loads=[Load("top", traction=(1.0,))]), "load[0].traction: has 1 components; expected 2"),
    (
        lambda: block(contacts=[Contact("botom", FLOOR)]),
        "contact[0].nonmortar: unknown boundary 'botom'; did you mean 'bottom'? Known: bottom, left, right, top",
    ),
    (
        lambda: block(contacts=[Contact("bottom", "flor")]),
        "contact[0].mortar: unknown boundary 'flor'. Known: bottom, left, right, top",
    ),
    (
        lambda: block(contacts=[Contact("bottom", "bottom")]),
        "contact[0]: 'bottom' touches itself; expected another boundary",
    ),
    (
        lambda: block(
            mesh=replace(BLOCK, boundaries={**BLOCK.boundaries, "none": np.zeros((0, 2), int)}),
            contacts=[Contact("none", FLOOR)],
        ),
        "contact[0].nonmortar: 'none' is empty in the mesh",
    ),
    (
        lambda: block(contacts=[Contact("bottom", FLOOR), Contact("bottom", FLOOR)]),
        "contact: two are called 'bottom'; give each a name of its own",
    ),
    (
        lambda: block(supports=[Support("top", u=(0.1, None))]),
        "load: 'top' is a load and a moving support; steps need a name for each",
    ),
    (lambda: block(steps=[]), "step: there is none; expected at least one"),
    (
        lambda: block(steps=[Step(scale={"tip": 1.0})]),
        "step[0].scale: unknown load or moving support 'tip'; did you mean 'top'? Known: top",
    ),
    (lambda: block(loads=["top"]), "load[0]: is 'top'; expected a Load"),
    (lambda: block(bodies=["block"]), "body[0]: is 'block'; expected a Body"),
    (lambda: Model("mesh.msh"), "mesh: is str; expected a Mesh"),
    (lambda: rectangle(width=-1.0), "mesh.width: is -1.0; expected a number > 0"),
    (lambda: rectangle(nx=0), "mesh.nx: is 0; expected a whole number >= 1"),
    (lambda: rectangle(x=[0, 1, 1]), "mesh.x: does not increase; expected two or more increasing coordinates"),
    (lambda: rectangle(cells="tri"), "mesh.cells: unknown cells 'tri'"),
    (
        lambda: quarter_disk(radius=8, contact_length=6, contact_spacing=0.5),
        "mesh.contact_length: is 6; expected at most 0.7 radius = 5.6",
    ),
    (
        lambda: quarter_disk(radius=8, contact_length=4, contact_spacing=0.3),
        "mesh.contact_spacing: is 0.3; expected a whole number of steps in the contact length 4",
    ),
]

SHIFTED = rectangle(width=2.0, height=1.0, nx=2, ny=1, origin=(0.3, 1.0))
FINER = rectangle(width=2.0, height=1.0, nx=3, ny=1, origin=(0.0, 1.0))
TWO_CELLS = replace(
    BLOCK, boundaries={**BLOCK.boundaries, "inside": [[1, 4]], "nowhere": [[0, 5]], "twice": [[0, 1], [1, 0]]}
)

IN_THE_MESH = [
    (lambda: block(steps=[Step(scale={})]), "step: no step's scale names 'top': it would never act."),
    (
        lambda: pair(upper=FINER, contacts=[Contact("upper.bottom", "lower.top", coupling="nodes")]),
        "contact[0]: the nonmortar side has 4 nodes and the mortar side 3; expected matching meshes",
    ),
    (
        lambda: pair(upper=SHIFTED, contacts=[Contact("upper.bottom", "lower.top", coupling="nodes")]),
        "at (0.3, 1) has no partner across the gap: the nearest, node 4 at (0, 1), lies 0.6 of a node distance",
    ),
    (
        lambda: pair(contacts=[Contact("upper.bottom", "lower.bottom")]),
        "contact[0]: the surfaces do not face each other at",
    ),
    (
        lambda: pair(contacts=[Contact("upper.bottom", "lower.left")]),
        "contact[0]: no facets of the two sides lie opposite each other",
    ),
    (
        lambda: pair(contacts=[Contact("upper.bottom", "lower.left")]),
        "their outward normals 90 degrees. Expected surfaces that face each other, normals 180 degrees apart",
    ),
    (
        lambda: block(contacts=[Contact("bottom", "left")]),
        "contact[0]: both sides hold node 1; bodies that touch need nodes of their own",
    ),
    (
        lambda: block(contacts=[Contact("bottom", Plane((0, 0), (0, -1)))]),
        "contact[0].plane: 'bottom' faces away from the plane; its normal (0.0, -1.0) must point from the obstacle",
    ),
    (
        lambda: block(mesh=TWO_CELLS, contacts=[Contact("inside", FLOOR)]),
        "contact[0].nonmortar: 'inside' lies inside: the edge between nodes 2 and 5 belongs to two cells.",
    ),
    (
        lambda: block(mesh=TWO_CELLS, loads=[Load("nowhere", pressure=1.0)]),
        "load[0].on: 'nowhere' has an edge between nodes 1 and 6 that no cell has",
    ),
    (lambda: block(mesh=TWO_CELLS, loads=[Load("twice", pressure=1.0)]), "load[0].on: 'twice' has an edge twice"),
    (
        lambda: block(supports=[Support((0.1, 0.0), u=(0, 0))]),
        "support[0].on: no node at (0.1, 0.0); the nearest is node 1 at (0.0, 0.0)",
    ),
    (
        lambda: block(
            supports=[Support("left", u=(0.1, 0)), Support("right", u=(0.1, 0)), Support("bottom", u=(0.2, None))],
            loads=[],
        ),
        "support[2].u: 'bottom' prescribes u_x = 0.2 at node 1, where support 'left' prescribes 0.1",
    ),
    (
        lambda: block(supports=[Support("left", u=(0, 0.1)), Support("bottom", u=(None, 0))], loads=[]),
        "support[1].u: 'bottom' prescribes u_y = 0 at node 1, where support 'left' prescribes 0.1",
    ),
    (
        lambda: block(loads=[Load("top", force=(0, -1), spread="displacement")]),
        "load[0].force: the boundary should move rigidly in x, but support 'left' holds node 4 in that direction; "
        'expected the component to be free (None, in a deck "free")',
    ),
    (
        lambda: block(
            loads=[
                Load("top", force=(None, -1), spread="displacement"),
                Load("right", force=(None, -1), spread="displacement"),
            ]
        ),
        "load[1].force: the boundary should move rigidly in y, but another load holds node 6 in that direction",
    ),
]

SIDES = [
    (
        lambda: pair(contacts=[Contact("upper.bottom", "lower.top", name="a"), Contact("upper.bottom", "lower.top")]),
        "contact[1]: 'upper.bottom' is between the same sides as contact 'a': nothing determines how they share",
    ),
    (
        lambda: pair(contacts=[Contact("upper.bottom", "lower.top"), Contact("lower.top", "upper.bottom")]),
        "contact[1]: 'lower.top' is between the same sides as contact 'upper.bottom', named the other way round: ",
    ),
    (
        lambda: block(contacts=[Contact("bottom", FLOOR), Contact("bottom", Plane((0, 0), (0, 1)), name="again")]),
        "contact[1]: 'again' is between the same sides as contact 'bottom'",
    ),
    (
        lambda: block(
            mesh=replace(BLOCK, boundaries={**BLOCK.boundaries, "foot": BLOCK.boundaries["bottom"][::-1, ::-1]}),
            contacts=[Contact("bottom", FLOOR), Contact("foot", FLOOR)],
        ),
        "contact[1]: 'foot' is between the same sides as contact 'bottom'",
    ),
]

FREE = [
    (
        lambda: block(supports=[], contacts=[]),
        "body 'block' can move along x and y, and rotate about (1, 0.5): no support or contact holds it; add a support",
    ),
    (
        lambda: block(supports=[]),
        "body 'block' can move along x: nothing but frictionless contact, which cannot resist; add a support or "
        "friction",
    ),
    (
        lambda: block(supports=[Support((0.0, 0.0), u=(0, 0))], contacts=[]),
        "body 'block' can rotate about (0, 0): no support or contact holds it; add a support",
    ),
    (
        lambda: pair(supports=[Support("lower.bottom", u=(0, 0))]),
        "body 'upper' can move along x: nothing but frictionless contact",
    ),
    (
        lambda: pair(supports=[Support("upper.top", u=(0, 0))]),
        "body 'lower' can move along x: nothing but frictionless contact",
    ),
    (
        lambda: pair(supports=[Support("lower.bottom", u=(0, 0))], contacts=[]),
        "body 'upper' can move along x and y, and rotate about (1, 1.5): no support or contact holds it; add a support",
    ),
]


@pytest.mark.parametrize(("make", "message"), IN_THE_MODEL, ids=[message[:50] for _, message in IN_THE_MODEL])
def test_the_model_refuses(make, message):
    with pytest.raises(InputError) as caught:
        make()
    assert str(caught.value).startswith(message) or message in str(caught.value)


@pytest.mark.parametrize(
    ("make", "message"), IN_THE_MESH + SIDES + FREE, ids=[message[:50] for _, message in IN_THE_MESH + SIDES + FREE]
)
def test_preparing_refuses(make, message):
    model = make()  # what only the mesh can tell is not the model's to check
    with pytest.raises(InputError) as caught:
        prepare(model)
    assert message in str(caught.value)


@pytest.mark.parametrize(("at", "rests"), [((1.0, 1.0), True), ((-1.0, 1.0), False)])
def test_one_contact_node_resists_a_rotation_one_way_only(at, rests):
    """A triangle on its tip, pushed down beside it: over the edge that may touch, or over the other."""
    triangle = Mesh(
        points=[[0, 0], [1, 1], [-1, 1]],
        cells={"triangle": [[0, 1, 2]]},
        bodies={"block": [0]},
        boundaries={"tip": [[0, 1]]},
    )
    model = block(
        mesh=triangle,
        supports=[],
        loads=[Load(at, force=(0.0, -1e-3))],
        contacts=[Contact("tip", FLOOR, friction=2.0)],
    )
    history = solve(model, raise_on_failure=False)
    assert history.solved is rests
    if not rests:
        assert history.status == "no_equilibrium"
        assert "body 'block' can rotate about" in history.message


def test_contacts_may_share_a_part_of_a_side_or_take_turns():
    top = BLOCK.boundaries["top"]
    lower = replace(BLOCK, boundaries={**BLOCK.boundaries, "half": top[:1], "other half": top[1:]})
    halves = [Contact("upper.bottom", f"lower.{name}", name=name) for name in ("half", "other half")]
    assert len(prepare(pair(lower=lower, contacts=halves)).model.contacts) == 2
    turns = [Contact("upper.bottom", "lower.top", friction=0.2, name="dry"), Contact("upper.bottom", "lower.top")]
    steps = [
        Step(name="dry", inactive=("upper.bottom",)),
        Step(name="wet", active=("upper.bottom",), inactive=("dry",)),
    ]
    assert solve(pair(contacts=turns, steps=steps)).solved


def test_a_hinge_at_one_node_is_named():
    points = [[0, 0], [1, 0], [1, 1], [0, 1], [2.1, 1.2], [2, 2.3], [0.9, 1.8]]
    mesh = Mesh(
        points=points,
        cells={"quad": [[0, 1, 2, 3], [2, 4, 5, 6]]},
        bodies={"block": [0, 1]},
        boundaries={"bottom": [[0, 1]], "top": [[5, 6]]},
    )
    model = block(mesh=mesh, supports=[Support("bottom", u=(0, 0))], contacts=[])
    with pytest.raises(
        InputError, match=r"body 'block' has no stiffness against some motion of node .* \(a hinge at a"
    ):
        prepare(model)


@pytest.mark.parametrize(
    ("model", "status", "message"),
    [
        (
            block(loads=[Load("top", pressure=-1.0)]),
            "no_equilibrium",
            "step 'load' at 0%: body 'block' can move along y",
        ),
        (
            block(
                supports=[Support("left", u=(0, None)), Support("bottom", u=(None, -0.1))],
                loads=[],
            ),
            "no_equilibrium",
            "step 'load' at 100%: contact 'bottom': supports press node 1 0.1 into the other side and leave it no",
        ),
        (
            block(
                supports=[],
                loads=[Load("top", pressure=1.0), Load("left", traction=(3.0, 0.0))],
                contacts=[Contact("bottom", FLOOR, friction=0.5)],
                steps=[Step(name="load", increments=1)],
            ),
            "no_equilibrium",
            "step 'load' at 0%: body 'block'",
        ),
    ],
    ids=["pulled off", "pressed in by supports", "pushed beyond friction"],
)
def test_what_has_no_equilibrium_is_said(model, status, message):
    with pytest.raises(SolveFailed) as caught:
        solve(model)
    assert str(caught.value).startswith(message)
    assert caught.value.status == status
    assert caught.value.solution.steps == ()
    history = solve(model, raise_on_failure=False)
    assert (history.status, history.message) == (status, str(caught.value))


def test_the_steps_before_a_failure_are_kept():
    model = block(steps=[Step(name="press", scale={"top": 1.0}), Step(name="lift", scale={"top": -1.0}, increments=4)])
    history = solve(model, raise_on_failure=False)
    assert [(step.name, step.load_factor, step.finished) for step in history.steps] == [
        ("press", 1.0, True),
        ("lift", 1.5, False),
    ]
    assert history.message.startswith("step 'lift' at 75%")


def test_a_contact_that_nothing_closes_is_noted():
    """A wrong place, or a load that pulls: the answer is one, but hardly what was meant."""
    far = block(
        supports=[Support("top", u=(0.0, 0.1))],
        contacts=[Contact("bottom", Plane((0, -9), (0, 1)))],
        loads=[],
        steps=[Step()],
    )
    (note,) = solve(far).last.notes
    assert note == "contact 'bottom' is open everywhere: its sides are 9.1 apart, 9 to begin with"
    assert solve(block()).last.notes == ()


def test_an_unknown_contact_is_named():
    history = solve(block())
    with pytest.raises(InputError, match="unknown contact 'botom'; did you mean 'bottom'"):
        history.contact("botom")


def test_bad_cells_are_named():
    crossed = Mesh(
        points=[[0, 0], [1, 0], [0, 1], [1, 1]],
        cells={"quad": [[0, 1, 2, 3]]},
        bodies={"block": [0]},
        boundaries={"bottom": [[0, 1]], "top": [[2, 3]], "left": [[0, 2]]},
    )
    flat = replace(crossed, cells={"triangle": [[0, 1, 1]]})
    for mesh, words in ((crossed, r"mesh: cell 1 \(quad\) near"), (flat, r"mesh: cell 1 \(triangle\) near")):
        with pytest.raises(InputError, match=words):
            prepare(block(mesh=mesh))

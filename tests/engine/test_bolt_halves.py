# SPDX-License-Identifier: BSD-3-Clause
"""Bolts between halves that are given as two bodies: the same bolts as in one that is cut."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

import signorini as sg
from signorini.cli import main
from signorini.deck import DeckError, load_deck
from tests.helpers.eight_cells import eight_cells

STEEL = sg.Elastic(E=200.0, nu=0.3)


def shuffled(mesh, seed):
    """Its nodes in another order."""
    order = np.random.default_rng(seed).permutation(len(mesh.points))
    new = np.argsort(order)
    return replace(
        mesh,
        points=mesh.points[order],
        cells={family: new[cells] for family, cells in mesh.cells.items()},
        boundaries={name: tuple(new[own] for own in mesh.facets(name)) for name in mesh.boundaries},
    )


def plane(cells):
    def grid(y):
        return sg.rectangle(x=[0.0, 0.4, 1.0], y=y, cells=cells)

    return grid


def space(cells):
    def grid(z):
        return sg.box(x=[0.0, 0.4, 1.0], y=[0.0, 0.5, 1.0], z=z, cells=cells)

    return grid


KINDS = {
    "plane stress": (plane("quad8"), "plane stress"),
    "axisymmetric": (plane("quad"), "axisymmetric"),
    "hexahedra": (space("hexahedron"), "3d"),
    "tetrahedra": (space("tetra10"), "3d"),
}


def joint(mesh, kind, bodies, clamp):
    """A jack on a foot, driven apart against a rigid plane with friction and locked, then pushed aside."""
    up, least = np.eye(mesh.points.shape[1])[-1], np.eye(mesh.points.shape[1])[0]
    steps = [sg.Step(scale={"shank": 1.0, "push": 0.0}), sg.Step(hold=["shank"], scale={"push": 1.0})]
    if kind == "axisymmetric":
        steps = [sg.Step(scale={"shank": 1.0})]
    return sg.Model(
        mesh,
        kind=kind,
        bodies=[sg.Body(name, STEEL) for name in bodies],
        supports=[sg.Support("foot.bottom", u=tuple(0.0 * up))],
        loads=[] if kind == "axisymmetric" else [sg.Load(clamp, force=tuple(0.1 * least), name="push")],
        contacts=[sg.Contact(clamp, sg.Plane(tuple(2.0 * up), tuple(-up)), friction=0.2)],
        bolts=[sg.Bolt("shank", force=-3.0)],
        steps=steps,
    )


@pytest.mark.parametrize("name", KINDS)
def test_halves_are_a_body_that_is_cut(name):
    grid, kind = KINDS[name]
    foot, head = grid([0.0, 0.5, 1.0]), grid([1.0, 1.4, 2.0])
    way = (0.0,) * (foot.points.shape[1] - 1)
    whole = sg.cut(grid([0.0, 0.5, 1.0, 1.4, 2.0]), "shank", body="block", point=(*way, 1.0), normal=(*way, 1.0))
    whole = replace(whole, boundaries={**whole.boundaries, "foot.bottom": whole.boundaries["bottom"]})
    halves = sg.section(sg.join({"foot": foot, "head": shuffled(head, 3)}), "shank", "foot.top", "head.bottom")
    one = sg.solve(joint(whole, kind, ["block"], "top")).steps
    two = sg.solve(joint(halves, kind, ["foot", "head"], "head.top")).steps
    for a, b in zip(one, two, strict=True):
        assert b.bolts["shank"].force == pytest.approx(a.bolts["shank"].force, rel=1e-9)
        assert b.bolts["shank"].shortening == pytest.approx(a.bolts["shank"].shortening, rel=1e-9)
        assert b.strain_energy == pytest.approx(a.strain_energy, rel=1e-9)
        assert_allclose(np.sort(b.contacts[0].pressure), np.sort(a.contacts[0].pressure), atol=1e-8)
        assert b.certificate.passed


FOOT, HEAD = sg.rectangle(x=[0.0, 1.0], y=[0.0, 1.0]), sg.rectangle(x=[0.0, 1.0], y=[1.0, 2.0])
HALVES = sg.join({"foot": FOOT, "head": HEAD})


def bent(mesh):
    """Its points, lifted by a parabola."""
    x, y = mesh.points.T
    return replace(mesh, points=np.column_stack([x, y + 0.1 * x * (1.0 - x)]))


BENT = sg.join(
    {
        "foot": bent(sg.rectangle(x=[0.0, 0.5, 1.0], y=[0.0, 1.0])),
        "head": bent(sg.rectangle(x=[0.0, 0.3, 0.6, 1.0], y=[1.0, 2.0])),
    }
)
WRONG = {
    "no boundary": (HALVES, ("shank", "foot.topp", "head.bottom"), "unknown boundary 'foot.topp'; did you mean"),
    "a name taken": (HALVES, ("foot.top", "foot.top", "head.bottom"), "there is a boundary 'foot.top'; expected a new"),
    "elsewhere": (
        HALVES,
        ("shank", "foot.top", "head.top"),
        "node 3 of 'foot.top' is 1 away from the next node of 'head.top', and these are 2 and 2 nodes; expected halves "
        "whose nodes lie in the same places, or halves that lie in one plane",
    ),
    "finer, and bent": (
        BENT,
        ("shank", "foot.top", "head.bottom"),
        "these are 3 and 4 nodes; expected halves whose",
    ),
    "one half": (HALVES, ("shank", "foot.top", "foot.right"), "'foot.top' and 'foot.right' share node 4; expected"),
    "the same way": (
        sg.join({"foot": FOOT, "head": FOOT}),
        ("shank", "foot.top", "head.top"),
        "'foot.top' and 'head.top' look the same way; expected halves that face each other",
    ),
}


@pytest.mark.parametrize(("mesh", "given", "said"), WRONG.values(), ids=WRONG.keys())
def test_what_are_no_halves_is_told(mesh, given, said):
    with pytest.raises(sg.InputError, match=said):
        sg.section(mesh, *given)


def pulled(kind, family, at=([0.0, 0.5, 1.0], [0.0, 0.3, 0.6, 1.0])):
    """A bar of two halves, meshed otherwise, that its bolt draws by 3 per area between two planes of symmetry."""

    def half(x, up):
        if kind == "3d":
            return sg.box(x=x, y=x, z=up, cells=family)
        return sg.rectangle(x=x, y=up, cells=family)

    d = 3 if kind == "3d" else 2
    parts = {"foot": half(at[0], [0.0, 0.5, 1.0]), "head": half(at[1], [1.0, 1.4, 2.0])}
    area = np.pi if kind == "axisymmetric" else 1.0
    across = [] if kind == "axisymmetric" else ["left", "front"][: d - 1]
    return sg.Model(
        sg.section(sg.join(parts), "shank", "foot.top", "head.bottom"),
        kind=kind,
        bodies=[sg.Body(name, STEEL) for name in parts],
        supports=[
            *(sg.Support(on, u=(*(None,) * (d - 1), 0.0)) for on in ("foot.bottom", "head.top")),
            *(
                sg.Support(f"{name}.{side}", u=tuple(0.0 if k == i else None for k in range(d)))
                for name in parts
                for i, side in enumerate(across)
            ),
        ],
        bolts=[sg.Bolt("shank", force=3.0 * area)],
    )


@pytest.mark.parametrize(
    ("kind", "family"),
    [("plane stress", "quad8"), ("axisymmetric", "quad"), ("3d", "hexahedron"), ("3d", "tetra10")],
)
@pytest.mark.parametrize("swap", [False, True])
def test_halves_that_do_not_match_pass_a_uniform_stress(kind, family, swap):
    """Exactly, whichever half is the finer one: it shortens by the strain of both."""
    given = ([0.0, 0.3, 0.6, 1.0], [0.0, 0.5, 1.0]) if swap else ([0.0, 0.5, 1.0], [0.0, 0.3, 0.6, 1.0])
    solution = sg.solve(pulled(kind, family, given))
    for name in ("foot", "head"):
        assert_allclose(solution.stress(name).stress[:, 2 if kind == "3d" else 1], 3.0, rtol=1e-11)
    bolt = solution.steps[0].bolts["shank"]
    assert bolt.shortening == pytest.approx(2.0 * 3.0 / 200.0, rel=1e-11)
    assert solution.steps[0].certificate.passed


def test_halves_that_do_not_match_are_nearly_those_that_do():
    """A jack under friction, pushed aside: coarse halves apart are between a coarse and a fine whole."""

    def jack(below, above):
        parts = {"foot": sg.rectangle(x=below, y=[0, 0.5, 1]), "head": sg.rectangle(x=above, y=[1, 1.4, 2])}
        mesh = sg.section(sg.join(parts), "shank", "foot.top", "head.bottom")
        return sg.solve(joint(mesh, "plane stress", ["foot", "head"], "head.top")).steps

    two, three, six = (np.linspace(0.0, 1.0, n + 1) for n in (2, 3, 6))
    apart, coarse, fine = jack(two, three), jack(two, two), jack(six, six)
    for one, least, most in zip(apart, coarse, fine, strict=True):
        assert least.bolts["shank"].shortening > one.bolts["shank"].shortening > most.bolts["shank"].shortening
        assert one.bolts["shank"].shortening == pytest.approx(most.bolts["shank"].shortening, rel=0.02)
        assert abs(one.energy_defect) < 1e-13


def test_halves_beside_each_other_are_told():
    parts = {"foot": sg.rectangle(x=[0.0, 0.6, 1.0], y=[0.0, 1.0]), "head": sg.rectangle(x=[0.5, 1.5], y=[1.0, 2.0])}
    mesh = sg.section(sg.join(parts), "shank", "foot.top", "head.bottom")
    model = sg.Model(
        mesh,
        bodies=[sg.Body(name, STEEL) for name in parts],
        supports=[sg.Support("foot.bottom", u=(0.0, 0.0)), sg.Support("head.top", u=(0.0, 0.0))],
        bolts=[sg.Bolt("shank", force=3.0)],
    )
    with pytest.raises(
        sg.InputError, match=r"bolt\[0\].section: the halves of section 'shank' do not lie on each other"
    ):
        sg.solve(model)


def test_what_joins_the_halves_beside_the_bolt_is_told():
    mesh = sg.section(HALVES, "shank", "foot.top", "head.bottom")
    model = sg.Model(
        mesh,
        bodies=[sg.Body("foot", STEEL), sg.Body("head", STEEL)],
        supports=[sg.Support("foot.bottom", u=(0.0, 0.0)), sg.Support("head.top", u=(0.0, 0.0))],
        contacts=[sg.Contact("head.bottom", "foot.top", friction="tied")],
        bolts=[sg.Bolt("shank", force=3.0)],
    )
    said = r"contact\[0\]: joins the halves of section 'shank', which its bolt holds opposite each other; expected no"
    with pytest.raises(sg.InputError, match=said):
        sg.solve(model)


DECK = """\
kind = "plane stress"

[[mesh]]
name = "foot"
generator = "rectangle"

[[mesh]]
name = "head"
generator = "rectangle"
origin = [0.0, 1.0]

[material.steel]
E = 200.0
nu = 0.0

[[body]]
name = "foot"
material = "steel"

[[body]]
name = "head"
material = "steel"

[[support]]
on = "foot.bottom"
u = [0.0, 0.0]

[[support]]
on = "head.top"
u = [0.0, 0.0]

[[bolt]]
section = "shank"
halves = ["foot.top", "head.bottom"]
force = 3.0
"""


def test_a_deck_has_halves(tmp_path, capsys):
    deck = tmp_path / "deck.toml"
    deck.write_text(DECK)
    assert main(["run", str(deck), "-o", str(tmp_path / "out")]) == 0
    assert "bolt shank: force 3, shortened by 0.03" in capsys.readouterr().out
    for wrong, said in (
        ('["foot.top"]', "34: bolt[0].halves: is ['foot.top']; expected two boundaries"),
        ('["foot.top", 3]', "34: bolt[0].halves[1]: is 3; expected a name (text)"),
        ('["foot.top", "head.left"]', "34: bolt[0].halves: node 4 of 'foot.top' is 1 away"),
        ('["foot.top", "head.bottom"]\nplane = 3', "32: bolt[0]: has both plane and halves; expected one of them"),
    ):
        deck.write_text(DECK.replace('["foot.top", "head.bottom"]', wrong))
        assert main(["check", str(deck)]) == 2
        assert capsys.readouterr().err.startswith(f"signorini: {deck}:{said}")


def keywords(folder: Path, *, apart: float | None, faces: str = "1,S4\n3,S4\n5,S4\n7,S4") -> Path:
    """Eight cells bolted in the middle, the right four with nodes of their own, there or a little apart."""
    text = eight_cells()
    if apart is not None:
        lines = text.splitlines()
        middle = [line.split(",") for line in lines[1:28] if int(line.split(",")[0]) % 3 == 2]
        twins = [f"{200 - int(k)},{float(x) + apart},{y},{z}" for k, x, y, z in middle]
        cells = lines.index("*ELEMENT,TYPE=C3D8,ELSET=E") + 1
        for k in range(cells, cells + 9):
            number, *nodes = lines[k].split(",")
            if number in ("2", "4", "6", "8"):
                moved = [str(200 - int(node)) if int(node) % 3 == 2 else node for node in nodes]
                lines[k] = ",".join([number, *moved])
        text = "\n".join([*lines[:28], *twins, *lines[28:], ""])
    path = folder / "bolt.inp"
    path.write_text(
        f"{text}R,1\n*NODE,NSET=REF\n900,0.,0.,0.\n*SURFACE,NAME=MIDDLE\n{faces}\n"
        "*PRE-TENSION SECTION,SURFACE=MIDDLE,NODE=900\n*STEP\n*STATIC\n*CLOAD\n900,1,3.\nR,2,.2\n*END STEP\n"
    )
    return path


def test_decks_of_keywords_have_halves(tmp_path: Path) -> None:
    models = [sg.read(keywords(tmp_path, apart=apart)) for apart in (None, 0.0)]
    whole, halves = (sg.solve(model).steps[-1].displacement[model.mesh.nodes["R"]] for model in models)
    assert halves == pytest.approx(whole, rel=1e-9)
    with pytest.raises(DeckError, match="surface 'MIDDLE' has 4 facets that do not lie between two cells") as told:
        load_deck(keywords(tmp_path, apart=0.1))
    assert (tmp_path / "bolt.inp").read_text().splitlines()[told.value.line - 1].startswith("*PRE-TENSION")

# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of bodies in space: their skin, the view, what hides what, and the rendering by PyVista."""

import sys
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import signorini as sg
from signorini.errors import InputError
from signorini.meshing.solid import extruded
from signorini.plot.camera import best_view, look_from
from signorini.plot.paint import Paint, paint_skin
from signorini.plot.skin import make_skin

X, Y, Z = [0, 1, 2.5], [0, 2.0], [0, 0.5, 1, 1.5]
FAMILIES = ["hexahedron", "hexahedron20", "hexahedron27", "tetra", "tetra10", "wedge15"]


def box(family):
    """Of the size 2.5 x 2 x 1.5."""
    if family == "wedge15":
        return extruded(sg.rectangle(x=X, y=Y, cells="triangle6"), z=Z, ends=("low", "high"))
    return sg.box(x=X, y=Y, z=Z, cells=family)


def skin_of(mesh):
    """With every cell of one body."""
    blocks = [(family, cells, np.zeros(len(cells), int)) for family, cells in mesh.cells.items()]
    return make_skin(mesh.points, blocks)


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("family", FAMILIES)
def test_the_skin_of_a_box_is_its_surface(family, mirrored):
    """Also of cells that are numbered the other way round."""
    mesh = box(family)
    points = mesh.points * [1, 1, -1 if mirrored else 1]
    skin = skin_of(sg.Mesh(**{**vars(mesh), "points": points}))
    spans = skin.spans(skin.points)
    np.testing.assert_allclose(spans.sum(axis=0), 0.0, atol=1e-12)
    areas = np.linalg.norm(spans, axis=1)
    assert areas.sum() == pytest.approx(2 * (2.5 * 2 + 2.5 * 1.5 + 2 * 1.5))
    middle = np.stack([skin.points[skin.pieces[skin.face == f]].mean(axis=(0, 1)) for f in range(len(areas))])
    inside = np.array([1.25, 1.0, -0.75 if mirrored else 0.75])
    assert (np.sum((middle - inside) * spans, axis=1) > 0).all()
    # the edges of the box are the sharp ones, each seen from both faces
    ends = skin.points[skin.edges[skin.sharp]]
    assert np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum() == pytest.approx(2 * 4 * (2.5 + 2.0 + 1.5))


@pytest.mark.parametrize("family", FAMILIES)
def test_quadratic_fields_are_those_of_the_cells_on_the_skin(family):
    mesh = box(family)
    skin = skin_of(mesh)

    def field(x):
        linear = x @ [1.0, -2.0, 0.5]
        return linear + (x[:, 0] * x[:, 1] if family == "hexahedron20" else 0.0)

    np.testing.assert_allclose(skin.values(field(mesh.points)), field(skin.points), atol=1e-12)
    np.testing.assert_allclose(skin.values(mesh.points), skin.points, atol=1e-12)


def test_bodies_that_touch_have_a_skin_each():
    boxes = sg.join({"low": sg.box(x=X, y=Y, z=[-1, 0]), "high": sg.box(x=X, y=Y, z=[0, 1])})
    skin = skin_of(boxes)
    assert np.linalg.norm(skin.spans(skin.points), axis=1).sum() == pytest.approx(2 * 2 * (5 + 2.5 + 2))
    part = skin.part(np.arange(len(skin.body)) < 5)
    assert part.face.max() == part.edge_face.max() == 4
    np.testing.assert_allclose(part.spans(skin.points), skin.spans(skin.points)[:5])


def test_a_view_is_a_turn_and_sees_what_matters():
    for direction in np.random.default_rng(1).normal(size=(20, 3)):
        camera = look_from(direction)
        np.testing.assert_allclose(camera.axes @ camera.axes.T, np.eye(3), atol=1e-14)
        assert np.linalg.det(camera.axes) == pytest.approx(1.0)
        assert camera.axes[1, 2] >= 0.0  # z is up
    skin = skin_of(sg.box(x=[0, 1], y=[0, 1], z=[0, 1]))
    spans = skin.spans(skin.points)
    for face in spans:
        hidden = np.sum(spans * face, axis=1) <= 0.5
        assert best_view(spans, np.where(hidden, 0.0, 1.0)).towards @ face > 0.4


def pixels(points, meshes, direction, palette):
    """The colours that a small picture of several meshes shows at points, a colour a mesh."""
    mesh = sg.join({str(i): part for i, part in enumerate(meshes)})
    owner = np.zeros(mesh.number_of_cells, int)
    for i, name in enumerate(mesh.bodies):
        owner[mesh.bodies[name]] = i
    ((family, cells),) = mesh.cells.items()
    skin, camera = make_skin(mesh.points, [(family, cells, owner)]), look_from(np.array(direction))
    figure = Figure(figsize=(4, 4), dpi=60)
    canvas = FigureCanvasAgg(figure)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_xlim(-4, 4)
    axes.set_ylim(-4, 4)
    axes.set_axis_off()
    paint = Paint(values=None, colours=lambda body: np.array(palette)[body.astype(int)], mesh=(0, 0, 0, 0.0))
    paint_skin(axes, skin, skin.points, camera, paint)
    canvas.draw()
    picture = np.asarray(canvas.buffer_rgba())[::-1, :, :3]
    column, row = ((camera.across(np.array(points)) + 4.0) / 8.0 * 240).astype(int).T
    return picture[row, column].astype(int)


def shown(points, meshes, direction):
    """Which of the red, green and blue mesh is seen at points, or none."""
    found = pixels(points, meshes, direction, np.eye(3))
    return ["rgb"[int(np.argmax(colour))] if colour.min() < 200 else "-" for colour in found]


def test_what_is_nearer_hides_what_is_farther():
    """A small block before a large one, one behind it, seen from three sides."""

    def block(x, size):
        return sg.box(x=[x - size, x + size], y=[-size, size], z=[-size, size])

    meshes = [block(0.0, 1.0), block(2.0, 0.4), block(-2.0, 0.4)]
    middles = [[0, 0, 0], [2.0, 0, 0], [-2.0, 0, 0]]
    assert shown(middles, meshes, (0.05, -1, 0.05)) == ["r", "g", "b"]
    assert shown(middles, meshes, (1, 0.05, 0.05)) == ["g", "g", "g"]
    assert shown(middles, meshes, (-1, 0.05, 0.05)) == ["b", "b", "b"]
    assert shown([[0, 0, 3.5], [0, 0.8, 0]], meshes, (1, 0.05, 0.05)) == ["-", "r"]


def test_light_comes_from_above():
    cube = sg.box(x=[-1, 1], y=[-1, 1], z=[-1, 1])
    top, right, left = pixels([[0, 0, 1], [1, 0, 0], [0, -1, 0]], [cube], (1, -1, 0.8), [[0.5, 0.5, 0.5]])
    assert top.min() > left.max() > right.max() > 60


@pytest.fixture(scope="module")
def solution():
    """A block pressed and pushed on another: the contact is hidden between them."""
    mesh = sg.join(
        {
            "low": sg.box(x=[0, 1, 2, 3], y=[0, 1, 2], z=[-1, 0], cells="hexahedron20"),
            "high": sg.box(x=[0.5, 1.5, 2.5], y=[0.5, 1.5], z=[0, 0.5, 1], cells="tetra10"),
        }
    )
    return sg.solve(
        sg.Model(
            mesh,
            title="Block on block",
            bodies=[sg.Body(name, sg.Elastic(E=1000.0, nu=0.3)) for name in ("low", "high")],
            supports=[sg.Support("low.bottom", u=(0, 0, 0)), sg.Support("high.top", u=(0.01, 0, -0.03))],
            contacts=[sg.Contact("high.bottom", "low.top", friction=0.3)],
            steps=[sg.Step(increments=1)],
        )
    )


@pytest.mark.slow
def test_a_hidden_contact_is_shown_on_its_body_alone(solution):
    from signorini.plot.picture_data import PictureData
    from signorini.plot.shots import make_shots
    from signorini.plot.solid import draw_solid_field, draw_solid_mesh

    data = PictureData(solution)
    whole, near = make_shots(data)
    assert near.title == "at the contact 'high.bottom', 'high' alone, seen from below"
    assert set(near.skin.body) == {1}
    low = near.skin.part(near.contact)
    np.testing.assert_allclose(low.points[np.unique(low.pieces)][:, 2], 0.0)
    assert (low.spans(low.points) @ near.camera.towards > 0).all()
    assert whole.camera.towards[2] > 0.0
    stress = draw_solid_field(data, data.stress)
    assert "Block on block\ndeformed, true displacements" in stress.get_suptitle()
    assert "contact pairs" in draw_solid_mesh(data).get_suptitle()
    labels = [text.get_text() for text in draw_solid_mesh(data).legends[0].get_texts()]
    assert labels[:2] == ["low", "high"]
    assert any(label.startswith("contact node, ") for label in labels)


def test_a_view(solution, tmp_path):
    pytest.importorskip("pyvista")
    from PIL import Image

    solution.view(tmp_path / "view.png")
    with Image.open(tmp_path / "view.png") as picture:
        pixels = np.asarray(picture.convert("RGB")).astype(int)
    assert pixels.shape == (1000, 2000, 3)
    for half in np.split(pixels, 2, axis=1):
        middle = half[300:700, 300:700]
        assert (middle.min(axis=2) < 230).mean() > 0.3  # not just the background
        assert len(np.unique(middle.reshape(-1, 3) // 16, axis=0)) > 20  # a field


def test_a_view_shows_where_bodies_have_yielded(solution, tmp_path):
    """In a picture of its own between stress and contact, which stay as they are."""
    pytest.importorskip("pyvista")
    from PIL import Image

    law = sg.Plastic(8.0, hardening=100.0)
    bodies = [replace(body, material=replace(body.material, plastic=law)) for body in solution.model.bodies[1:]]
    soft = replace(solution.model, bodies=[solution.model.bodies[0], *bodies])
    sg.solve(soft).view(tmp_path / "view.png")
    with Image.open(tmp_path / "view.png") as picture:
        pixels = np.asarray(picture.convert("RGB")).astype(int)
    assert pixels.shape == (1000, 3000, 3)
    stress, strain, contact = (part[:900] for part in np.split(pixels, 3, axis=1))  # above the colour bars
    dark = np.array([68, 1, 84])  # nothing, in viridis: in the elastic body, whose stress is something
    assert (np.abs(strain - dark).max(axis=2) < 40).mean() > (np.abs(stress - dark).max(axis=2) < 40).mean() + 0.05
    assert len(np.unique(strain[300:700, 300:700].reshape(-1, 3) // 16, axis=0)) > 20
    assert (contact != strain).any()


def test_a_view_says_what_it_needs(solution, tmp_path, monkeypatch):
    with pytest.raises(InputError, match=r"expected a name that ends in \.png"):
        solution.view(tmp_path / "view.pdf")
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(InputError, match=r"needs PyVista, which is not installed; pip install 'signorini\[view\]'"):
        solution.view(tmp_path / "view.png")
    plane = sg.Model(
        sg.rectangle(width=1, height=1, nx=1, ny=1),
        bodies=[sg.Body("block", sg.Elastic(E=1, nu=0))],
        supports=[sg.Support("left", u=(0, 0))],
        loads=[sg.Load("right", traction=(1.0, 0.0))],
    )
    with pytest.raises(InputError, match="shows models in space; expected 'stress'"):
        sg.solve(plane).view(tmp_path / "view.png")
    assert not list(tmp_path.iterdir())

# SPDX-License-Identifier: BSD-3-Clause
"""A view of bodies in space and of their contact, rendered off-screen by PyVista (the extra ``signorini[view]``)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from signorini.arrays import Array, IntArray
from signorini.errors import InputError
from signorini.output.atomic_write import atomic_write
from signorini.plot.components import Scalar
from signorini.plot.field import factor_words
from signorini.plot.patch import Patch
from signorini.plot.picture_data import PictureData
from signorini.plot.shots import Shot, contact_shot, deformed, whole_shot
from signorini.plot.style import INK, named

_PANEL_SIZE = 1000  # pixels
_ARROW_LENGTH = 0.12  # of what is shown: of the largest friction
_LIFT = 0.004  # of what is shown, towards the eye: lines and arrows are not swallowed by the surface
_LAMP = np.array([-0.45, 0.75, 0.6])  # to the right, up, towards the eye
_BODY = "#d3dae2"
_SURFACE = {"smooth_shading": True, "split_sharp_edges": True, "ambient": 0.64, "diffuse": 0.38, "specular": 0.04}
_BAR = {
    "color": INK,
    "vertical": False,
    "height": 0.12,
    "width": 0.5,
    "position_x": 0.25,
    "position_y": 0.02,
    "title_font_size": 20,
    "label_font_size": 17,
    "fmt": "%.4g",
    "n_labels": 4,
}


def write_view(data: PictureData, path: Path) -> None:
    """Write a picture: von Mises stress on the deformed bodies, pressure and friction of the contact beside.

    Between them the equivalent plastic strain, where bodies have yielded.

    Raises
    ------
    InputError
        If the name ends otherwise, PyVista is not installed, or the model is plane.
    """
    from matplotlib.image import imsave

    if path.suffix.lower() != ".png":
        raise InputError(f"is '{path}'; expected a name that ends in .png", where=("path",))
    pixels = _rendered(data)
    with atomic_write(path) as aside:
        imsave(aside, pixels)


def _rendered(data: PictureData) -> NDArray[np.uint8]:
    """Pixels, (height, width, 3)."""
    if not data.solid:
        raise InputError("shows models in space; expected 'stress' for one in the plane", where=("view",))
    pyvista = _pyvista()
    whole, contact = whole_shot(data), contact_shot(data)
    scalars = [data.stress, *([data.peeq] if data.yielded.any() else [])]
    panels = len(scalars) + (contact is not None)
    size = (_PANEL_SIZE * panels, _PANEL_SIZE)
    plotter = pyvista.Plotter(off_screen=True, shape=(1, panels), window_size=size, border=False, lighting="none")
    try:
        plotter.set_background("white")
        plotter.enable_anti_aliasing("ssaa")
        for column, scalar in enumerate(scalars):
            plotter.subplot(0, column)
            _field(plotter, pyvista, data, whole, scalar)
        if contact is not None:
            plotter.subplot(0, panels - 1)
            _contact(plotter, pyvista, data, contact)
        return np.asarray(plotter.screenshot(return_img=True), dtype=np.uint8)
    finally:
        plotter.close()


def _pyvista() -> Any:
    """The package, which is no dependency."""
    try:
        import pyvista
        from vtkmodules.vtkCommonCore import vtkLogger
    except ImportError as error:
        raise InputError(
            "needs PyVista, which is not installed; pip install 'signorini[view]'", where=("view",)
        ) from error
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)  # it says which ways to render it has tried
    return pyvista


def _field(plotter: Any, pyvista: Any, data: PictureData, shot: Shot, scalar: Scalar) -> None:
    """The bodies, deformed, and a field on their skin."""
    skin = shot.skin
    factor, points = deformed(data, shot)
    surface = _surface(pyvista, skin.pieces, points)
    surface[_title(scalar.words.format(""), data)] = values = skin.values(scalar.values)
    limits = (0.0, float(values.max()) or 1.0)
    plotter.add_mesh(surface, cmap="viridis", clim=limits, scalar_bar_args=_BAR, **_SURFACE)
    _edges(plotter, pyvista, shot, points, "white", 0.25)
    _look(plotter, pyvista, shot, points, ", ".join([*filter(None, [data.model.title]), factor_words(factor)]))


def _contact(plotter: Any, pyvista: Any, data: PictureData, shot: Shot) -> None:
    """The pressure on the contact surface, undeformed, and the friction on it."""
    points = shot.skin.points
    plotter.add_mesh(_surface(pyvista, shot.skin.part(~shot.contact).pieces, points), color=_BODY, **_SURFACE)
    _edges(plotter, pyvista, shot, points, "#404040", 0.25)
    (patch,) = [patch for patch in data.patches if f"'{patch.contact}'" in shot.title]
    surface = _surface(pyvista, patch.faces, patch.points)
    surface[_title("pressure, force per area", data)] = patch.pressure
    limits = (0.0, float(patch.pressure.max()) or 1.0)
    plotter.add_mesh(surface, cmap="OrRd", clim=limits, lighting=False, scalar_bar_args=_BAR)
    _friction(plotter, pyvista, patch, shot)
    _look(plotter, pyvista, shot, points, shot.title)


def _title(words: str, data: PictureData) -> str:
    """Words above a bar of colours; the line that ends keeps them off its numbers."""
    return f"{named(words, data.units)}\n"


def _surface(pyvista: Any, faces: IntArray, points: Array) -> Any:
    """Faces (m, 4), of which triangles have their last point twice."""
    flat = faces[:, 2] == faces[:, 3]
    parts = [np.insert(cells, 0, cells.shape[1], axis=1).ravel() for cells in (faces[~flat], faces[flat, :3])]
    return pyvista.PolyData(points, np.concatenate(parts))


def _edges(plotter: Any, pyvista: Any, shot: Shot, points: Array, colour: str, opacity: float) -> None:
    """Edges of the mesh, and those of the bodies stronger."""
    crease, front = shot.skin.sharp, points + _lift(shot, points)
    for own, ink, strength, width in ((~crease, colour, opacity, 1.0), (crease, "#1a1a1a", 0.9, 2.0)):
        if own.any():
            lines = pyvista.PolyData(front, lines=np.insert(shot.skin.edges[own], 0, 2, axis=1).ravel())
            plotter.add_mesh(lines, color=ink, opacity=strength, line_width=width, lighting=False)


def _friction(plotter: Any, pyvista: Any, patch: Patch, shot: Shot) -> None:
    """Arrows at the nodes that rub; none without friction."""
    some, points = patch.arrows, shot.skin.points
    if not len(some):
        return
    arrows = pyvista.PolyData(patch.points[some] + 4.0 * _lift(shot, points))
    arrows["friction"] = patch.shear[some]
    longest = float(np.linalg.norm(patch.shear, axis=1).max())
    size = shot.size(points)
    glyphs = arrows.glyph(orient="friction", scale="friction", factor=_ARROW_LENGTH * size / longest)
    plotter.add_mesh(glyphs, color=INK, lighting=False)


def _lift(shot: Shot, points: Array) -> Array:
    return _LIFT * shot.size(points) * shot.camera.towards


def _look(plotter: Any, pyvista: Any, shot: Shot, points: Array, words: str) -> None:
    """Parallel projection of what the shot shows, with directions and words."""
    low, high = shot.frame(points)
    axes, size = shot.camera.axes, float((high - low).max())
    middle = np.append(0.5 * (low + high), shot.camera.depth(points).mean()) @ axes
    plotter.camera.position = tuple(middle + 20.0 * size * axes[2])
    plotter.camera.focal_point = tuple(middle)
    plotter.camera.up = tuple(axes[1])
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = 0.62 * size
    plotter.reset_camera_clipping_range()
    lamp = middle + 20.0 * size * (_LAMP @ axes)
    plotter.add_light(pyvista.Light(position=tuple(lamp), focal_point=tuple(middle), light_type="scene light"))
    plotter.add_axes(color=INK, x_color=INK, y_color=INK, z_color=INK, xlabel="x", ylabel="y", zlabel="z", line_width=2)
    plotter.add_text(words, position="upper_left", font_size=12, color=INK)

# SPDX-License-Identifier: BSD-3-Clause
"""Boundaries of a mesh on the curves and faces of the geometry that it was made of, by Gmsh where that is installed."""

from __future__ import annotations

import weakref
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from signorini.accuracy.rest_of_skin import REST
from signorini.arrays import Array, BoolArray, IntArray
from signorini.errors import InputError, brief
from signorini.meshing.facets import facet_corners
from signorini.meshing.geo import SUFFIX, check_harmless
from signorini.meshing.simplices import Curve
from signorini.model.mesh import Mesh

_ON_IT = 1e-5
"""Of the size of a mesh: how far its nodes may be from the geometry; files have few digits."""

_FLAT_KINDS = ("Line", "Plane")
"""What Gmsh calls curves and faces that facets lie on as they are."""

_WHERE = ("accuracy", "geometry")


class GmshGeometry:
    """An open geometry; Gmsh has one at a time, which is closed with this.

    Parameters
    ----------
    path : ``.geo``, ``.step`` or ``.brep``

    Raises
    ------
    InputError
        If Gmsh is not installed, or cannot read it.
    """

    def __init__(self, path: Path) -> None:
        try:
            import gmsh
        except (ImportError, OSError) as error:  # the wheel needs libraries of the system
            words = f"'{path}' is a geometry, which Gmsh knows, and there is no Gmsh ({brief(error)})"
            raise InputError(f"{words}; expected pip install 'signorini[gmsh]'", where=_WHERE) from None
        if not path.is_file():
            raise InputError(f"there is no file '{path}'", where=_WHERE)
        if path.suffix.lower() == SUFFIX:
            check_harmless(path)
        self._gmsh: Any = gmsh
        gmsh.initialize(interruptible=False)
        self._close = weakref.finalize(self, gmsh.finalize)
        try:
            gmsh.option.setNumber("General.Terminal", 0)
            gmsh.open(str(path))
        except Exception as error:  # Gmsh knows no other
            self._close()
            raise InputError(f"Gmsh cannot read '{path}': {brief(error)}", where=_WHERE) from error
        self.path = path

    def curves(self, mesh: Mesh, given: Mapping[str, object]) -> dict[str, Curve]:
        """Of every boundary of bodies that is not flat the entities that its corners lie on.

        Parameters
        ----------
        mesh : that was made of the geometry
        given : boundaries whose shape is known

        Raises
        ------
        InputError
            If a corner of a boundary is not on the geometry.
        """
        d, found = mesh.points.shape[1], dict[str, Curve]()
        entities = [tag for _, tag in self._gmsh.model.getEntities(d - 1)]
        near = _ON_IT * float(np.ptp(mesh.points, axis=0).max())
        for name in mesh.boundaries:
            if name in given or mesh.bounds_nothing(name):
                continue
            corners = [own[:, : facet_corners(d, own.shape[1])].ravel() for own in mesh.facets(name)]
            nodes = np.unique(np.concatenate(corners))
            away = np.array([self.distances(mesh.points[nodes], tag) for tag in entities]).reshape(-1, len(nodes))
            off = away.min(axis=0, initial=np.inf) > near
            if off.any() and name == REST:  # of a mesh that was cut or mirrored since: nobody said that it follows
                continue
            if off.any():
                label, path = mesh.labels[nodes[np.argmax(off)]], self.path
                raise InputError(
                    f"node {label} of boundary '{name}' is not on '{path}'; expected a mesh of it", where=_WHERE
                )
            own = self._of_facets(mesh, name, nodes, away <= near)
            tags = tuple(entities[i] for i in own)
            if any(self._gmsh.model.getType(d - 1, tag) not in _FLAT_KINDS for tag in tags):
                found[name] = GeometryCurve(self, tags)
        return found

    def _of_facets(self, mesh: Mesh, name: str, nodes: IntArray, on: BoolArray) -> list[int]:
        """Entities (k, nodes) that all corners of some facet are on."""
        d, own = mesh.points.shape[1], set[int]()
        for facets in mesh.facets(name):
            at = np.searchsorted(nodes, facets[:, : facet_corners(d, facets.shape[1])])
            whole = np.asarray(on[:, at].all(axis=2), dtype=np.bool_)
            own |= set(np.flatnonzero(np.asarray(whole.any(axis=1))).tolist())
        return sorted(own)

    def nearest(self, points: Array, tag: int) -> Array:
        """The points (k, d) of an entity that are nearest to points (k, d)."""
        d = points.shape[1]
        places = np.zeros((len(points), 3))
        places[:, :d] = points
        found, _ = self._gmsh.model.getClosestPoint(d - 1, tag, places.ravel().tolist())
        return np.asarray(np.reshape(found, (-1, 3))[:, :d])

    def distances(self, points: Array, tag: int) -> Array:
        """(k,) Of points (k, d) from an entity, length."""
        return np.asarray(np.linalg.norm(self.nearest(points, tag) - points, axis=1))


class GeometryCurve:
    """Entities of a geometry that a boundary is made of.

    Parameters
    ----------
    geometry : open
    tags : of the entities
    """

    def __init__(self, geometry: GmshGeometry, tags: tuple[int, ...]) -> None:
        self._geometry, self._tags = geometry, tags

    def __call__(self, points: Array) -> Array:
        """The nearest points of it to points (k, d)."""
        if not len(points):
            return points
        found = np.array([self._geometry.nearest(points, tag) for tag in self._tags])
        best = np.argmin(np.linalg.norm(found - points, axis=2), axis=0)
        return np.asarray(found[best, np.arange(len(points))])

    def __str__(self) -> str:
        return f"the geometry '{self._geometry.path.name}'"

# SPDX-License-Identifier: BSD-3-Clause
"""Nodes that forces are given at, one by one: the same on every finer mesh."""

from __future__ import annotations

from dataclasses import replace

from signorini.arrays import IntArray
from signorini.errors import InputError
from signorini.meshing.simplices import corner_numbers
from signorini.model.conditions import Load
from signorini.model.mesh import Mesh
from signorini.model.model import Model


class KeptNodes:
    """Node sets of their own for loads that are given node by node: other sets grow with the mesh.

    Parameters
    ----------
    model : on the mesh to begin with

    Attributes
    ----------
    model : with these sets

    Raises
    ------
    InputError
        For a force at the middle of an edge, which finer meshes have not.
    """

    def __init__(self, model: Model) -> None:
        mesh, corners = model.mesh, corner_numbers(model.mesh)
        loads, sets = list[Load](), dict[str, IntArray]()
        self._kept = dict[str, IntArray]()
        for i, load in enumerate(model.loads):
            if load.nodal_forces is None or not isinstance(load.on, str):
                loads.append(load)
                continue
            nodes = mesh.nodes_of(load.on)
            if (corners[nodes] < 0).any():
                label = mesh.labels[nodes[corners[nodes] < 0][0]]
                words = f"are at node {label}, the middle of an edge; expected corners where the mesh is refined"
                raise InputError(words, where=("load", i, "nodal_forces"))
            name = f"nodes of load {i}"
            sets[name], self._kept[name] = nodes, corners[nodes]
            loads.append(replace(load, on=name, name=load.label))
        self.model = model
        if sets:
            self.model = replace(model, mesh=replace(mesh, nodes={**mesh.nodes, **sets}), loads=loads)

    def on(self, mesh: Mesh) -> Mesh:
        """A finer mesh with these nodes alone in their sets."""
        return replace(mesh, nodes={**mesh.nodes, **self._kept}) if self._kept else mesh

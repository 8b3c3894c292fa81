# SPDX-License-Identifier: BSD-3-Clause
"""Cells at the facets that touch: what a contact loses between its nodes, halving these cells tells."""

from __future__ import annotations

from itertools import chain

import numpy as np
from scipy.spatial import cKDTree

from signorini.arrays import Array, BoolArray, IntArray, among
from signorini.model.model import Model
from signorini.solution.history import History
from signorini.solution.results import ContactResult


def touching_cells(history: History, cells: IntArray) -> BoolArray:
    """(m,) Which cells have a corner that touches at the end of some step: those beyond the ends of a contact too.

    Parameters
    ----------
    history : whose contacts touch
    cells : (m, d + 1) corners, of the simplices of its mesh
    """
    model = history.model
    touching = [_corners(model, result) for step in history.steps for result in step.contacts]
    return np.asarray(among(list(chain.from_iterable(touching)), len(model.mesh.points))[cells].any(axis=1))


def _corners(model: Model, result: ContactResult) -> list[IntArray]:
    """Nodes of both sides that touch: on the mortar side, of a body, those to which a pair that does is the nearest."""
    closed, points = result.closed, model.mesh.points
    found = [result.node[closed]]
    if result.coupling != "obstacle" and not model.mesh.bounds_nothing(result.mortar):
        opposite = model.mesh.nodes_of(result.mortar)
        found.append(opposite[closed[_nearest(points[result.node], points[opposite])]])
    return found


def _nearest(among_these: Array, to: Array) -> IntArray:
    """(k,) Number of the nearest of some points (n, d) to each of others (k, d)."""
    return np.asarray(cKDTree(among_these).query(to)[1])

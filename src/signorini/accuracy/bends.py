# SPDX-License-Identifier: BSD-3-Clause
"""What pressures in the plane lack where what a side touches bends: between nodes no stress tells it."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.fem.elasticity import elasticities
from signorini.model.model import Model
from signorini.solution.obstacle_result import ObstacleMotion
from signorini.solution.results import ContactResult


def bend_squares(corners: IntArray, result: ContactResult, moved: Array, modulus: float) -> tuple[Array, Array]:
    """Squares of what pressures and frictions lack at bends, on the mean of every facet, (m,) force squared per area^2.

    Normals of pairs are those before bodies move. Where their curvature jumps by k, a node that has moved along them
    by u meets a bend ``s = k u``, as they see it, and pressures there go to minus infinity as ``A log |x|`` with
    ``A = E* s / (2 pi)``, whose square is A^2 about its mean on any length from 0 on. Bends that are smeared over the
    nodes of a facet count together; pairs that slip have friction in proportion.

    Parameters
    ----------
    corners : (m, 2) nodes of the facets
    result : of the contact
    moved : (n, 2) of its nodes beside what is opposite, since before anything moved, length
    modulus : E*, force per area

    Examples
    --------
    A plane that goes over into a circle of radius 2 at the node in the middle, which has moved by 0.1:

    >>> from types import SimpleNamespace
    >>> points = np.array([[-1.0, 0.0], [0.0, 0.0], [1.0, 0.0]])
    >>> normals = np.array([[0.0, 1.0], [0.0, 1.0], [np.sin(0.5), np.cos(0.5)]])
    >>> touching = SimpleNamespace(node=np.arange(3), points=points, normals=normals, pressure=np.ones(3),
    ...                            shear=np.zeros((3, 2)), closed=np.ones(3, bool))
    >>> moved = np.array([[0.1, 0.0]] * 3)
    >>> squares, _ = bend_squares(np.array([[0, 1], [1, 2]]), touching, moved, modulus=2.0 * np.pi)
    >>> np.sqrt(squares).round(3).tolist()
    [0.048, 0.048]
    """
    place = np.full(int(max(corners.max(), result.node.max())) + 1, -1)
    place[result.node[result.closed]] = np.flatnonzero(result.closed)
    touching = (place[corners] >= 0).all(axis=1)
    first, second = place[corners[touching]].T
    normals = result.normals[:, :2]
    across = np.column_stack([-normals[:, 1], normals[:, 0]])
    span = result.points[second] - result.points[first]
    ahead = np.sign(np.einsum("ki,ki->k", span, across[first]))
    turned = normals[first, 0] * normals[second, 1] - normals[first, 1] * normals[second, 0]
    curvature = ahead * turned / np.linalg.norm(span, axis=1)
    jump = sum(np.bincount(end, way * curvature, len(normals)) for end, way in ((first, ahead), (second, -ahead)))
    inside = np.bincount(np.concatenate([first, second]), minlength=len(normals)) > 1
    bend = np.where(inside, jump * np.einsum("ni,ni->n", moved, across), 0.0)
    own = (modulus * (bend[first] + bend[second]) / (2.0 * np.pi)) ** 2
    pressing, rubbing = (
        part[first] ** 2 + part[second] ** 2 for part in (result.pressure, np.linalg.norm(result.shear, axis=1))
    )
    found = np.zeros((2, len(corners)))
    found[:, touching] = own, own * rubbing / np.where(pressing > 0.0, pressing, 1.0)
    return found[0], found[1]


def driven_motion(model: Model, number: int, points: Array, motions: Mapping[str, ObstacleMotion]) -> Array:
    """(n, 2) Displacement of what is rigid and opposite to points of a contact of the plane, length.

    Parameters
    ----------
    model : with the contact
    number : of it
    points : (n, 2)
    motions : of moving obstacles by name

    Examples
    --------
    >>> from signorini.gallery import coarse
    >>> driven_motion(coarse.cylinder(), 0, np.zeros((1, 2)), {}).tolist()
    [[0.0, 0.0]]
    """
    about = {obstacle.label: np.array(obstacle.about) for obstacle in model.obstacles}
    name = str(model.contacts[number].mortar)
    if name not in about or name not in motions:
        return np.zeros_like(points)
    motion, lever = motions[name], points - about[name]
    turn = float(np.ravel(motion.rotation)[-1]) if model.components == 2 else 0.0
    return np.asarray(motion.displacement[:2] + turn * np.column_stack([-lever[:, 1], lever[:, 0]]))


def contact_modulus(model: Model, bodies: list[int]) -> float:
    """E* of bodies that touch, of each ``E / (1 - nu^2)`` in plane strain and E in plane stress, force per area.

    Parameters
    ----------
    model : of the bodies
    bodies : their numbers, one beside an obstacle

    Examples
    --------
    >>> from signorini.gallery import coarse
    >>> model = coarse.cylinder()
    >>> round(contact_modulus(model, [0]) * (1.0 - 0.3**2), 9)
    200.0
    """
    D = elasticities(model)[bodies]
    return float(1.0 / (1.0 / (D[:, 0, 0] - D[:, 0, 1] ** 2 / D[:, 0, 0])).sum())

# SPDX-License-Identifier: BSD-3-Clause
"""Stiffness matrices of small lattices of springs with bending: any dimension, any supports, any number of bodies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse


@dataclass(frozen=True, kw_only=True)
class Problem:
    K: sparse.csr_array
    interface: np.ndarray
    nodes: np.ndarray
    points: np.ndarray
    """Coordinates of the node of every unknown."""
    component: np.ndarray


def lattice(shape, *, held="bottom", seed=0):
    """A grid of nodes joined to all neighbours by bars of random stiffness.

    held: "bottom" (all components of the lowest nodes), "roller" (there, one component only, and one node fully),
    or "none". The interface is the top layer.
    """
    rng = np.random.default_rng(seed)
    d = len(shape)
    grid = np.stack([a.ravel() for a in np.meshgrid(*[np.arange(k) for k in shape], indexing="ij")], axis=1)
    n = len(grid)
    steps = np.stack([a.ravel() for a in np.meshgrid(*[[-1, 0, 1]] * d, indexing="ij")], axis=1)
    strides = np.append(np.cumprod(shape[:0:-1])[::-1], 1)
    B_rows, B_cols, B_vals, count = [], [], [], 0
    for step in steps[len(steps) // 2 + 1 :]:
        other = grid + step
        ok = np.all((other >= 0) & (other < shape), axis=1)
        i, j = np.flatnonzero(ok), other[ok] @ strides
        bars = count + np.arange(len(i))
        count += len(i)
        for axis in range(d):
            value = step[axis] / np.linalg.norm(step)
            if value:
                B_rows += [bars, bars]
                B_cols += [i * d + axis, j * d + axis]
                B_vals += [np.full(len(i), -value), np.full(len(i), value)]
    B = sparse.csr_array(
        (np.concatenate(B_vals), (np.concatenate(B_rows), np.concatenate(B_cols))), shape=(count, n * d)
    )
    K = (B.T @ sparse.diags_array(rng.uniform(0.5, 2.0, count)) @ B).tocsr()
    low = grid[:, -1] == 0
    component = np.tile(np.arange(d), n)
    nodes = np.repeat(np.arange(n), d)
    keep = {
        "bottom": ~np.repeat(low, d),
        "roller": ~(np.repeat(low, d) & ((component == d - 1) | (nodes == 0))),
        "none": np.ones(n * d, dtype=bool),
    }[held]
    kept = np.flatnonzero(keep)
    top = np.repeat(grid[:, -1] == shape[-1] - 1, d)[kept]
    return Problem(
        K=K[kept][:, kept].tocsr(),
        interface=np.flatnonzero(top),
        nodes=nodes[kept],
        points=np.repeat(grid, d, axis=0)[kept].astype(float),
        component=component[kept],
    )


def together(*parts):
    """Several bodies that do not touch, their unknowns shuffled."""
    K = sparse.block_diag([p.K for p in parts], format="csr")
    offset = np.cumsum([0] + [p.K.shape[0] for p in parts])
    node_offset = np.cumsum([0] + [p.nodes.max() + 1 for p in parts])
    interface = np.concatenate([p.interface + o for p, o in zip(parts, offset, strict=False)])
    shuffle = np.random.default_rng(1).permutation(K.shape[0])
    back = np.argsort(shuffle)
    return Problem(
        K=sparse.csr_array(K[shuffle][:, shuffle]),
        interface=back[interface],
        nodes=np.concatenate([p.nodes + o for p, o in zip(parts, node_offset, strict=False)])[shuffle],
        points=_stack([p.points for p in parts])[shuffle],
        component=np.concatenate([p.component for p in parts])[shuffle],
    )


def rigid_motions(problem):
    """Translations and rotations of all of `points`, (n, 3) in 2D, (n, 6) in 3D."""
    d = problem.points.shape[1]
    motions = [(problem.component == a).astype(float) for a in range(d)]
    for a in range(d):
        for b in range(a):
            turn = np.where(problem.component == a, problem.points[:, b], 0.0)
            motions.append(turn - np.where(problem.component == b, problem.points[:, a], 0.0))
    return np.stack(motions, axis=1)


def dense_schur(K, interface):
    K = K.toarray()
    inside = np.setdiff1d(np.arange(len(K)), interface)
    return K[np.ix_(interface, interface)] - K[np.ix_(interface, inside)] @ np.linalg.solve(
        K[np.ix_(inside, inside)], K[np.ix_(inside, interface)]
    )


def _stack(points):
    d = max(p.shape[1] for p in points)
    return np.concatenate([np.pad(p, ((0, 0), (0, d - p.shape[1]))) for p in points])

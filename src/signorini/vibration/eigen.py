# SPDX-License-Identifier: BSD-3-Clause
"""The lowest eigenvalues of ``K v = omega^2 M v`` under constraints: Lanczos on the inverse, counted by inertia.

References
----------
Ericsson, Ruhe (1980), The spectral transformation Lanczos method for the numerical solution of large sparse
generalized symmetric eigenvalue problems, Math. Comp. 35:1251.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg
import scipy.sparse as sp
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

from signorini.arrays import Array
from signorini.errors import InputError, SolveFailed
from signorini.linalg.inertia import negative_eigenvalues
from signorini.outcome import Outcome
from signorini.vibration.inverse import JointInverse

_DENSE_SIZE = 300  # unknowns up to which all eigenvalues are computed at once: faster than Lanczos' method
_MODES_BEYOND = 3  # modes more than asked for: one of the gaps behind the last is where they are counted
_COUNTED_SIZE = 150_000  # unknowns up to which modes are counted: factors of no definite sign take a second each 1e5
_MASSLESS = 1e-13  # of the largest 1 / (omega^2 + s): what has no mass has smaller ones
_CLUSTER = 1e-7  # of omega^2 + s: nearer modes are not told apart by an inertia
RUNS = 2
"""Of Lanczos' method: once more with as many modes more as are missing."""

RESTARTS = 1000
"""Of one run."""

_IN_GAP = (0.5, 0.37, 0.61)  # places in a gap, where another one breaks down

Pairs = tuple[Array, Array]
"""Eigenvalues (k,), ascending, and eigenvectors (z, k), mass-normalised."""


def lowest(inverse: JointInverse, count: int) -> tuple[Pairs, int | None]:
    """The lowest modes, and how many below the last one are missing; None: not counted.

    Parameters
    ----------
    inverse : of the bodies with their joint
    count : modes that are asked for

    Raises
    ------
    InputError
        If the bodies have fewer.
    """
    size = inverse.K.shape[0]
    if size <= max(_DENSE_SIZE, 3 * (count + _MODES_BEYOND)):
        squares, vectors = _all(inverse)
        if len(squares) < count:
            raise InputError(f"is {count}; the model has {len(squares)} modes", where=("number",))
        return (squares[:count], vectors[:, :count]), 0
    asked, missed = count + _MODES_BEYOND, None
    for _ in range(RUNS):
        squares, vectors = _some(inverse, asked)
        missed = _missed(inverse, squares, count) if size <= _COUNTED_SIZE else None
        if not missed:
            break
        asked += missed
    return (squares[:count], vectors[:, :count]), missed


def _all(inverse: JointInverse) -> Pairs:
    """Every mode, by ``Q^T P Q`` with ``M = Q Q^T`` and P the inverse: its eigenvalues are ``1 / (omega^2 + s)``."""
    M = inverse.shifted.bodies.M.toarray()
    share, axes = np.linalg.eigh(M)
    Q = axes * np.sqrt(np.maximum(share, 0.0))
    PQ = inverse(Q)
    H = Q.T @ PQ
    found, inner = scipy.linalg.eigh(0.5 * (H + H.T))
    kept = np.flatnonzero(found > _MASSLESS * found[-1])[::-1]
    vectors = PQ @ (inner[:, kept] / found[kept])
    return 1.0 / found[kept] - inverse.shifted.shift, vectors


def _some(inverse: JointInverse, count: int) -> Pairs:
    """The lowest modes, by Lanczos' method."""
    size, shift = inverse.K.shape[0], inverse.shifted.shift
    operator = LinearOperator((size, size), matvec=inverse, dtype=np.float64)
    start = inverse(np.random.default_rng(0).uniform(0.5, 1.5, size))
    M = inverse.shifted.bodies.M
    try:
        squares, vectors = eigsh(
            inverse.K, count, M=M, sigma=-shift, OPinv=operator, v0=start, tol=0.0, maxiter=RESTARTS
        )
    except ArpackNoConvergence as error:
        raise SolveFailed(
            f"{len(error.eigenvalues)} of {count} modes were found in {RESTARTS} restarts of Lanczos' method",
            status=Outcome.NOT_FOUND,
        ) from error
    order = np.argsort(squares)
    return squares[order], vectors[:, order]


def _missed(inverse: JointInverse, squares: Array, count: int) -> int | None:
    """Modes below a place between two of those found, at or behind the last asked for, that are not among them."""
    shift = inverse.shifted.shift
    gaps = np.diff(squares[count - 1 :]) / (squares[count:] + shift)
    below = count + int(np.argmax(gaps))
    if gaps.max() < _CLUSTER:
        return None
    for part in _IN_GAP:
        sigma = (1.0 - part) * squares[below - 1] + part * squares[below]
        found = _below(inverse, sigma)
        if found is not None:
            return max(found - below, 0)
    return None


def _below(inverse: JointInverse, sigma: float) -> int | None:
    """How many omega^2 are below sigma: the negative eigenvalues of ``K - sigma M`` where the joint holds."""
    bodies, held = inverse.shifted.bodies, inverse.ties.B
    size, number = inverse.K.shape[0], held.shape[0]
    A = sp.csr_array(inverse.K - sigma * bodies.M)
    if number:
        A = sp.csr_array(sp.block_array([[A, held.T], [held, None]], format="csr"))
    last = np.concatenate([inverse.shifted.dofs, size + np.arange(number)])
    places = bodies.space.places
    nodes = np.concatenate([bodies.constraints.nodes, len(places) + np.arange(number)])
    points = np.concatenate([places, np.zeros((number, places.shape[1]))])
    found = negative_eigenvalues(A, last, nodes, points)
    return None if found is None else found - number

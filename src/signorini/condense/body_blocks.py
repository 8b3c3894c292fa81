# SPDX-License-Identifier: BSD-3-Clause
"""The condensed bodies part by part: what they resist with on their contact dofs, and how they yield to forces there.

The condensed stiffness is block diagonal, for bodies feel each other through their contacts alone: parts are factorised
one by one. Where nothing but contact holds a part its block is singular; springs on its rigid motions Z hold it then,
``S + rho Z Z^T`` with Z orthonormal. They carry nothing under balanced forces, ``Z^T f = 0``, so that what the part
yields to those is right but for a rigid motion, which is for the contact to find.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg
import scipy.sparse as sp

from signorini.arrays import Array, IntArray
from signorini.dense import solve_cholesky, solve_triangular
from signorini.linalg._dense_tiles import mirror
from signorini.linalg.shared_dense import add_product, cholesky, inverse_of_cholesky
from signorini.sparse_rows import chosen_columns, chosen_rows

DEPENDENT = 1e-10  # of the largest: what is left of a motion that follows from the others


@dataclass(frozen=True, kw_only=True, eq=False)
class BodyBlock:
    """One block.

    Attributes
    ----------
    dofs : (p,) its contact dofs, ascending
    upper : (p, p) U of ``U^T D U``, its stiffness with the springs, by columns: ones on the diagonal are not there, so
        that on it and below there is room for something else
    pivots : (p,) D
    known : (p, p) the inverse of that stiffness, where it is wanted again and again; None: made when it is
    """

    dofs: IntArray
    upper: Array
    pivots: Array
    known: Array | None = None

    def solve(self, load: Array) -> Array:
        """Displacements (p, ...) under a load (p, ...)."""
        half = solve_triangular(self.upper, load, transposed=True, unit=True)
        return solve_triangular(self.upper, (half.T / self.pivots).T, unit=True)

    @property
    def inverse(self) -> Array:
        """(p, p) Of its stiffness with the springs."""
        if self.known is not None:
            return self.known
        lower, root = np.array(self.upper.T, order="F"), np.sqrt(self.pivots)
        lower *= root
        lower[np.diag_indices_from(lower)] = root
        return inverse_of_cholesky(lower, overwrite=True)


@dataclass(frozen=True, kw_only=True, eq=False)
class BodyBlocks:
    """All blocks, and the ties between them.

    Attributes
    ----------
    blocks : parts that no tie and no stiffness joins
    across : (m, t) what forces of the ties move
    gram : Cholesky factor of what they move of themselves, (t, t)
    """

    blocks: tuple[BodyBlock, ...]
    across: Array
    gram: Array

    def solve(self, load: Array) -> Array:
        """Displacements (m, ...) under a load (m, ...) that leave the ties at rest."""
        moved = np.zeros_like(load)
        for part in self.blocks:
            moved[part.dofs] = part.solve(load[part.dofs])
        if self.across.shape[1]:
            moved -= self.across @ solve_cholesky(self.gram, self.across.T @ load)
        return moved

    def inverted(self) -> BodyBlocks:
        """Blocks with their inverses, for pairs that change."""
        return replace(self, blocks=tuple(replace(own, known=own.inverse) for own in self.blocks))

    def compliance(self, B: sp.csr_array) -> Array:
        """``B M^-1 B^T`` of the stiffness M with its ties, (k, k), symmetric to the last digit; B (k, m)."""
        result = np.zeros((B.shape[0],) * 2)
        for part in self.blocks:
            own = B if len(part.dofs) == B.shape[1] else chosen_columns(B, part.dofs)
            seen = np.flatnonzero(np.diff(own.indptr))
            own = own if len(seen) == len(result) else chosen_rows(own, seen)
            half = own @ part.inverse.T  # the inverse is as large as what is made of it, like all below
            half = np.ascontiguousarray(half.T)
            moved = own @ half
            del half
            if len(seen) == len(result):
                result += moved
            else:
                result[np.ix_(seen, seen)] += moved
        if self.across.shape[1]:
            moved = solve_triangular(self.gram, (B @ self.across).T, lower=True)
            result -= moved.T @ moved
        mirror(result, 0, len(result))
        return result


def make_body_blocks(stiffness: Array, ties: Array, rigid: Array, *, size: float) -> BodyBlocks:
    """Factorise.

    Parameters
    ----------
    stiffness : (m, m) S, symmetric; overwritten
    ties : (t, m) B_t on the contact dofs, independent rows
    rigid : (m, k) rigid motions that neither supports nor ties resist
    size : of a stiffness, for springs and ties

    Raises
    ------
    LinAlgError
        If anything else moves without resistance.

    Examples
    --------
    Two nodes, one on a spring of stiffness 4, the other free; each is a part:

    >>> parts = make_body_blocks(np.diag([4.0, 0.0]), np.zeros((0, 2)), np.array([[0.0], [1.0]]), size=1.0)
    >>> [part.dofs.tolist() for part in parts.blocks], parts.solve(np.array([1.0, 0.0])).tolist()
    ([[0], [1]], [0.25, 0.0])
    """
    if len(ties):
        stiffness += size * (ties.T @ ties)
    blocks = tuple(_block(stiffness, dofs, rigid[dofs], size) for dofs in independent(stiffness))
    untied = BodyBlocks(blocks=blocks, across=np.zeros((len(rigid), 0)), gram=np.zeros((0, 0)))
    if not len(ties):
        return untied
    across = untied.solve(ties.T)
    gram = np.asarray(np.linalg.cholesky(ties @ across), dtype=np.float64)
    return BodyBlocks(blocks=blocks, across=across, gram=gram)


def independent(matrix: Array) -> list[IntArray]:
    """Rows of the diagonal blocks of a symmetric matrix, each ascending.

    >>> [rows.tolist() for rows in independent(np.array([[1.0, 0.0, 2.0], [0.0, 3.0, 0.0], [2.0, 0.0, 4.0]]))]
    [[0, 2], [1]]
    """
    blocks: list[IntArray] = []
    left = np.ones(len(matrix), dtype=np.bool_)
    while left.any():
        block = np.zeros_like(left)
        new = np.array([int(np.argmax(left))])
        while len(new):
            block[new] = True
            if block[left].all():
                break
            new = np.flatnonzero((matrix[new] != 0.0).any(axis=0) & ~block)
        blocks.append(np.flatnonzero(block))
        left &= ~block
    return blocks


def _block(stiffness: Array, dofs: IntArray, rigid: Array, size: float) -> BodyBlock:
    """One block, held by springs where it floats; in the memory of the stiffness where that has no other."""
    first, last = dofs[0], dofs[-1] + 1
    together = last - first == len(dofs)
    own = stiffness[first:last, first:last] if together else stiffness[np.ix_(dofs, dofs)]
    matrix = stiffness.T if len(dofs) == len(stiffness) else np.array(own.T, order="F")
    if rigid.any():
        Q, triangle, _ = scipy.linalg.qr(rigid, mode="economic", pivoting=True)
        left = np.abs(np.diag(triangle))
        Q = Q[:, : np.count_nonzero(left > DEPENDENT * left[0])]
        add_product(matrix, size * Q, Q.T)
    failed = cholesky(matrix)
    if failed:
        raise np.linalg.LinAlgError(f"{failed}-th leading minor of the array is not positive definite")
    root = matrix.diagonal().copy()
    matrix /= root
    mirror(matrix, 0, len(matrix))
    return BodyBlock(dofs=dofs, upper=matrix, pivots=root**2)

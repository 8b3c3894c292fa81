# SPDX-License-Identifier: BSD-3-Clause
"""Dense matrices of large interfaces that threads share tile by tile.

The tiles are a matter of the size: the same to the last bit for any number of threads. What is smaller than a few tiles
is left to LAPACK, which is faster there. Matrices are stored by columns.

References
----------
Buttari, Langou, Kurzak, Dongarra (2009), A class of parallel tiled linear algebra algorithms, Parallel Comput. 35:38.
"""

from __future__ import annotations

from functools import partial
from itertools import pairwise

import numpy as np
from scipy.linalg import blas, lapack

from signorini.arrays import Array, Int32Array, IntArray, SingleArray
from signorini.cores import number_of_threads
from signorini.crew import Crew, Job
from signorini.linalg import _dense_tiles
from signorini.linalg._blas import StoredMatrix, scratch
from signorini.linalg._front_tiles import eliminate_tile
from signorini.linalg.schedule import TILE, Tile, tiles
from signorini.linalg.shared_fronts import NoPivot

SHARED = 1536
"""Rows from which threads share a factorisation or an inverse, three tiles, tens of milliseconds; or a product, one."""

_PANEL = 256  # columns of a matrix with pivots that one thread factorises, while the others wait for the first of them


def cholesky(matrix: Array | SingleArray) -> int:
    """Overwrite the lower triangle by the Cholesky factor; what is above it stays.

    Parameters
    ----------
    matrix : (n, n) symmetric, by columns; in single precision one thread has all of it

    Returns
    -------
    0, or the 1-based column of a pivot that is not positive

    Examples
    --------
    >>> A = np.asfortranarray([[4.0, 7.0], [2.0, 5.0]])
    >>> cholesky(A), A.tolist()
    (0, [[2.0, 7.0], [1.0, 2.0]])
    """
    n = len(matrix)
    assert matrix.flags.f_contiguous
    single = matrix.dtype == np.float32
    if n < SHARED or single:
        potrf = lapack.spotrf if single else lapack.dpotrf
        return int(potrf(matrix, lower=1, overwrite_a=1, clean=0)[1]) if n else 0
    blocks, stored = tiles(0, n), _stored(matrix)
    jobs: list[Job] = []
    done: dict[Tile, int] = {}

    def eliminate(columns: Tile, rows: Tile) -> None:
        column = eliminate_tile(columns, rows, stored, scratch())
        if column:
            raise NoPivot(columns[0] + column - 1)

    def eliminate_square(block: Tile) -> None:
        """Products take whole tiles, so that what is above the diagonal is put back."""
        own = slice(block[0], sum(block))
        square = matrix[own, own]
        above = np.triu(square, 1)
        try:
            eliminate(block, block)
        finally:
            square[:] = np.tril(square) + above

    for i, block in enumerate(blocks):
        for rows in blocks[i:]:
            needs = {done[tile] for tile in (block, rows) if tile in done}
            work = partial(eliminate_square, block) if rows == block else partial(eliminate, block, rows)
            jobs.append(Job(work, tuple(sorted(needs))))
            done[rows] = len(jobs) - 1
    try:
        _finish(jobs)
    except NoPivot as error:
        return error.place + 1
    return 0


def inverse_of_cholesky(factor: Array, *, overwrite: bool = False) -> Array:
    """``(L L')^-1``, (n, n), on both sides of the diagonal.

    With ``Y = L_21 L_11^-1`` and S the inverse behind a middle, that is ``- S Y`` below it, and before it the inverse
    of ``L_11 L_11'`` and ``Y' S Y``: most of it are products.

    Parameters
    ----------
    factor : (n, n) L, lower, by columns; above the diagonal anything
    overwrite : whether its memory is taken

    Examples
    --------
    >>> inverse_of_cholesky(np.asfortranarray([[2.0, 7.0], [1.0, 2.0]])).tolist()
    [[0.3125, -0.125], [-0.125, 0.25]]
    """
    n = len(factor)
    if n < SHARED:
        found = np.asarray(lapack.dpotri(factor, lower=1, overwrite_c=overwrite)[0]) if n else np.zeros((0, 0))
        _dense_tiles.mirror(found, 0, n)
        return found
    found = factor if overwrite else factor.copy(order="F")
    with Crew(number_of_threads()) as crew:
        _invert(found, 0, n, crew)
    return found


def _invert(factor: Array, first: int, end: int, crew: Crew) -> None:
    """Of a triangle of a factor, rows and columns from a first one to behind a last one."""
    stored = _stored(factor)
    if end - first >= SHARED:
        middle = first + (end - first) // (2 * TILE) * TILE
        behind, before = tiles(middle, end), tiles(first, middle)
        across = [np.empty((end - middle, columns[1]), order="F") for columns in before]

        def invert(columns: Tile, found: Array) -> None:
            _dense_tiles.invert_columns(middle, end, columns, stored, _stored(found), scratch())

        def place(columns: Tile, found: Array) -> None:
            factor[middle:end, columns[0] : sum(columns)] = found

        crew.each([partial(_divide, first, middle, rows, stored) for rows in behind])
        crew.each([partial(_invert, factor, *part, crew) for part in ((first, middle), (middle, end))])
        for each in (invert, place):
            crew.each([partial(each, *both) for both in zip(before, across, strict=True)])
    else:
        _dense_tiles.invert_alone(first, end, stored, scratch())
        middle = first
    square = factor[first:end, first:end]
    rows = pairwise([*range(0, end - first, TILE), end - first])
    crew.each([partial(_dense_tiles.mirror, square, *each) for each in rows])


def _divide(first: int, middle: int, rows: Tile, stored: StoredMatrix) -> None:
    _dense_tiles.divide_rows(first, middle, rows, stored, scratch())


def factorise_with_pivots(matrix: Array) -> tuple[IntArray, int]:
    """Overwrite a matrix by its factors ``L U`` with rows swapped, L with ones on its diagonal.

    Parameters
    ----------
    matrix : (n, n) by columns

    Returns
    -------
    (n,) the row that each was swapped with, one after the other, and 0, or the 1-based column of a pivot that is 0

    Examples
    --------
    >>> A = np.asfortranarray([[0.0, 2.0], [4.0, 1.0]])
    >>> factorise_with_pivots(A)[0].tolist(), A.tolist()
    ([1, 1], [[4.0, 1.0], [0.0, 2.0]])
    """
    n = len(matrix)
    assert matrix.flags.f_contiguous
    if n < SHARED:
        _, swapped, failed = lapack.dgetrf(matrix, overwrite_a=1) if n else (matrix, np.zeros(0, np.int32), 0)
        return np.asarray(swapped), int(failed)
    blocks, stored = tiles(0, n, _PANEL), _stored(matrix)
    pivots = np.zeros(n, dtype=np.int32)
    failures: list[int] = []

    def factorise(block: Tile) -> None:
        column = _dense_tiles.factorise_panel(*block, n, stored, _address(pivots, block), scratch())
        if column:
            failures.append(block[0] + column)

    def eliminate(block: Tile, columns: Tile) -> None:
        _dense_tiles.eliminate_panel(*block, columns, n, stored, _address(pivots, block), scratch())

    def swap(number: int) -> None:
        for block in blocks[number + 1 :]:
            _dense_tiles.swap_rows(*block, blocks[number], stored, _address(pivots, block), scratch())

    jobs: list[Job] = []
    done: dict[Tile, int] = {}
    for i, block in enumerate(blocks):
        jobs.append(Job(partial(factorise, block), (done[block],) if block in done else ()))
        panel = len(jobs) - 1
        for columns in blocks[i + 1 :]:
            jobs.append(Job(partial(eliminate, block, columns), tuple(sorted({panel, done.get(columns, panel)}))))
            done[columns] = len(jobs) - 1
    jobs += [Job(partial(swap, i), (panel,)) for i in range(len(blocks) - 1)]
    _finish(jobs)
    begin = np.repeat([block[0] for block in blocks], [block[1] for block in blocks])
    return begin + pivots - 1, min(failures, default=0)


def inverse_of_factors(lu: Array, swapped: IntArray, into: Array) -> None:
    """The inverse of a matrix by its factors with pivots.

    Parameters
    ----------
    lu, swapped : of `factorise_with_pivots`; overwritten
    into : (n, n) takes the inverse

    Examples
    --------
    >>> A, found = np.asfortranarray([[0.0, 2.0], [4.0, 1.0]]), np.zeros((2, 2))
    >>> inverse_of_factors(A, factorise_with_pivots(A)[0], found)
    >>> found.tolist()
    [[-0.125, 0.25], [0.5, 0.0]]
    """
    n = len(lu)
    if n < SHARED:
        # with room for blocks, without which it takes several times as long
        room = int(lapack.dgetri_lwork(n)[0])
        into[:] = lapack.dgetri(lu, swapped, lwork=room, overwrite_lu=1)[0]
        return
    row = np.arange(n)
    for i, other in enumerate(swapped.tolist()):
        row[i], row[other] = row[other], row[i]
    stored = _stored(lu)

    def compute(block: Tile) -> None:
        x = _unit(n, block[1], block[0])
        _dense_tiles.invert_factored_columns(*block, n, stored, _stored(x), scratch())
        into[:, row[block[0] : sum(block)]] = x

    _finish([Job(partial(compute, block)) for block in tiles(0, n)])


def product(matrix: Array, x: Array) -> Array:
    """``A x``, (n,).

    Parameters
    ----------
    matrix, x : (n, m) A, by rows or columns, and (m,)

    Examples
    --------
    >>> product(np.array([[0.0, 2.0], [4.0, 1.0]]), np.array([1.0, 2.0])).tolist()
    [4.0, 6.0]
    """
    if min(matrix.shape) < SHARED:
        return np.asarray(matrix @ x)
    found = np.empty(len(matrix))

    def multiply(rows: Tile) -> None:
        some = slice(rows[0], sum(rows))
        np.matmul(matrix[some], x, out=found[some])

    _finish([Job(partial(multiply, rows)) for rows in _shares(len(matrix))])
    return found


def add_product(matrix: Array, u: Array, v: Array) -> None:
    """Overwrite A by ``A + u v``.

    Parameters
    ----------
    matrix : (n, m) A, by columns
    u, v : (n, k), by columns, and (k, m)

    Examples
    --------
    >>> A = np.asfortranarray([[0.0, 2.0], [4.0, 1.0]])
    >>> add_product(A, np.array([[1.0], [0.0]]), np.array([[3.0, 5.0]]))
    >>> A.tolist()
    [[3.0, 7.0], [4.0, 1.0]]
    """
    n, k = u.shape
    assert matrix.flags.f_contiguous
    if min(matrix.shape) >= SHARED:
        left, right = np.asfortranarray(-u), np.asfortranarray(v)
        factors = StoredMatrix(left.ctypes.data, n), StoredMatrix(right.ctypes.data, k), _stored(matrix)

        def take(columns: Tile) -> None:
            _dense_tiles.take_product(n, k, columns, *factors, scratch())

        _finish([Job(partial(take, columns)) for columns in _shares(matrix.shape[1])])
    elif k == 1:  # half the time of a product of matrices
        blas.dger(1.0, u[:, 0], v[0], a=matrix, overwrite_x=0, overwrite_y=0, overwrite_a=1)
    else:
        blas.dgemm(1.0, u, v, beta=1.0, c=matrix, overwrite_c=1)


def _shares(n: int) -> list[Tile]:
    """Rows of a product that one thread takes at a time: even shares of about half of what is shared at all."""
    return tiles(0, n, -(-n // (2 * n // SHARED)))


def _stored(matrix: Array | SingleArray) -> StoredMatrix:
    return StoredMatrix(matrix.ctypes.data, len(matrix))


def _address(pivots: Int32Array, block: Tile) -> int:
    return int(pivots.ctypes.data) + 4 * block[0]


def _unit(n: int, width: int, first: int) -> Array:
    """(n, width) Columns of a unit matrix from one on."""
    x = np.zeros((n, width), order="F")
    x[np.arange(first, first + width), np.arange(width)] = 1.0
    return x


def _finish(jobs: list[Job]) -> None:
    with Crew(number_of_threads()) as crew:
        crew.finish(jobs)

# SPDX-License-Identifier: BSD-3-Clause
"""Loops over fronts stay within their arrays: run as Python, which looks at every index, on a BLAS that looks too."""

import numpy as np
import pytest
from numpy.lib.stride_tricks import as_strided

from signorini.linalg import _blas, _front_products, _front_ranks, _front_solves, _fronts, factorise
from tests.helpers.lattices import lattice, together

PROBLEMS = {
    "plane": lattice((9, 7)),
    "bodies": together(lattice((5, 4)), lattice((4, 5), held="none"), lattice((3, 3, 4))),
    "one layer": lattice((6, 1), held="none"),
}


class Watched:
    """NumPy of a module whose arrays are known, and BLAS on what lies at an address of one of them."""

    def __init__(self):
        self.arrays = []

    def __getattr__(self, name):
        return getattr(np, name)

    def empty(self, *given):
        return self.know(np.empty(*given))

    def know(self, array):
        self.arrays.append(array)
        return array

    def at(self, matrix, rows, columns):
        """A matrix by columns, all of which lies in one array that is known."""
        if not rows or not columns:
            return np.zeros((rows, columns))
        assert rows <= matrix.stride
        for array in self.arrays:
            begin, rest = divmod(int(matrix.begin) - array.ctypes.data, 8)
            if array.dtype == np.float64 and not rest and 0 <= begin < array.size:
                assert begin + (columns - 1) * matrix.stride + rows <= array.size
                flat = array.reshape(-1)
                assert np.shares_memory(flat, array)
                return as_strided(flat[begin:], shape=(rows, columns), strides=(8, 8 * int(matrix.stride)))
        raise AssertionError("an address of no array")

    def gemm(self, form, m, n, k, A, B, share, C, s):
        first = self.at(A, k, m).T if form == _blas.FIRST_TRANSPOSED else self.at(A, m, k)
        second = self.at(B, n, k).T if form == _blas.SECOND_TRANSPOSED else self.at(B, k, n)
        into = self.at(C, m, n)
        into[:] = (into if share == s.one else 0.0) - first @ second

    def trsm(self, side, op, m, n, L, B, s):
        size, into = m if side == s.left else n, self.at(B, m, n)
        inverse = np.linalg.inv(np.tril(self.at(L, size, size)))
        inverse = inverse.T if op == s.transposed else inverse
        into[:] = inverse @ into if side == s.left else into @ inverse

    def syrk(self, n, k, A, share, C, s):
        rows, into, lower = self.at(A, n, k), self.at(C, n, n), np.tril_indices(n)
        # nobody has written what is above the diagonal
        into[lower] = (into[lower] if share == s.one else 0.0) - (rows @ rows.T)[lower]

    def potrf(self, k, A, _):
        into = self.at(A, k, k)
        into[np.tril_indices(k)] = np.linalg.cholesky(np.tril(into) + np.tril(into, -1).T)[np.tril_indices(k)]
        return 0


@pytest.fixture
def watched(monkeypatch):
    """Loops as Python runs them; those that are given whole arrays tell of them."""
    found = Watched()

    def telling(loop):
        def told(*given):
            flat = [part for one in given for part in (one if isinstance(one, tuple) else [one])]
            for array in [part for one in flat for part in (one if isinstance(one, tuple) else [one])]:
                if isinstance(array, np.ndarray):
                    found.know(array)
            return loop(*given)

        return told

    monkeypatch.setattr(_front_products, "STRIP", 5)
    monkeypatch.setattr(_front_products, "LEAST_ROWS", 7)
    for module in (_fronts, _front_solves, _front_ranks, _front_products):
        monkeypatch.setattr(module, "np", found)
        for name, loop in list(vars(module).items()):
            if name in vars(Watched):
                monkeypatch.setattr(module, name, getattr(found, name))
            elif hasattr(loop, "py_func"):
                whole = name in ("factorise_fronts", "forward", "backward", "products")
                monkeypatch.setattr(module, name, telling(loop.py_func) if whole else loop.py_func)
    return found


@pytest.mark.parametrize("columns", [0, 1, 3])
@pytest.mark.parametrize("name", PROBLEMS)
def test_loops_over_fronts_stay_within_their_arrays(name, columns, request):
    """No column too, for which there is no room to work: loops must not write there."""
    p, rng = PROBLEMS[name], np.random.default_rng(5)
    n, m = p.K.shape[0], len(p.interface)
    f, u_c, M = rng.standard_normal((n, columns)), rng.standard_normal((m, columns)), rng.standard_normal((m, m))

    def found():
        factor = factorise(p.K, p.interface, nodes=p.nodes, backend="multifrontal")
        still, reduced = factor.reduce(np.zeros_like(f)), factor.reduce(f)
        return factor.schur(), reduced.expand(u_c), still.expand(u_c), factor.products(M + M.T, p.K)

    compiled = found() if columns else ()
    watched = request.getfixturevalue("watched")
    in_python = found()
    assert len(watched.arrays) > 4
    for one, two in zip(in_python, compiled, strict=False):
        assert one == pytest.approx(two, rel=1e-10, abs=1e-10 * np.abs(two).max())

# SPDX-License-Identifier: BSD-3-Clause
"""The test problems of the Siconos project, read from its files."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.lcp_problems.known import DEFINITE
from benchmarks.lcp_problems.posed import PosedLCP
from signorini.arrays import Array

_FOLDER = Path(__file__).parent / "siconos"
_CPS = "Cottle, Pang, Stone (1992)"
_MURTY = "Murty (1988), Linear Complementarity, chapter 6"

# file: source, answer (None: not known in closed form), whether it is the only one, traits
_PROBLEMS: dict[str, tuple[str, list[float] | None, bool, tuple[str, ...]]] = {
    "CPS_1": (f"{_CPS}, remark 4.1.14", [0.5, 0.5], False, ("monotone", "symmetric", "copositive plus")),
    "CPS_2": (f"{_CPS}, example 4.4.7", [0.0, 1.0, 3.0], True, ()),
    "CPS_3": (f"{_CPS}, example 4.4.23, a bimatrix game", [0.1, 0.0, 0.1, 0.0], False, ("game",)),
    "CPS_4": (_CPS, [2.0, 2.0, 2.0, 92.0], True, ("monotone", "copositive plus")),
    "CPS_4bis": (_CPS, [3.0, 3.0, 0.0, 83.0], True, ("monotone", "copositive plus")),
    "CPS_5": (f"{_CPS}, example 4.4.16", [0.0, 1.0], False, ("monotone", "symmetric", "Z", "copositive plus")),
    "Pang_isolated_sol": ("J.-S. Pang, an isolated solution", [1.0, 0.0, 0.0], True, ()),
    "Pang_isolated_sol_perturbed": ("J.-S. Pang: no solution after a small perturbation", None, False, ()),
    "inf_sol_perturbed": ("infinitely many solutions", [1.0, 0.0, 1e-4], False, ("monotone", "copositive plus")),
    "deudeu": (f"{_CPS}, 1.4", [4 / 3, 7 / 3], True, DEFINITE),
    "exp_murty": (_MURTY, [0.0] * 5 + [1.0], True, ("P",)),
    "exp_murty2": (f"{_MURTY}, exponential for Lemke's method", [0.0] * 5 + [64.0], True, ("P",)),
    "ortiz": ("Siconos", [2 / 3, 0.0, 1 / 3, 0.0], True, ("P", "positive definite", "monotone", "copositive plus")),
    "trivial": ("Siconos, M = diag(1 .. 9)", [1.0 / k for k in range(1, 10)], True, ("Z", *DEFINITE)),
    "enum_fails": ("Siconos, from a mechanism with friction", None, True, ()),
    "mmc": ("Siconos, from a mechanism with many contacts", None, True, DEFINITE),
    "tobenna": ("Siconos, a variational inequality as an LCP", None, False, ()),
}
_UNSOLVABLE = {"Pang_isolated_sol_perturbed"}


def collected() -> list[PosedLCP]:
    """The problems, their M transposed on reading: the files hold it by columns.

    Examples
    --------
    >>> next(p for p in collected() if "CPS_2" in p.name).M
    array([[ 0., -1.,  2.],
           [ 2.,  0., -2.],
           [-1.,  1.,  0.]])
    """
    return [_read(name, *facts) for name, facts in _PROBLEMS.items()]


def _read(name: str, source: str, answer: list[float] | None, unique: bool, traits: tuple[str, ...]) -> PosedLCP:
    M, q = parse((_FOLDER / f"lcp_{name}.dat").read_text())
    return PosedLCP(
        name=f"Siconos, {name}",
        source=source,
        M=M,
        q=q,
        answer=None if answer is None else np.array(answer),
        unique=unique,
        solvable=name not in _UNSOLVABLE,
        traits=frozenset(traits),
    )


def parse(text: str) -> tuple[Array, Array]:
    """M (n, n) and q (n,) of a Siconos file with dense storage; what follows the numbers is a comment.

    Examples
    --------
    >>> M, q = parse("2 0 2 2 2 2   1 2 3 4   -5 -6   a remark")
    >>> M.tolist(), q.tolist()
    ([[1.0, 3.0], [2.0, 4.0]], [-5.0, -6.0])
    """
    words = text.split()
    n, header = int(words[0]), 6  # n, storage type, shape, shape
    numbers = np.array(words[header : header + n * n + n], dtype=float)
    return np.ascontiguousarray(numbers[: n * n].reshape(n, n).T), numbers[n * n :]

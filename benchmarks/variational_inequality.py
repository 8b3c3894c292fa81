# SPDX-License-Identifier: BSD-3-Clause
"""Contact without friction as PETSc's own variational inequality, beside the back end 'petsc' on the same matrix.

The paper's cylinder on a rigid plane, pressed without friction: a quadratic programme with bounds on displacements,
which SNES solves by Newton's method on active sets (vinewtonrsls) with conjugate gradients and an incomplete factor:
smoothed aggregation refuses systems whose size changes with the active set. It begins with half of the pairs under the
plane, because a body that touches nothing has no stiffness. Counts and operations of one rank say what each way takes,
whatever else the machine does. Needs petsc4py and mpi4py.

usage: python -m benchmarks.variational_inequality [--small]
"""

from __future__ import annotations

from typing import Any

import numpy as np

import signorini as sg
from benchmarks import command, page
from signorini.arrays import Array
from signorini.distributed.ranks import the_team
from signorini.engine.prepare import Prepared, prepare
from signorini.engine.solve import solve_prepared
from signorini.fem.stiffness import reduced_stiffness
from signorini.gallery.cylinder import zhu_cylinder

PAGE = page.PAGE.parent / "distributed.md"
RESIDUAL, LINEAR = 1e-10, 1e-8  # of the load; of each linear system
MOST_NEWTON, MOST_LINEAR = 60, 2000  # iterations
HEAD = ["unknowns", "pairs", "way", "rounds", "conjugate gradients", "Gflop of PETSc", "largest difference"]


def flops() -> float:
    from petsc4py import PETSc

    if not PETSc.Log.isActive():
        PETSc.Log.begin()
    return float(PETSc.Log.getFlops())


def bounded(prepared: Prepared) -> tuple[Array, Array]:
    """Forces and lower bounds of the free displacements: a node under the plane is as far above it as its gap."""
    T, interface = prepared.constraints.transform, prepared.interface
    assert np.allclose(interface.normals, [0.0, 1.0])
    assert (np.diff(T.indptr) <= 1).all()
    force = T.T @ sum(prepared.loads.values())
    heights = T[2 * interface.node + 1].indices
    low = np.full(T.shape[1], -1e20)
    low[heights] = -interface.gap
    return np.asarray(force), low


def as_inequality(prepared: Prepared) -> tuple[Array, int, int]:
    """Displacements of all nodes, Newton steps, and conjugate gradients in them."""
    from petsc4py import PETSc

    T = prepared.constraints.transform
    K = reduced_stiffness(prepared.K, T).tocsr()
    force, low = bounded(prepared)
    A = PETSc.Mat().createAIJ(K.shape, csr=(K.indptr, K.indices, K.data), comm=PETSc.COMM_SELF)
    points = prepared.model.mesh.points
    start = np.zeros(len(low))
    start[T[2 * np.arange(len(points)) + 1].indices] = -np.median(prepared.interface.gap)
    b, x, residual = _vector(force), _vector(np.maximum(low, start)), _vector(force)
    snes = PETSc.SNES().create(comm=PETSc.COMM_SELF)

    def balance(_: Any, at: Any, out: Any) -> None:
        A.mult(at, out)
        out.axpy(-1.0, b)

    snes.setFunction(balance, residual)
    snes.setJacobian(lambda *_: None, A, A)
    snes.setType("vinewtonrsls")
    snes.setVariableBounds(_vector(low), _vector(np.full(len(low), 1e20)))
    snes.getKSP().setType("cg")
    snes.getKSP().getPC().setType("icc")
    snes.getKSP().setTolerances(rtol=LINEAR, max_it=MOST_LINEAR)
    snes.setTolerances(rtol=0.0, atol=RESIDUAL * b.norm(), stol=0.0, max_it=MOST_NEWTON)
    snes.solve(None, x)
    if snes.getConvergedReason() <= 0:
        raise SystemExit(f"SNES ended with reason {snes.getConvergedReason()}")
    u = np.asarray(T @ x.array)
    return u.reshape(points.shape), snes.getIterationNumber(), snes.getLinearSolveIterations()


def _vector(values: Array) -> Any:
    from petsc4py import PETSc

    return PETSc.Vec().createWithArray(np.array(values), comm=PETSc.COMM_SELF)


def rows_of(refine: int) -> list[list[object]]:
    """Both ways on one mesh, beside the answer of the factorised bodies."""
    model = zhu_cylinder(refine=refine, friction=0.0)
    alone = prepare(model)
    right = solve_prepared(alone).last.displacement
    size = float(np.abs(right).max())
    begin = flops()
    history = solve_prepared(prepare(model, backend="petsc"))
    middle = flops()
    found, newton, gradients = as_inequality(alone)
    work = middle - begin, flops() - middle
    attempt = history.last.trace[0][-1]
    own = ["multipliers", attempt.iterations, attempt.end.split()[0]]
    other = ["variational inequality", newton, gradients]
    answers = history.last.displacement, found
    return [
        [
            f"{model.number_of_dofs}",
            history.pairs,
            *counts,
            f"{flop / 1e9:.3g}",
            f"{np.abs(answer - right).max() / size:.0e}",
        ]
        for counts, flop, answer in zip((own, other), work, answers, strict=True)
    ]


def main() -> None:
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("--small", action="store_true", help="sizes that take seconds")
    options = parser.parse_args()
    with sg.ranks() as first:
        if first and the_team().size == 1:
            rows = [row for refine in ((2, 4) if options.small else (4, 8, 16)) for row in rows_of(refine)]
            command.publish(options, "inequality", page.table(HEAD, rows), PAGE)


if __name__ == "__main__":
    main()

# SPDX-License-Identifier: BSD-3-Clause
"""Assembly of the stiffness matrix against scikit-fem's own form, in one run: CPU seconds, one thread, code warm.

usage: python -m benchmarks.assembly [--small]
"""

from __future__ import annotations

from typing import Any

import numpy as np
import skfem
from skfem.models.elasticity import linear_elasticity

from benchmarks import command
from signorini.fem.assembly import Cells, stiffness
from signorini.fem.elasticity import isotropic, law_tensor


def cells_of(mesh: Any, element: Any) -> tuple[Any, Cells, Any]:
    basis = skfem.Basis(mesh, element)
    X, weights = basis.quadrature
    gradients = np.stack([element.lbasis(X, i)[1] for i in range(basis.element_dofs.shape[0])])
    cells = Cells(nodes=basis.element_dofs.T, shape_gradients=np.moveaxis(gradients, 2, 0), weights=weights)
    return basis.doflocs.T, cells, law_tensor(isotropic(1.3, 0.7)[None, : 2 * mesh.dim(), : 2 * mesh.dim()])


def grid(*cells: int) -> list[Any]:
    return [np.linspace(0, 1, k + 1) for k in cells]


def main() -> None:
    parser = command.parser(__doc__)
    parser.add_argument("--small", action="store_true", help="a tenth of the unknowns")
    side, edge = (223, 15) if parser.parse_args().small else (706, 32)
    cases = {
        "quad4": (skfem.MeshQuad.init_tensor(*grid(side, side)), skfem.ElementQuad1()),
        "tri3": (skfem.MeshTri.init_tensor(*grid(side, side)), skfem.ElementTriP1()),
        "hex8": (skfem.MeshHex.init_tensor(*grid(edge, edge, edge)), skfem.ElementHex1()),
    }
    stiffness(*cells_of(skfem.MeshQuad(), skfem.ElementQuad1()))
    print(f"{'element':8} {'unknowns':>9} {'kernel s':>9} {'scikit-fem s':>12} {'ratio':>6} {'difference':>11}")
    for name, (mesh, element) in cases.items():
        ours, K = command.cpu(stiffness, *cells_of(mesh, element))
        # basis and form: what a user of scikit-fem pays from the mesh to the matrix
        theirs, reference = command.cpu(
            lambda mesh=mesh, element=element: linear_elasticity(1.3, 0.7).assemble(
                skfem.Basis(mesh, skfem.ElementVector(element))
            )
        )
        difference = abs(K - reference).max() / abs(reference).max()
        print(
            f"{name:8} {K.shape[0]:9d} {ours:9.2f} {theirs:12.2f} {theirs / ours:6.1f} {difference:11.1e}", flush=True
        )


if __name__ == "__main__":
    main()

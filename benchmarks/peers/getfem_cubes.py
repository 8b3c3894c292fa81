# SPDX-License-Identifier: BSD-3-Clause
"""A cube on a block in GetFEM: integral contact of meshes that do not match, augmented Lagrangian, MUMPS.

Run by the Python that has ``getfem`` (Debian: python3-getfem), without signorini:

    python3 getfem_cubes.py CASE.npz FRICTION

Prints one line of JSON: CPU seconds, Newton steps, pressures and lengths of the shear at the nodes of the case.
"""

import json
import sys
import time
from typing import Any

import getfem as gf  # type: ignore[import-not-found]
import numpy as np

E, NU = 200.0, 0.3
TOP, BOTTOM, NEAR = 1, 2, 3


def body(corners: Any) -> tuple[Any, Any, Any]:
    """Mesh, displacements and quadrature of cells given by their corners (m, 8, 3), meshio's order."""
    mesh = gf.Mesh("empty", 3)
    order = [0, 1, 3, 2, 4, 5, 7, 6]
    mesh.add_convex(gf.GeoTrans("GT_QK(3,1)"), np.ascontiguousarray(corners[:, order].transpose(2, 1, 0)))
    x, y, z = mesh.pts()
    h = np.diff(np.unique(x.round(9))).max() - 1e-9  # all faces that reach below the cube
    near = (np.abs(z) < 1e-9) & (x > -h) & (x < 1.0 + h) & (y > -h) & (y < 1.0 + h)
    for region, there in ((TOP, z > z.max() - 1e-9), (BOTTOM, z < z.min() + 1e-9), (NEAR, near)):
        mesh.set_region(region, mesh.faces_from_pid(np.flatnonzero(there)))
    space = gf.MeshFem(mesh, 3)
    space.set_classical_fem(1)
    return mesh, space, gf.MeshIm(mesh, 3)


def main() -> None:
    case, friction = np.load(sys.argv[1]), float(sys.argv[2])
    began = time.process_time()
    solid, cube, cube_rule = body(case["cube"])  # GetFEM forgets meshes that have no name
    ground, block, block_rule = body(case["block"])
    model = gf.Model("real")
    model.add_initialized_data("lambda", [E * NU / (1 + NU) / (1 - 2 * NU)])
    model.add_initialized_data("shear", [E / 2 / (1 + NU)])
    for name, space, rule in (("u1", cube, cube_rule), ("u2", block, block_rule)):
        model.add_fem_variable(name, space)
        model.add_isotropic_linearized_elasticity_brick(rule, name, "lambda", "shear")
    model.add_initialized_data("down", [0.0, 0.0, -0.01])
    model.add_Dirichlet_condition_with_simplification("u1", TOP, "down")
    model.add_Dirichlet_condition_with_simplification("u2", BOTTOM)
    model.add_initialized_data("r", [E])
    model.add_initialized_data("mu", [friction])
    force = gf.MeshFem(solid, 3)
    force.set_classical_fem(1)
    model.add_filtered_fem_variable("force", force, BOTTOM)
    names = ("u1", "u2", "force", "r", "mu", BOTTOM, NEAR, 1)
    model.add_integral_contact_between_nonmatching_meshes_brick(cube_rule, *names)
    start = np.zeros(cube.nbdof())
    start[2::3] = -0.001
    model.set_variable("u1", start)
    steps = model.solve("max_res", 1e-8, "max_iter", 60, "lsolver", "mumps", "lsearch", "simplest", "alpha min", 0.2)
    seconds = time.process_time() - began
    assert ground is not None
    scalar = gf.MeshFem(solid, 1)
    scalar.set_classical_fem(1)
    one = np.ones(scalar.nbdof())
    stiffness = gf.asm(
        "linear_elasticity", cube_rule, cube, scalar, E * NU / (1 + NU) / (1 - 2 * NU) * one, E / 2 / (1 + NU) * one
    )
    dofs = cube.basic_dof_on_region(BOTTOM)
    places = cube.basic_dof_nodes()[:2, dofs[0::3]].T
    forces = stiffness.mult(model.variable("u1"))[dofs].reshape(-1, 3)
    points = case["nodes"][:, :2]
    own = [int(np.argmin(np.abs(places - point).sum(axis=1))) for point in points]
    size = np.ptp(np.unique(points[:, 0].round(9))[:2])
    edge = ((points < 1e-9) | (points > 1 - 1e-9)).sum(axis=1)
    traction = forces[own] / (size**2 * 0.5**edge)[:, None]
    result = {
        "seconds": seconds,
        "iterations": int(np.ravel(steps)[0]),
        "normal": float(forces[:, 2].sum()),
        "pressure": traction[:, 2].tolist(),
        "shear": np.hypot(traction[:, 0], traction[:, 1]).tolist(),
    }
    print(json.dumps(result))


if __name__ == "__main__":
    main()

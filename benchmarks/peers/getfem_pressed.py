# SPDX-License-Identifier: BSD-3-Clause
"""A body that yields, pressed on a rigid plane, in GetFEM: nodal contact, augmented Lagrangian, MUMPS.

Run by the Python that has ``getfem`` (Debian: python3-getfem), without signorini:

    python3 getfem_pressed.py CASE.npz FOUND.npz

Quadrilaterals of nine nodes, plane strain, perfect plasticity by the return mapping of its small strain brick. Prints
one line of JSON: CPU seconds, Newton steps, force on the plane; FOUND.npz has the stresses, means of the cells.
"""

import json
import sys
import time
from typing import Any

import getfem as gf  # type: ignore[import-not-found]
import numpy as np

SEAT, AXIS, TOP = 1, 2, 3
LEXICOGRAPHIC = [0, 4, 1, 7, 8, 5, 3, 6, 2]
"""Nodes of a cell of meshio in GetFEM's order."""
SOLVER = ("max_res", 1e-9, "max_iter", 60, "lsolver", "mumps", "lsearch", "simplest", "alpha min", 0.2)
LAW = ("plane strain Prandtl Reuss", "DISPLACEMENT_ONLY", "u", "xi", "Previous_Ep", "lambda", "mu", "sigma_y", "1")
LAW += ("timestep",)


def build(case: Any) -> tuple[Any, Any]:
    """Mesh, law, supports and contact; the quadrature."""
    mesh = gf.Mesh("empty", 2)
    ids = np.asarray(mesh.add_point(case["points"].T)).ravel()
    nodes = case["points"][case["cells"][:, LEXICOGRAPHIC]]
    mesh.add_convex(gf.GeoTrans("GT_QK(2,2)"), np.ascontiguousarray(nodes.transpose(2, 1, 0)))
    for region, name in ((SEAT, "seat"), (AXIS, "axis"), (TOP, "top")):
        mesh.set_region(region, mesh.faces_from_pid(ids[case[name]]))
    space, multiplier, rule = gf.MeshFem(mesh, 2), gf.MeshFem(mesh), gf.MeshIm(mesh, 5)
    space.set_classical_fem(2)
    multiplier.set_classical_discontinuous_fem(2)
    E, nu = float(case["E"]), float(case["nu"])
    model = gf.Model("real")
    model.add_fem_variable("u", space)
    model.add_fem_data("Previous_u", space)
    model.add_fem_data("xi", multiplier)
    model.add_fem_data("Previous_xi", multiplier)
    model.add_im_data("Previous_Ep", gf.MeshImData(rule, -1, [2, 2]))
    model.add_initialized_data("lambda", [E * nu / (1 + nu) / (1 - 2 * nu)])
    model.add_initialized_data("mu", [E / 2 / (1 + nu)])
    model.add_initialized_data("sigma_y", [float(case["Y"])])
    model.set_time_step(1.0)
    model.add_small_strain_elastoplasticity_brick(rule, *LAW)
    model.add_initialized_data("zero", [0.0])
    model.add_initialized_data("down", [0.0])
    model.add_normal_Dirichlet_condition_with_multipliers(rule, "u", 2, AXIS, "zero")
    model.add_normal_Dirichlet_condition_with_multipliers(rule, "u", 2, TOP, "down")
    model.add_initialized_data("r", [E])
    model.add_variable("normal", len(np.asarray(space.basic_dof_on_region(SEAT)).ravel()) // 2)
    # version 2, the symmetric one, is the fastest of the four
    model.add_nodal_contact_with_rigid_obstacle_brick(rule, "u", "normal", "r", SEAT, "y", 2)
    # at u = 0 nothing but the pole touches
    start = np.zeros(space.nbdof())
    start[1::2] = -float(case["approach"]) / int(case["increments"])
    model.set_variable("u", start)
    return model, rule


def stresses(model: Any, rule: Any, cells: int) -> Any:
    """xx, yy, zz, xy, means over the points of the cells, (cells, 4)."""
    strain = "(Sym(Grad_u)-Previous_Ep)"
    planar = f"lambda*Trace(Grad_u)*Id(2)+2*mu*{strain}"
    tensor = np.asarray(model.interpolation(planar, gf.MeshImData(rule, -1, [2, 2]))).reshape(cells, -1, 4).mean(axis=1)
    across = model.interpolation("lambda*Trace(Grad_u)+2*mu*Trace(Previous_Ep)", gf.MeshImData(rule, -1))
    zz = np.asarray(across).reshape(cells, -1).mean(axis=1)
    return np.column_stack([tensor[:, 0], tensor[:, 3], zz, tensor[:, 1]])


def main() -> None:
    case = np.load(sys.argv[1])
    model, rule = build(case)
    begin, iterations = time.process_time(), 0
    count = int(case["increments"])
    for k in range(1, count + 1):
        model.set_variable("down", [-float(case["approach"]) * k / count])
        steps = model.solve(
            "max_res", 1e-9, "max_iter", 60, "lsolver", "mumps", "lsearch", "simplest", "alpha min", 0.2
        )
        iterations += int(np.ravel(steps)[0])
        model.small_strain_elastoplasticity_next_iter(rule, *LAW)
    end = time.process_time()
    np.savez(sys.argv[2], stress=stresses(model, rule, len(case["cells"])))
    force = -float(np.sum(model.variable("normal")))
    print(json.dumps({"seconds": end - begin, "iterations": iterations, "force": force}))


if __name__ == "__main__":
    main()

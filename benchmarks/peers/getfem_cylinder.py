# SPDX-License-Identifier: BSD-3-Clause
"""The cylinder in GetFEM: nodal contact with a rigid obstacle, augmented Lagrangian, MUMPS.

Run by the Python that has ``getfem`` (Debian: python3-getfem), without signorini:

    python3 getfem_cylinder.py CASE.npz FRICTION

Prints one line of JSON: CPU seconds, memory, Newton steps, nodal normal forces of the arc.
"""

import json
import sys
import time
from typing import Any

import getfem as gf  # type: ignore[import-not-found]
import numpy as np

ARC, AXIS, CUT = 1, 2, 3


def build(case: Any, friction: float) -> tuple[Any, Any]:
    """Mesh, supports, load and contact law."""
    mesh = gf.Mesh("empty", 2)
    ids = np.asarray(mesh.add_point(case["points"].T)).ravel()
    corners = case["points"][case["cells"][:, [0, 1, 3, 2]]]
    mesh.add_convex(gf.GeoTrans("GT_QK(2,1)"), np.ascontiguousarray(corners.transpose(2, 1, 0)))
    for region, name in ((ARC, "arc"), (AXIS, "axis"), (CUT, "cut")):
        mesh.set_region(region, mesh.faces_from_pid(ids[case[name]]))
    space = gf.MeshFem(mesh, 2)
    space.set_classical_fem(1)
    rule = gf.MeshIm(mesh, 3)
    E, nu = float(case["E"]), float(case["nu"])
    model = gf.Model("real")
    model.add_fem_variable("u", space)
    model.add_initialized_data("lambda", [E * nu / (1 + nu) / (1 - 2 * nu)])
    model.add_initialized_data("mu", [E / 2 / (1 + nu)])
    model.add_isotropic_linearized_elasticity_brick(rule, "u", "lambda", "mu")
    model.add_initialized_data("selector", np.array([[1.0, 0.0], [0.0, 0.0]]))
    model.add_initialized_data("zero", [0.0, 0.0])
    model.add_generalized_Dirichlet_condition_with_penalization(rule, "u", 1e9, AXIS, "zero", "selector")
    model.add_initialized_data("load", [0.0, -float(case["traction"])])
    model.add_source_term_brick(rule, "u", "load", CUT)
    pairs = len(case["arc"])
    model.add_initialized_data("r", [E])
    model.add_variable("normal", pairs)
    names = ["normal", "r"]
    if friction > 0:
        names = ["normal", "tangential", "r", "friction"]
        model.add_variable("tangential", pairs)
        model.add_initialized_data("friction", [friction])
    # version 2, the symmetric one, is the fastest of the four
    model.add_nodal_contact_with_rigid_obstacle_brick(rule, "u", *names, ARC, "y", 2)
    # at u = 0 nothing but the pole touches: begin moved by force / E, the scale of the approach
    start = np.zeros(space.nbdof())
    start[1::2] = -float(case["approach"])
    model.set_variable("u", start)
    return model, space


def forces(model: Any, space: Any) -> Any:
    """Normal forces of the arc's nodes from the pole up: the multipliers, negative in compression."""
    dofs = np.asarray(space.basic_dof_on_region(ARC)).ravel()[1::2]
    x, y = space.basic_dof_nodes()[:, dofs]
    return -model.variable("normal")[np.argsort(x + y)]


def peak_memory() -> int:
    """Bytes."""
    with open("/proc/self/status") as status:
        return 1024 * next(int(line.split()[1]) for line in status if line.startswith("VmHWM"))


def main() -> None:
    case, friction = np.load(sys.argv[1]), float(sys.argv[2])
    marks = [time.process_time()]
    model, space = build(case, friction)
    marks.append(time.process_time())
    begun = time.perf_counter()
    model.assembly()
    marks.append(time.process_time())
    steps = model.solve("max_res", 1e-8, "max_iter", 60, "lsolver", "mumps", "lsearch", "simplest", "alpha min", 0.2)
    marks.append(time.process_time())
    result = {
        "wall_seconds": time.perf_counter() - begun,
        "input_seconds": marks[1] - marks[0],
        "assembly_seconds": marks[2] - marks[1],
        "solve_seconds": marks[3] - marks[2],
        "iterations": int(np.ravel(steps)[0]),
        "memory": peak_memory(),
        "forces": forces(model, space).tolist(),
    }
    print(json.dumps(result))


if __name__ == "__main__":
    main()

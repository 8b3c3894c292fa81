# SPDX-License-Identifier: BSD-3-Clause
"""A cube on a block, meshes that do not match, mu = 0.2, in other codes; writes a table of docs/performance.md.

    python -m benchmarks.space_peers [--cells 14 17 10] [--dry]

CalculiX (program ccx) and GetFEM (Python module of the system's python3) are left out where they are missing.
"""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks import command, page
from benchmarks.peers import run_calculix, run_getfem
from signorini.arrays import Array, IntArray
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.meshing.solid import box
from signorini.model.body import Body
from signorini.model.conditions import Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import join
from signorini.model.model import Model
from signorini.model.step import Step

FRICTION = 0.2
PENALTY = 1e5
"""Of CalculiX, pressure per overlap; its stick slope is a tenth."""
GETFEM = Path(__file__).parent / "peers" / "getfem_cubes.py"
HEAD = (
    "code",
    "CPU s",
    "iterations",
    "normal force",
    "friction / normal",
    "p at the centre",
    "largest shear",
    "nodes that slip %",
)


@dataclass(frozen=True, kw_only=True)
class Found:
    """CPU seconds of the whole run, iterations, normal force; pressures and lengths of the shear at the nodes."""

    code: str
    seconds: float
    iterations: int
    normal: float
    pressure: Array
    shear: Array


def cube_on_block(n: int, m: int, layers: int, *, friction: float = FRICTION) -> Model:
    """A unit cube on a block 2 x 2 x 1, its top lowered by 0.01 and held sideways: other codes solve the same.

    Parameters
    ----------
    n : cells along every edge of the cube
    m, layers : cells of the block along x and y, and along z
    friction : Coulomb's coefficient
    """
    x, wide = np.linspace(0.0, 1.0, n + 1), np.linspace(-0.5, 1.5, m + 1)
    return Model(
        join({"cube": box(x=x, y=x, z=x), "block": box(x=wide, y=wide, z=np.linspace(-1.0, 0.0, layers + 1))}),
        title="A cube on a block",
        bodies=[Body(name, Elastic(E=200.0, nu=0.3)) for name in ("cube", "block")],
        supports=[Support("block.bottom", u=(0.0, 0.0, 0.0)), Support("cube.top", u=(0.0, 0.0, -0.01))],
        contacts=[Contact("cube.bottom", "block.top", friction=friction, name="contact")],
        steps=[Step(name="press", increments=1)],
    )


def main() -> None:
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("--cells", type=int, nargs=3, default=[14, 17, 10], help="of the cube; of the block, layers")
    options = parser.parse_args()
    model = cube_on_block(*options.cells)
    found, said = [with_signorini(model)], []
    for reason, run in ((run_calculix.missing(), with_calculix), (run_getfem.missing(), with_getfem)):
        if reason is None:
            found.append(run(model))
        else:
            said.append(reason)
    said.append(
        f"{model.mesh.points.size} unknowns, mu = {FRICTION}, one increment, CPU seconds of the whole run with input "
        f"and assembly, one thread, warm, {page.machine()}. Friction: the sum of the lengths of nodal forces. CalculiX "
        f"with a penalty of {PENALTY:g} and a stick slope of a tenth of it: its normal force is the reaction of the "
        "top, its pressures and shears are nodal values made of those at points inside faces. GetFEM's integral brick."
    )
    text = "\n\n".join([page.table(HEAD, [_row(model, each) for each in found]), *said])
    command.publish(options, "space, peers", text)


def _row(model: Model, found: Found) -> list[object]:
    points = model.mesh.points[_nodes(model)]
    size = float(np.ptp(np.unique(points[:, 0])[:2]))
    edge = ((points[:, :2] < 1e-9) | (points[:, :2] > 1.0 - 1e-9)).sum(axis=1)
    area = size**2 * 0.5**edge
    centre = np.argmin(np.hypot(*(points[:, :2] - 0.5).T))
    slips = (found.shear > 0.99 * FRICTION * found.pressure) & (found.pressure > 0.0)
    return [
        found.code,
        page.seconds(found.seconds),
        found.iterations,
        f"{found.normal:.4f}",
        f"{found.shear @ area / (found.pressure @ area):.4f}",
        f"{found.pressure[centre]:.4f}",
        f"{found.shear.max():.4f}",
        f"{100.0 * slips.mean():.0f}",
    ]


def _nodes(model: Model) -> IntArray:
    """Of the cube's side, sorted."""
    return np.unique(model.mesh.boundaries["cube.bottom"])


def with_signorini(model: Model) -> Found:
    """Once warm."""
    solve_prepared(prepare(cube_on_block(2, 3, 1)))
    began = time.process_time()
    history = solve_prepared(prepare(model))
    seconds = time.process_time() - began
    contact = history.last.contacts[0]
    return Found(
        code="signorini",
        seconds=seconds,
        iterations=sum(history.last.iterations),
        normal=float(contact.normal_force[2]),
        pressure=contact.pressure,
        shear=np.linalg.norm(contact.shear, axis=1),
    )


def with_calculix(model: Model) -> Found:
    """Surface to surface contact."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        _write_calculix(model, folder / "cubes.inp")
        process = subprocess.Popen(
            ["ccx", "-i", "cubes"],
            cwd=folder,
            stdout=(folder / "log").open("w"),
            stderr=subprocess.STDOUT,
            env={**os.environ, **page.ONE_THREAD, **page.KEEP_MEMORY},
        )
        _, code, usage = os.wait4(process.pid, 0)
        log = (folder / "log").read_text()
        process.returncode = os.waitstatus_to_exitcode(code)
        if process.returncode or "Job finished" not in log:
            raise SystemExit(f"CalculiX ended with {process.returncode} and without a solution")
        nodes, reaction = _nodes(model), float((folder / "cubes.dat").read_text().split()[-1])
        found = {n: values for block, n, values in run_calculix.records(folder / "cubes.frd") if block == "CONTACT"}
    values = np.array([found.get(node + 1, [0.0] * 6) for node in nodes.tolist()])
    return Found(
        code="CalculiX",
        seconds=usage.ru_utime + usage.ru_stime,
        iterations=sum(line.startswith(" iteration") for line in log.splitlines()),
        normal=-reaction,
        pressure=values[:, 3],
        shear=np.hypot(values[:, 4], values[:, 5]),
    )


def _write_calculix(model: Model, file: Path) -> None:
    mesh = model.mesh
    cells, sides = mesh.cells["hexahedron"], mesh.boundaries
    nodes = "\n".join(f"{i},{x:.15g},{y:.15g},{z:.15g}" for i, (x, y, z) in enumerate(mesh.points, start=1))
    blocks = [f"*NODE\n{nodes}"]
    for body, own in mesh.bodies.items():
        rows = [",".join(map(str, (cell + 1, *(cells[cell] + 1)))) for cell in own.tolist()]
        blocks.append(f"*ELEMENT,TYPE=C3D8,ELSET={body}\n" + "\n".join(rows))
    for name, side in (("TOP", "cube.top"), ("BASE", "block.bottom")):
        blocks.append(f"*NSET,NSET={name}\n" + "\n".join(f"{node + 1}," for node in np.unique(sides[side])))
    for name, side, number, corners in (("SLAVE", "cube.bottom", 1, slice(4)), ("MASTER", "block.top", 2, slice(4, 8))):
        there = np.flatnonzero(np.isin(cells[:, corners], sides[side]).all(axis=1))
        blocks.append(f"*SURFACE,NAME={name}\n" + "\n".join(f"{cell + 1},S{number}" for cell in there))
    blocks += [
        "*MATERIAL,NAME=ELASTIC\n*ELASTIC\n200.,0.3",
        *(f"*SOLID SECTION,ELSET={body},MATERIAL=ELASTIC" for body in mesh.bodies),
        f"*SURFACE INTERACTION,NAME=LAW\n*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR\n{PENALTY:g}",
        f"*FRICTION\n{FRICTION},{PENALTY / 10:g}",
        "*CONTACT PAIR,INTERACTION=LAW,TYPE=SURFACE TO SURFACE\nSLAVE,MASTER",
        "*BOUNDARY\nBASE,1,3",
        "*STEP,INC=200\n*STATIC\n1.,1.\n*BOUNDARY\nTOP,1,2,0.\nTOP,3,3,-0.01",
        "*CONTACT FILE\nCDIS,CSTR\n*NODE PRINT,NSET=TOP,TOTALS=ONLY\nRF\n*END STEP",
    ]
    file.write_text("\n".join(blocks) + "\n")


def with_getfem(model: Model) -> Found:
    """Integral contact of meshes that do not match."""
    mesh, nodes = model.mesh, _nodes(model)
    with tempfile.TemporaryDirectory() as name:
        file = Path(name) / "cubes.npz"
        bodies = {body: mesh.points[mesh.cells["hexahedron"][own]] for body, own in mesh.bodies.items()}
        np.savez(file, nodes=mesh.points[nodes], **bodies)
        done = subprocess.run(
            [run_getfem.PYTHON, str(GETFEM), str(file), str(FRICTION)],
            capture_output=True,
            text=True,
            env=run_getfem.environment(),
            check=False,
        )
    if done.returncode:
        raise SystemExit(f"GetFEM ended with {done.returncode}:\n{done.stderr[-2000:]}")
    found = json.loads(done.stdout.splitlines()[-1])
    return Found(
        code="GetFEM",
        seconds=found["seconds"],
        iterations=found["iterations"],
        normal=found["normal"],
        pressure=np.array(found["pressure"]),
        shear=np.array(found["shear"]),
    )


if __name__ == "__main__":
    main()

"""What the first rank holds of a model that ranks solve: ``mpiexec -n 3 python -m tests.helpers.first_rank WAY NAME``.

A column has many nodes and few pairs, so that whatever is as large as the mesh is larger than all that is known of the
interface. Printed are numbers that are not whole in arrays with as many of them as there are nodes, by the way from
the prepared model, the states and the history to them; what the first rank holds as one of the ranks is left out.
"""

import gc
import json
import sys
import traceback
import types
from dataclasses import replace
from pathlib import Path

import numpy as np

import signorini as sg
from signorini.distributed.rank_arrays import ArrayOnRanks
from signorini.distributed.ranks import Team, lend
from signorini.engine import solve as following
from signorini.engine import validity_notes
from signorini.meshing.cut import cut
from signorini.meshing.solid import box
from signorini.model.obstacle import Plane

_APART = (type, types.ModuleType, Team, str, bytes, int, float)


def column(**more):
    """A column that is pressed on a plane, and turned aside at its top."""
    side = np.linspace(0.0, 1.0, 4)
    given = {
        "supports": [sg.Support("top", u=(0, 0.001, -0.01)), sg.Support("left", u=(0, None, None), name="side")],
        "loads": [sg.Load("block", gravity=(0.0, 0.0, -1e-6))],
        "contacts": [sg.Contact("bottom", Plane((0, 0, 0), (0, 0, 1)), friction=0.3)],
        "steps": [sg.Step(increments=2)],
    }
    bodies = [sg.Body("block", sg.Elastic(E=1.0, nu=0.3, density=1.0))]
    return sg.Model(box(x=side, y=side, z=np.linspace(0.0, 30.0, 181)), bodies=bodies, **(given | more))


def bolted():
    """A column in which a bolt pushes the foot down, whose length is locked before the column is pressed."""
    model = column()
    mesh = cut(model.mesh, "section", body="block", point=(0.0, 0.0, 15.0), normal=(0.0, 0.0, 1.0))
    steps = [
        sg.Step(name="tighten", increments=1, scale={"bolt": 1.0, "top": 0.0, "block": 1.0}),
        sg.Step(name="press", increments=1, hold=["bolt"], scale={"top": 1.0}),
    ]
    return replace(model, mesh=mesh, bolts=[sg.Bolt("section", force=-1e-4, name="bolt")], steps=steps)


MODELS = {
    "bolted column": bolted,
    "column": column,
    "pushed far": lambda: column(supports=[sg.Support("top", u=(0, 0, -6.0))], steps=[sg.Step(increments=1)]),
    "held by contact alone": lambda: column(
        supports=[],
        loads=[sg.Load("top", pressure=1e-4), sg.Load("bottom", traction=(1e-6, 0.0, 0.0), name="aside")],
        steps=[
            sg.Step(name="press", increments=1, scale={"top": 1.0}),
            sg.Step(name="push", increments=1, scale={"aside": 1.0}),
        ],
    ),
    "exact path": lambda: column(
        contacts=[sg.Contact("bottom", Plane((0, 0, 0), (0, 0, 1)), friction=0.3, facets=8)],
        steps=[sg.Step(path="exact")],
    ),
    "supports that change": lambda: column(
        steps=[
            sg.Step(name="press", increments=1),
            sg.Step(name="let go", increments=1, release=["side"]),
            sg.Step(name="hold", increments=1, restore=["side"]),
        ]
    ),
}


def large(roots, count):
    """Ways to arrays of ``count`` numbers and more that are not whole."""
    found, seen, left = [], set(), [(name, each) for name, each in roots.items()]
    while left:
        way, each = left.pop()
        if id(each) in seen or isinstance(each, _APART):
            continue
        seen.add(id(each))
        if isinstance(each, np.ndarray):
            if each.dtype.kind == "f" and each.size >= count:
                found.append(f"{way} {each.shape}")
        elif isinstance(each, types.FunctionType):
            left += [(way, cell.cell_contents) for cell in each.__closure__ or ()]
        elif isinstance(each, dict):
            left += [(f"{way}.{key}" if isinstance(key, str) else way, value) for key, value in each.items()]
        else:
            left += [(way, other) for other in gc.get_referents(each)]
    return sorted(found)


def counted(found, count):
    """Note who has all displacements, or forces on them, sent to the first rank from now on."""
    whole, chosen = ArrayOnRanks.whole, ArrayOnRanks.__getitem__

    def noted(array, entries):
        if not array.home and array.dtype.kind == "f" and entries >= count:
            frames = traceback.extract_stack()[:-2]
            found.append([f"{Path(each.filename).stem}.{each.name}" for each in frames if "signorini" in each.filename])

    def asked_whole(array):
        noted(array, len(array))
        return whole(array)

    def asked_some(array, index):
        noted(array, 0 if isinstance(index, slice) else np.size(index))
        return chosen(array, index)

    ArrayOnRanks.whole, ArrayOnRanks.__getitem__ = asked_whole, asked_some


def main():
    """Print the ways, step by step, and at the end; and who has asked for all displacements."""
    backend, name = sys.argv[1:]
    validity_notes._AT_ONCE = 100  # nodes: the mesh is small
    found = {}
    told = following.step_result

    def step_result(prepared, stage, followed, *rest, **options):
        result = told(prepared, stage, followed, *rest, **options)
        roots = {"prepared": prepared, "state": followed.after, "result": result}
        found[stage.title] = large(roots, prepared.model.mesh.number_of_nodes)
        return result

    following.step_result = step_result
    with sg.ranks() as first:
        if first:
            model = MODELS[name]()
            lend(model.mesh)
            asked = found["asked"] = []
            counted(asked, model.mesh.number_of_nodes)
            history = following.solve(model, backend=backend)
            found["asked"] = asked.copy()
            found["end"] = large({"model": model, "history": history}, model.mesh.number_of_nodes)
            print(json.dumps(found))


if __name__ == "__main__":
    main()

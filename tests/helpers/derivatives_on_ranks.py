"""Derivatives on all ranks beside those of one process: ``mpiexec -n 2 python -m tests.helpers.derivatives_on_ranks``.

Printed is by how much they differ, by model, output and parameter.
"""

import json
from dataclasses import replace

import numpy as np

import signorini as sg
from signorini.distributed import kept_rows
from signorini.distributed.ranks import lend
from signorini.gallery.cubes import cubes
from signorini.meshing.solid import box
from tests.helpers import on_ranks
from tests.helpers.first_rank import leaning, strip


def block(**more):
    """A block that comes down on a leaning plane, smooth cones or facets, under every kind of load."""
    side = np.linspace(0.0, 1.0, 4)
    return replace(
        leaning(**more),
        mesh=box(x=side, y=side, z=np.linspace(0.0, 3.0, 8)),
        bodies=[sg.Body("block", sg.Elastic(E=1.0, nu=0.3, density=1.0, expansion=1e-3))],
        loads=[
            sg.Load("block", gravity=(0.0, 1e-4, -1e-4)),
            sg.Load("right", pressure=lambda at: 1e-3 * (1.0 + at[:, 2]), name="aside"),
            sg.Load("block", temperature=0.2, name="heat"),
        ],
    )


def hot_strip(formulation):
    """A strip of cells of a formulation, as warm as it is high."""
    bodies = [sg.Body("block", sg.Elastic(E=1.0, nu=0.3, expansion=1e-4), formulation=formulation)]
    mesh = sg.rectangle(x=np.linspace(0.0, 1.0, 4).tolist(), y=np.linspace(0.0, 3.0, 9).tolist())
    loads = [sg.Load("block", temperature=lambda at: at[:, 1])]
    return replace(strip(), mesh=mesh, bodies=bodies, loads=loads)


BY_NODES = {
    "increments on springs": lambda: replace(block(), foundations=[sg.Foundation("left", normal_stiffness=0.01)]),
    "exact path in space": lambda: replace(block(facets=8), steps=[sg.Step(path="exact")]),
    "standard cells": lambda: hot_strip("standard"),
    "internal modes": lambda: hot_strip("incompatible"),
    "the paper's cylinder": on_ranks.MODELS["the paper's cylinder"],
}
MODELS = BY_NODES | {
    "two bodies": lambda: cubes(3),
    "mortar": on_ranks.MODELS["mortar"],
    "equations": on_ranks.MODELS["coupled unknowns"],
    "twist": on_ranks.MODELS["twist"],
}


def derived(model, backend, *, by_nodes):
    """Derivatives of three outputs: parts of them per part of what is given, and by places of nodes."""
    history, label, found = sg.solve(model, backend=backend, tape=True), model.contacts[0].label, {}
    node, body = model.mesh.number_of_nodes // 2, model.bodies[0].name
    own = int(next(iter(model.mesh.cells.values()))[model.mesh.bodies[body][0]][0])
    motion = np.sin(model.mesh.points + 0.3)
    for output in (
        sg.pressure(label).mean(),
        sg.displacement(node, along=(0.3,) * (model.components - 1) + (1.0,)),
        sg.stress(body, own, "yy"),
    ):
        change = history.derivative(output)
        of = {name: np.array([*getattr(change, name).values()]) / change.value for name in ("friction", "load")}
        for name in ("E", "nu", "expansion"):
            given = [getattr(body.material, name) for body in model.bodies]
            of[name] = np.array([*getattr(change, name).values()]) * given / change.value
        if by_nodes:
            of |= {"nodes": change.nodes, "shape": np.array([change.shape(motion)])}
        found[repr(output)] = of
    return found


def compared(name):
    """By how much derivatives of all ranks differ from those of one process, the largest of a kind or an output."""
    model, by_nodes = MODELS[name](), name in BY_NODES
    one = derived(model, "auto", by_nodes=by_nodes)
    lend(model.mesh)  # where there are several ranks, one of them has it no longer
    other = derived(model, "mumps", by_nodes=by_nodes)
    apart = {}
    for output, of in one.items():
        for kind, here in of.items():
            size = max(np.abs(here).max(initial=0.0), 0.0 if kind in ("nodes", "shape") else 1.0)
            apart[f"{output} by {kind}"] = float(np.abs(here - other[output][kind]).max(initial=0.0) / size)
    return apart


def main():
    """Print what is found, by name."""
    kept_rows._WORTH = 1  # models are small
    with sg.ranks() as first:
        if first:
            print(json.dumps({name: compared(name) for name in MODELS}))


if __name__ == "__main__":
    main()

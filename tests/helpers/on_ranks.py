"""Models that ranks solve, and what they say of them: ``mpiexec -n 2 python -m tests.helpers.on_ranks NAME ...``.

With ``--backend mumps`` they are factorised, and steps go as they do by themselves, with ``--twice`` as if pairs were
many; with ``--cut WAY`` nodes or pairs are where no METIS and no even share would have them.
"""

import argparse
import json
from dataclasses import replace

import numpy as np

import signorini as sg
from signorini.distributed import kept_rows
from signorini.distributed.ranks import lend
from signorini.gallery.blocks import block_on_foundation, dragged_block, four_blocks, stacked_blocks
from signorini.gallery.bolts import bolted_sleeve
from signorini.gallery.closures import block_on_a_bed
from signorini.gallery.cubes import cubes
from signorini.gallery.cylinder import zhu_cylinder
from signorini.gallery.half_spaces import ball
from signorini.gallery.sectors import ring_on_shaft
from signorini.gallery.twisted import ring_under_torque
from signorini.meshing.solid import box
from signorini.model.mesh import join
from tests.helpers import first_rank


def in_increments(model):
    """A model whose steps say how they go on: what is iterated has no exact path."""
    return replace(model, steps=[replace(step, increments=step.increments or 1) for step in model.steps])


def floating(friction=0.3):
    """A block on another that does not match it, held by friction alone, or tied."""
    fine, coarse = np.linspace(0, 1, 5), np.linspace(-0.5, 1.5, 4)
    low, up = box(x=coarse, y=coarse, z=[-1, 0]), box(x=fine, y=fine, z=fine)
    return sg.Model(
        join({"low": low, "up": up}),
        bodies=[sg.Body(name, sg.Elastic(E=2e5, nu=0.3)) for name in ("low", "up")],
        supports=[sg.Support("low.bottom", u=(0, 0, 0))],
        loads=[sg.Load("up.top", traction=(5.0, 2.0, -50.0))],
        contacts=[sg.Contact("up.bottom", "low.top", friction=friction)],
        steps=[sg.Step(increments=1)],
    )


def several_steps():
    """A warm block on springs under a moving obstacle; a side is let go in the second step, contact in the third."""
    mesh = sg.rectangle(width=3.0, height=1.0, nx=9, ny=4)
    return sg.Model(
        mesh,
        bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3, expansion=1e-4), formulation="incompatible")],
        supports=[sg.Support("left", u=(0, None)), sg.Support("right", u=(0, None), name="side")],
        foundations=[sg.Foundation("bottom", normal_stiffness=500.0, tangential_stiffness=100.0)],
        loads=[sg.Load("block", temperature=5.0, name="heat")],
        obstacles=[sg.Rigid("punch", sg.Circle((1.4, 3.0), 2.0), u=(0.01, -0.05))],
        contacts=[sg.Contact("top", "punch", friction=0.3, name="touch")],
        steps=[
            sg.Step(name="press", increments=2),
            sg.Step(name="let go", increments=1, release=["side"]),
            sg.Step(name="off", increments=1, inactive=["touch"]),
        ],
    )


def held_again():
    """Blocks whose side is let go under a load that grows, held where it is then, and brought back."""
    model, factors = coupled(), [{"up.top": factor} for factor in (0.4, 0.6, 0.8, 1.0)]
    return replace(
        model,
        supports=[*model.supports, sg.Support("low.left", u=(0, None), name="side")],
        steps=[
            sg.Step(name="press", increments=1, scale=factors[0]),
            sg.Step(name="let go", increments=2, release=["side"], scale=factors[1]),
            sg.Step(name="hold", increments=1, hold=["side"], scale=factors[2]),
            sg.Step(name="bring back", increments=2, restore=["side"], scale=factors[3]),
        ],
    )


def coupled():
    """A block whose top moves as one, and one whose side follows an equation: unknowns that several ranks feel."""
    mesh = join(
        {
            "low": sg.rectangle(width=3.0, height=1.0, nx=7, ny=3),
            "up": sg.rectangle(x=np.linspace(0.5, 2.0, 6).tolist(), y=[1.0, 1.5, 2.0]),
        }
    )
    return sg.Model(
        mesh,
        bodies=[sg.Body(name, sg.Elastic(E=1000.0, nu=0.3)) for name in ("low", "up")],
        supports=[sg.Support("low.bottom", u=(0, 0))],
        loads=[sg.Load("up.top", force=(1.0, -20.0), spread="displacement")],
        contacts=[sg.Contact("up.bottom", "low.top", friction=0.4)],
        steps=[sg.Step(increments=2)],
    )


MODELS = {
    "cubes": lambda: cubes(4, 3),
    "cubes, frictionless": lambda: cubes(4, 3, friction=0.0),
    "ball on block": lambda: ball(n=2, block=3),
    "the paper's cylinder": lambda: zhu_cylinder(refine=2),
    "four blocks": four_blocks,
    "mortar": lambda: stacked_blocks(friction=0.3, across=(7, 5), cells="quad8"),
    "load beside the contact": lambda: block_on_foundation(friction=0.3, across=(5, 7)),
    "several loads": dragged_block,
    "several steps": several_steps,
    "held by contact alone": floating,
    "tied": lambda: floating("tied"),
    "axisymmetric": lambda: block_on_a_bed(kind="axisymmetric", friction=0.2, steps=[sg.Step(increments=2)]),
    "a closure": lambda: block_on_a_bed("1.0 + x", friction=0.0, steps=[sg.Step(increments=2)]),
    "coupled unknowns": coupled,
    "a bolt that is locked": lambda: bolted_sleeve()[0],
    "supports that hold again": held_again,
    "a sector": lambda: ring_on_shaft(whole=False),
    "twist": ring_under_torque,
}


def exactly(model):
    """A model whose steps are all followed from event to event."""
    return replace(model, steps=[replace(step, path="exact", increments=None) for step in model.steps])


def section(**law):
    """Cubes with a friction cone whose section is no circle."""
    model = cubes(2)
    return replace(model, contacts=[replace(model.contacts[0], **law)])


def rolled_block():
    """A block under a rigid ball that contact alone holds."""
    free = {"u": (None, None), "rotation": None, "force": (0.5, -5.0), "moment": 0.0}
    return sg.Model(
        sg.rectangle(width=3.0, height=1.0, nx=6, ny=2),
        bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))],
        supports=[sg.Support("bottom", u=(0, 0))],
        obstacles=[sg.Rigid("ball", sg.Circle((1.5, 4.0), 3.0), **free)],
        contacts=[sg.Contact("top", "ball", friction=0.3)],
        steps=[sg.Step(increments=1)],
    )


CONDENSED = {
    "exact path": lambda: exactly(dragged_block()),
    "exact path in space": lambda: exactly(section(facets=8)),
    "facets": lambda: section(facets=8),
    "two coefficients": lambda: section(friction=(0.3, 0.2), friction_axis=(1.0, 0.0, 0.0)),
    "a rigid body that contact alone holds": rolled_block,
    "a body that rests, and approaches": first_rank.MODELS["rests, approaches"],
}
"""Models that ask for the condensed interface by themselves."""


def compared(name, backend="petsc"):
    """How far the answers of all ranks are from those of the factorised bodies."""
    model = (MODELS | CONDENSED)[name]()
    model = in_increments(model) if backend == "petsc" and name in MODELS else model
    here = sg.solve(model)
    lend(model.mesh)  # where there are several ranks, one of them has it no longer
    there = sg.solve(model, backend=backend)
    found = {"back ends": [here.backend, there.backend], "pressure": 0.0, "traction": 0.0, "states": 0}
    found["passed"] = all(step.certificate.passed for step in there.steps)
    found["displacement"] = 0.0
    found["paths"] = [[step.path for step in history.steps] for history in (here, there)]
    for one, other in zip(here.steps, there.steps, strict=True):
        size = np.abs(one.displacement).max()
        found["displacement"] = max(
            found["displacement"], float(np.abs(one.displacement - other.displacement).max() / size)
        )
        for a, b in zip(one.contacts, other.contacts, strict=True):
            size = np.abs(a.pressure).max() or 1.0
            for key in ("pressure", "traction"):
                apart = float(np.abs(getattr(a, key) - getattr(b, key)).max() / size)
                found[key] = max(found[key], apart)
            found["states"] += int((a.status != b.status).sum())
    return found


def scattered(count, ranks):
    """Nodes or pairs on ranks at random, all of which have some."""
    return np.random.default_rng(3).permutation(np.arange(count) % ranks)


def on_the_last(B, count, d, ranks):
    """Nodes that pairs see on the last rank, so that the contact is there as a whole; others on any of the rest."""
    owner = scattered(count, ranks - 1)
    seen = B.indices // d
    owner[seen[seen < count]] = ranks - 1  # obstacles, which are seen too, are behind the nodes
    return owner


def placed(way):
    """Put nodes or pairs elsewhere from now on; the first rank alone asks where they are."""
    from signorini.distributed import bodies, stiffness  # needs PETSc

    if way == "scattered nodes":
        stiffness.owners = lambda space, _, ranks: scattered(len(space.mesh.points), ranks)
    elif way == "the contact on one":
        stiffness.owners = lambda space, B, ranks: on_the_last(B, len(space.mesh.points), space.components, ranks)
    elif way == "scattered pairs":
        bodies.pair_owners = lambda _, at, centres: scattered(len(at), len(centres))
    elif way == "all pairs on one":
        bodies.pair_owners = lambda _, at, centres: np.full(len(at), len(centres) - 1)


WAYS = ("scattered nodes", "the contact on one", "scattered pairs", "all pairs on one")


def main():
    """Print what is found, by name."""
    parser = argparse.ArgumentParser()
    parser.add_argument("names", nargs="*", help="models; all of them where none is named")
    parser.add_argument("--cut", choices=WAYS)
    parser.add_argument("--backend", default="petsc")
    parser.add_argument("--twice", action="store_true")
    options = parser.parse_args()
    if options.twice:
        from signorini.distributed import factors  # needs PETSc

        factors._WIDE = -1
    kept_rows._WORTH = 1  # models are small
    with sg.ranks() as first:
        if first:
            placed(options.cut)
            print(json.dumps({name: compared(name, options.backend) for name in options.names or MODELS}))


if __name__ == "__main__":
    main()

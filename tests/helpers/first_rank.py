"""What the first rank holds of a model that ranks solve: ``mpiexec -n 3 python -m tests.helpers.first_rank WAY NAME``.

A column has many nodes and few pairs, so that whatever is as large as the mesh is larger than all that is known of the
interface. Printed are numbers that are not whole in arrays with as many of them as there are nodes, by the way from
the prepared model, the states and the history to them; what the first rank holds as one of the ranks is left out.
"""

import gc
import json
import sys
import tempfile
import types
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np

import signorini as sg
from signorini.clock import Clock
from signorini.derivative import body_side
from signorini.distributed.ranks import Team, lend
from signorini.engine import prepare, validity_notes
from signorini.engine import solve as following
from signorini.engine.fatigue_on_ranks import PlacesOnRanks
from signorini.fem import loads, space, supports
from signorini.meshing.cut import cut
from signorini.meshing.plane import annulus
from signorini.meshing.solid import box
from signorini.model.mesh import join
from signorini.model.obstacle import Plane
from signorini.model.outputs import WeightedSum
from signorini.output import by_rows
from signorini.output.dat import write_dat
from signorini.output.fields import Fields
from signorini.output.folder import Publisher
from signorini.output.frd import write_frd
from signorini.output.rank_files import FieldsOnRanks
from signorini.output.table import history_table
from tests.helpers.rank_files import all_prints, differing

HERE = Path(sg.__file__).parent
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
    given["bodies"] = [sg.Body("block", sg.Elastic(E=1.0, nu=0.3, density=1.0))]
    return sg.Model(box(x=side, y=side, z=np.linspace(0.0, 30.0, 181)), **(given | more))


def leaning(**more):
    """The column above a plane that leans, on which its nodes come down one after the other."""
    side, plane = np.linspace(0.0, 1.0, 3), Plane((0, 0, -0.001), (0.002, 0.001, 1))
    return replace(
        column(),
        mesh=box(x=side, y=side, z=np.linspace(0.0, 30.0, 401)),
        supports=[sg.Support("top", u=(0, 0.001, -0.01))],
        contacts=[sg.Contact("bottom", plane, friction=0.3, **more)],
    )


def bolted():
    """A column in which a bolt pushes the foot down, whose length is locked before the column is pressed."""
    model = column()
    mesh = cut(model.mesh, "section", body="block", point=(0.0, 0.0, 15.0), normal=(0.0, 0.0, 1.0))
    steps = [
        sg.Step(name="tighten", increments=1, scale={"bolt": 1.0, "top": 0.0, "block": 1.0}),
        sg.Step(name="press", increments=1, hold=["bolt"], scale={"top": 1.0}),
    ]
    return replace(model, mesh=mesh, bolts=[sg.Bolt("section", force=-1e-4, name="bolt")], steps=steps)


def stacked(gap=0.0, **more):
    """A column on a block, tied to it, or above it and held by nothing else."""
    side = np.linspace(0.0, 1.0, 3)
    foot = box(x=side, y=side, z=np.linspace(-1.0, 0.0, 3))
    mesh = join({"foot": foot, "column": box(x=side, y=side, z=np.linspace(gap, 30.0 + gap, 401))})
    given = {
        "supports": [sg.Support("foot.bottom", u=(0, 0, 0))],
        "contacts": [sg.Contact("column.bottom", "foot.top", friction=0.3, facets=8)],
    }
    bodies = [sg.Body(name, sg.Elastic(E=1.0, nu=0.3)) for name in ("foot", "column")]
    return sg.Model(mesh, bodies=bodies, **(given | more))


def strip(**more):
    """A tall strip that is pressed on a leaning plane, and turned aside; some of its left side is named."""
    mesh = sg.rectangle(x=np.linspace(0.0, 1.0, 5).tolist(), y=np.linspace(0.0, 30.0, 601).tolist())
    return sg.Model(
        replace(mesh, boundaries=dict(mesh.boundaries) | {"bed": mesh.boundaries["left"][300:320]}),
        bodies=[sg.Body("block", sg.Elastic(E=1.0, nu=0.3))],
        supports=[sg.Support("top", u=(0.001, -0.3))],
        contacts=[sg.Contact("bottom", Plane((0.0, -0.01), (0.05, 1.0)), friction=0.3)],
        steps=[sg.Step(path="exact")],
        **more,
    )


def half_ring():
    """One of two sectors of a ring: pads hold it from outside and press it from inside, far from the sides."""
    arc = annulus(inner=1.0, outer=1.5, n_radial=4, n_angular=400, angle=180.0)
    edges = {side: arc.boundaries[side] for side in ("start", "end")}
    edges |= {f"patch {side}": arc.boundaries[side][190:210] for side in ("inner", "outer")}
    pad = annulus(inner=0.9, outer=1.0, n_radial=2, n_angular=4, angle=2.0)
    turn = np.radians(89.0)
    away = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    return sg.Model(
        join({"ring": replace(arc, boundaries=edges), "pad": replace(pad, points=pad.points @ away)}),
        bodies=[sg.Body(name, sg.Elastic(E=1.0, nu=0.3)) for name in ("ring", "pad")],
        supports=[sg.Support("pad.inner", u=(0, 0)), sg.Support("ring.patch outer", u=(0.001, 0))],
        contacts=[sg.Contact("pad.outer", "ring.patch inner", friction=0.3, interference=0.001)],
        cyclic_symmetries=[sg.CyclicSymmetry("ring.start", "ring.end", sectors=2)],
        steps=[sg.Step(increments=2)],
        fatigue=judged("ring", "pad.outer"),
    )


def judged(body, contact):
    """Criteria of fatigue, at all nodes of a body and on the pairs of a contact."""
    return [sg.Fatigue(sg.fatigue.SWT(), where=body), sg.Fatigue(sg.fatigue.Ruiz(), where=contact)]


def solved(model, backend, _):
    """The history of a model, whatever ends it."""
    return following.solve(model, backend=backend, raise_on_failure=False)


def derived(model, backend, motion):
    """The history of a model, of which was asked how outputs change with friction, stiffness, gaps and places."""
    found, middle = sg.solve(model, backend=backend, tape=True), model.mesh.number_of_nodes // 2
    outputs = [
        sg.pressure("bottom").mean(),
        sg.displacement(middle, along=(0.0,) * (model.dimension - 1) + (1.0,)),
        sg.stress("block", middle, "xx"),
    ]
    change = found.derivative(WeightedSum(parts=tuple(zip((1.0, 2.0, 3.0), outputs, strict=True))))
    assert np.isfinite(change.friction["bottom"])  # it is none where all pairs stick
    assert change.E["block"] * change.nu["block"] * change.shape(motion)
    assert change.holds("nu.block").low < 0.0 < change.holds("nu.block").high
    assert change.gap["bottom"].any()
    assert change._by_nodes.any()
    return found


ASKED = dict.fromkeys(("derivatives", "on springs", "derivatives in space", "derivatives of increments"), derived)
FACTORISED = (  # whatever they are asked for
    *(*ASKED, "exact path", "fatigue on an exact path", "rests, approaches", "switched off"),
)
MODELS = {
    "derivatives": strip,
    "on springs": lambda: strip(foundations=[sg.Foundation("bed", normal_stiffness=0.01)]),
    "derivatives in space": lambda: replace(leaning(facets=8), steps=[sg.Step(path="exact")]),
    "derivatives of increments": leaning,
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
    "fatigue on an exact path": lambda: column(
        contacts=[sg.Contact("bottom", Plane((0, 0, 0), (0, 0, 1)), friction=0.3, facets=8)],
        steps=[sg.Step(path="exact")],
        fatigue=judged("block", "bottom"),
    ),
    "half a ring, fatigue": half_ring,
    "tied": lambda: stacked(
        supports=[sg.Support("foot.bottom", u=(0, 0, 0)), sg.Support("column.top", u=(0, 0.001, -0.01))],
        contacts=[sg.Contact("column.bottom", "foot.top", friction="tied")],
        steps=[sg.Step(increments=2)],
    ),
    "rests, approaches": lambda: stacked(
        0.5,
        loads=[sg.Load("foot.left", pressure=1e-4, name="aside"), sg.Load("column.top", pressure=1e-4)],
        steps=[
            sg.Step(name="aside", path="exact", scale={"aside": 1.0}),
            sg.Step(name="down", path="exact", scale={"column.top": 1.0}),
        ],
    ),
    "pulled away": lambda: stacked(loads=[sg.Load("column.top", pressure=-1e-4)], steps=[sg.Step(increments=1)]),
    "switched off": lambda: column(
        contacts=[sg.Contact("bottom", Plane((0, 0, 0), (0, 0, 1)), friction=0.3, facets=8)],
        steps=[sg.Step(name="press", path="exact"), sg.Step(name="off", path="exact", inactive=["bottom"])],
    ),
    "supports that change": lambda: column(
        steps=[
            sg.Step(name="press", increments=1),
            sg.Step(name="let go", increments=1, release=["side"]),
            sg.Step(name="hold", increments=1, restore=["side"]),
        ]
    ),
}


def square(array):
    """Whether an array is a square matrix, which is of the interface: none of all displacements is dense."""
    return array.ndim == 2 and len(array) == array.shape[1]


def large(roots, count, *, matrices=True):
    """Ways to arrays of ``count`` numbers and more that are not whole; to square matrices only where they count."""
    found, seen, left = [], set(), [(name, each) for name, each in roots.items()]
    while left:
        way, each = left.pop()
        if id(each) in seen or isinstance(each, _APART):
            continue
        seen.add(id(each))
        if isinstance(each, np.ndarray):
            if each.dtype.kind == "f" and each.size >= count and (matrices or not square(each)):
                found.append(f"{way} {each.shape}")
        elif isinstance(each, types.FunctionType):
            left += [(way, cell.cell_contents) for cell in each.__closure__ or ()]
        elif isinstance(each, dict):
            left += [(f"{way}.{key}" if isinstance(key, str) else way, value) for key, value in each.items()]
        else:
            left += [(way, other) for other in gc.get_referents(each)]
    return sorted(found)


class Watch:
    """Notes functions of ours that have, when they return, so many numbers that are not whole in an array.

    What the first rank does as one of the ranks is left out, and square matrices, which are of the interface.

    Attributes
    ----------
    moved : where nodes move, a motion of all of them that is given, and their places, (nodes, d) each: these are left
        out then, and places a little beside them, which the first rank has while it makes pairs anew
    """

    def __init__(self, count):
        self.found, self.count, self.elsewhere, self.moved = set(), count, 0, None

    @contextmanager
    def away(self):
        """Look elsewhere in the block."""
        self.elsewhere += 1
        try:
            yield
        finally:
            self.elsewhere -= 1

    def without(self, kind, name):
        """Leave out what a function of a class or module does."""
        method = getattr(kind, name)

        def left_out(*given, **options):
            with self.away():
                return method(*given, **options)

        setattr(kind, name, left_out)

    def __call__(self, frame, event, answer):
        code = frame.f_code
        if event == "return" and not self.elsewhere and HERE in Path(code.co_filename).parents:
            held = [*frame.f_locals.items(), ("what it returns", answer)]
            names = [name for name, value in held if self.large(value)]
            self.found |= {f"{Path(code.co_filename).stem}.{code.co_name}: {name}" for name in names}

    def large(self, value):
        """Whether something is such an array, or lists one."""
        if isinstance(value, list | tuple | dict):
            return any(map(self.large, value.values() if isinstance(value, dict) else value))
        if not (isinstance(value, np.ndarray) and value.dtype.kind == "f" and value.size >= self.count):
            return False
        return not (square(value) or (self.moved is not None and self.of_motion(value)))

    def of_motion(self, value):
        """Whether an array is the motion that is given, or holds where all nodes are, and obstacles behind them."""
        motion, points = self.moved
        if np.may_share_memory(value, motion):
            return True
        count, d = points.shape
        if value.ndim != 2 or value.shape[1] != d or len(value) < count:
            return False
        return np.allclose(value[:count], points, rtol=0, atol=1e-3)


def written_otherwise(history, prints, folder):
    """Tables of files of text that are other ones where one process recovers all fields."""
    if not history.steps:
        return []
    fields = Fields(history.model)
    write_frd(history, fields, folder / "one.frd", prints.times)
    write_dat(history, fields, prints, folder / "one.dat")
    return [table for end in ("frd", "dat") for table in differing(folder / f"one.{end}", folder / f"solution.{end}")]


def published(history):
    """Write all files of a history; what `written_otherwise` finds of them."""
    with tempfile.TemporaryDirectory() as name:
        folder, prints = Path(name), all_prints(history.model, len(history.steps))
        Publisher(folder=folder, clock=Clock(), started=0.0, prints=prints).publish(history)
        assert history_table(history)
        sys.setprofile(None)
        return written_otherwise(history, prints, folder)


def main():
    """Print the ways, step by step, and at the end; and who has had all displacements once bodies were on the ranks."""
    from signorini.engine import solver_on_ranks  # needs PETSc

    backend, name = sys.argv[1:]
    validity_notes._AT_ONCE, loads._AT_ONCE, by_rows._AT_ONCE = 100, 20, 20  # nodes and cells: the mesh is small
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
            motion, points = np.sin(model.mesh.points), model.mesh.points.copy()
            lend(model.mesh)
            watch, kept = Watch(model.mesh.number_of_nodes), solver_on_ranks.kept_on_ranks
            watch.without(Team, "_done")
            for made in ("transform_of", "selection"):  # of other supports: which displacements are free, and ones
                watch.without(supports, made)
            if name in ASKED:
                watch.moved = motion, points
                for module, made in ((body_side, "make_interface"), (space, "make_facets")):  # pairs where nodes moved
                    watch.without(module, made)
            watch.without(prepare, "resistance")  # what they hold of rigid motions: one is the side of the column

            def kept_on_ranks(*given):
                sys.setprofile(None)
                found = kept(*given)
                sys.setprofile(watch)
                return found

            solver_on_ranks.kept_on_ranks = kept_on_ranks
            for sending in (FieldsOnRanks, PlacesOnRanks):
                watch.without(sending, "__init__")  # ranks are sent their cells
            history = ASKED.get(name, solved)(model, backend, motion)
            found["files of text"] = [] if name in ASKED else published(history)
            sys.setprofile(None)
            found["watched"] = sorted(watch.found)
            left = {"model": model, "history": history}  # of derivatives matrices of the interface, too
            found["end"] = large(left, model.mesh.number_of_nodes, matrices=name not in ASKED)
            print(json.dumps(found))


if __name__ == "__main__":
    main()

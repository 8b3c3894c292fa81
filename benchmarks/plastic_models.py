# SPDX-License-Identifier: BSD-3-Clause
"""Random small models with bodies that yield, in the words of the package and in those of `independent_plastic`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from scipy.linalg import block_diag

import signorini as sg
from benchmarks import independent_plastic as own
from benchmarks.independent_history import Acts
from signorini.engine.prepare import prepare

GEOMETRIES = ("plane strain", "plane stress", "axisymmetric", "space")
LAWS = ("perfect", "table", "prager", "frederick", "combined")
FLAT = ("quad", "quad8", "quad9", "triangle6")
SOLID = ("hexahedron", "hexahedron20", "hexahedron27", "tetra10", "wedge15")
BODIES = ("incompatible", "two", "mortar", "curved", "elastic", "rigid", "tied", "round")
ACTIONS = ("driven", "moving", "heated", "softened", "overlap")
STEPS = ("auto", "iterated", "restart", "units", "turned")
KINDS = (*GEOMETRIES, *FLAT, *SOLID, *LAWS, *BODIES, *ACTIONS, *STEPS)
_MORE = ("incompatible", "elastic", "rigid", "tied", "round", "moving", "heated", "softened", "overlap", *STEPS)
_SHARE = 0.15  # of models that have one of them
_TWO_BODIES = ("two", "mortar", "curved", "elastic", "rigid", "tied")
_WITHOUT = {"moving": _TWO_BODIES, "round": _TWO_BODIES, "overlap": ("tied",), "elastic": ("rigid",)}
"""What is left to chance but does not go with a kind that is wanted."""

E, NU, EXPANSION = 200.0, 0.3, 1e-3


@dataclass(kw_only=True)
class Case:
    """A random model, and the same in the words of the adversary.

    Attributes
    ----------
    kinds : what was mixed in
    structure : bodies and pairs
    unit : what acts for a factor of 1, by name of the load, support or obstacle
    overlaps : of the pairs, length, at the beginning and at the end of every step
    """

    seed: int
    kinds: frozenset[str]
    model: sg.Model
    structure: own.Structure
    unit: dict[str, Acts]
    overlaps: Sequence[float]

    def acts(self, factors: Mapping[str, float], time: float) -> Acts:
        """What acts at factors by name, and after so many steps."""
        found = Acts.none(self.structure)
        for name, unit in self.unit.items():
            found = found.plus(unit, factors[name])
        found.apart[0, ~self.structure.tied] -= np.interp(time, np.arange(len(self.overlaps)), self.overlaps)
        return found


def chosen(rng: np.random.Generator, wanted: frozenset[str]) -> frozenset[str]:
    """What a model is made of: one geometry, one law, one family, and some more."""

    def one_of(names: tuple[str, ...], odds: tuple[float, ...]) -> str:
        name = str(rng.choice(names, p=odds))
        return next((asked for asked in names if asked in wanted), name)

    geometry = one_of(GEOMETRIES, (0.4, 0.25, 0.15, 0.2))
    if wanted & set(SOLID):
        geometry = "space"
    elif geometry == "space" and wanted & {*FLAT, "curved"}:
        geometry = GEOMETRIES[0]
    law = one_of(LAWS, (0.3, 0.2, 0.1, 0.2, 0.2))
    families = SOLID if geometry == "space" else FLAT
    family = str(rng.choice(families, p=[0.5, *[0.5 / (len(families) - 1)] * (len(families) - 1)]))
    family = families[0] if "incompatible" in wanted else family
    family = next((asked for asked in families if asked in wanted), family)
    found = {kind for kind in ("two", "mortar", "curved", "driven") if rng.random() < 0.5}
    found |= {kind for kind in _MORE if rng.random() < _SHARE}
    found -= {other for kind in wanted for other in _WITHOUT.get(kind, ())} - wanted
    found |= wanted | ({"two"} if "curved" in wanted else set())
    found = found - {*GEOMETRIES, *LAWS, *FLAT, *SOLID} | {geometry, law, family}
    return consistent(found)


def consistent(kinds: set[str]) -> frozenset[str]:
    """Without what does not go together."""
    found = set(kinds)
    if found & {"mortar", "elastic", "rigid", "tied"}:
        found.add("two")
    if "rigid" in found:
        found -= {"elastic"}
    if "softened" in found:
        found.add("heated")
    if "two" in found:
        found -= {"moving", "round"}
    if "two" not in found or "space" in found:
        found -= {"curved"}
    if "tied" in found:
        found -= {"overlap"}
    if not found & {"quad", "hexahedron"}:
        found -= {"incompatible"}
    return frozenset(found)


def plastic(rng: np.random.Generator, law: str, yields: float, heat: float = 0.0) -> sg.Plastic:
    """A random law.

    Parameters
    ----------
    rng : random numbers
    law : one of `LAWS`
    yields : yield stress
    heat : temperatures about which the yield stress changes; 0: it does not
    """
    H = float(rng.choice([1e-3, 1e-2, 0.1])) * E
    if heat:
        made = plastic(rng, law, yields)
        warm = heat * np.array([-1.0, 0.0, rng.uniform(0.5, 1.0), 2.0])
        parts = [rng.uniform(1.0, 1.2), 1.0, *rng.uniform(0.75, 1.05, 2)]
        rows = [(p, part * Y, T) for T, part in zip(warm, parts, strict=True) for p, Y in made.curve]
        return replace(made, yield_stress=rows)
    if law == "combined":
        rows = [(0.0, yields), (5e-3, yields + 5e-3 * H)]
        return sg.Plastic(rows, hardening=0.1 * H, backstresses=[(0.5 * H, 0.0), (H, 2.0 * H / yields)])
    if law == "table":
        rows = [(0.0, yields), (2e-3, yields + 2e-3 * H), (1e-2, yields + 5e-3 * H)]
        return sg.Plastic(rows, hardening=0.2 * H)
    if law == "prager":
        return sg.Plastic(yields, backstresses=[(H, 0.0)])
    if law == "frederick":
        return sg.Plastic(yields, hardening=0.05 * H, backstresses=[(H, 3.0 * H / yields), (0.1 * H, 0.0)])
    return sg.Plastic(yields)


@dataclass(kw_only=True)
class _Maker:
    """A model in the making.

    Attributes
    ----------
    d : dimension
    mesh, names : and its bodies, the upper one first
    top : the boundary that is pressed, dragged and guided
    """

    rng: np.random.Generator
    kinds: frozenset[str]
    d: int
    mesh: sg.Mesh
    names: list[str]
    supports: list[sg.Support] = field(default_factory=list)
    loads: list[sg.Load] = field(default_factory=list)
    held: set[int] = field(default_factory=set)
    groups: list[np.ndarray] = field(default_factory=list)
    acting: dict[str, tuple[str, np.ndarray]] = field(default_factory=dict)

    def boundary(self, body: str, side: str) -> str:
        return f"{body}.{side}" if len(self.names) > 1 else side

    @property
    def top(self) -> str:
        return self.boundary(self.names[0], "top")

    def nodes_of(self, side: str) -> np.ndarray:
        """All nodes of a side; faces of wedges are named by their corners."""
        found: np.ndarray = self.mesh.nodes_of(side)
        if "wedge15" not in self.kinds:
            return found
        low, high = self.mesh.points[found].min(axis=0), self.mesh.points[found].max(axis=0)
        return np.flatnonzero(((self.mesh.points >= low) & (self.mesh.points <= high)).all(axis=1))

    def rows(self, nodes: np.ndarray, direction: int) -> np.ndarray:
        found: np.ndarray = self.d * nodes + direction
        return found

    def act(self, name: str, direction: int, force: float, motion: float) -> None:
        """On the top, which stays straight: a motion where it is driven, otherwise a force.

        Parameters
        ----------
        name : of it
        direction : number of the axis
        force, motion : for a factor of 1
        """
        rows = self.rows(self.nodes_of(self.top), direction)
        given: list[float | None] = [None] * self.d
        unit = np.zeros(self.mesh.points.size)  # of nodes alone: modes are not acted on
        if "driven" in self.kinds:
            given[direction] = motion
            self.supports.append(sg.Support(self.top, u=tuple(given), name=name))
            unit[rows] = motion
            self.acting[name] = "held", unit
            self.held.update(rows.tolist())
        else:
            given[direction] = force
            self.loads.append(sg.Load(self.top, force=tuple(given), spread="displacement", name=name))
            unit[rows[0]] = force
            self.acting[name] = "force", unit
            self.groups.append(rows)

    def hold(self, on: str, directions: Sequence[int], name: str = "") -> None:
        """Fix nodes of a boundary."""
        given = [0.0 if k in directions else None for k in range(self.d)]
        self.supports.append(sg.Support(on, u=tuple(given), name=name))
        self.held |= {int(row) for k in directions for row in self.rows(self.nodes_of(on), k)}


def _block(rng: np.random.Generator, kinds: frozenset[str], wide: float, columns: int, low: float) -> sg.Mesh:
    """A box of height 1 from ``low`` up; from the axis on where it is a disc."""
    rows = int(rng.integers(2, 4))
    if "space" in kinds:
        family = next(kind for kind in SOLID if kind in kinds)
        columns, rows = (columns, rows) if family == "hexahedron" else (columns - 1, 1)
        line, z = np.linspace(-wide / 2, wide / 2, columns + 1), np.linspace(low, low + 1.0, rows + 1)
        if family != "wedge15":
            return sg.box(x=line, y=line, z=z, cells=family)
        flat = sg.rectangle(x=line, y=line, cells="triangle6")
        sides = {"bottom": "front", "top": "back"}
        walls = {sides.get(name, name): edges for name, edges in flat.boundaries.items()}
        return sg.extruded(replace(flat, boundaries=walls), z=z)
    begin = 0.0 if "axisymmetric" in kinds else -wide / 2
    family = next(kind for kind in FLAT if kind in kinds)
    count = columns if family == "quad" else max(2, columns // 2)
    lines = {"x": np.linspace(begin, wide / 2, count + 1), "y": np.linspace(low, low + 1.0, rows + 1)}
    mesh: sg.Mesh = sg.rectangle(cells=family, **lines)
    return mesh


def _mesh(rng: np.random.Generator, kinds: frozenset[str]) -> sg.Mesh:
    """One block, or two on one another."""
    most = 4 if "space" in kinds else 7
    columns = int(rng.integers(2, most))
    upper = _block(rng, kinds, 2.0, columns, 0.0)
    if "curved" in kinds:
        at = np.array(upper.points)
        at[:, 1] += at[:, 0] ** 2 / (2 * rng.uniform(5, 40)) * (1 - at[:, 1])
        upper = replace(upper, points=at)
    if "two" not in kinds:
        return upper
    wide, other = (3.0, int(rng.integers(2, most))) if "mortar" in kinds else (2.0, columns)
    return sg.join({"upper": upper, "lower": _block(rng, kinds, wide, other, -1.0)})


def make(seed: int, wanted: frozenset[str] = frozenset(), *, exactly: bool = False) -> Case:
    """The model of a seed; the same seed makes the same one.

    Parameters
    ----------
    seed : of random numbers
    wanted : kinds that it has at least
    exactly : whether it has no others
    """
    rng = np.random.default_rng((seed, 1))
    kinds = consistent(set(wanted)) if exactly else chosen(np.random.default_rng(seed), wanted)
    mesh = _mesh(rng, kinds)
    made = _Maker(rng=rng, kinds=kinds, d=mesh.points.shape[1], mesh=mesh, names=list(mesh.bodies))
    d, two, ring = made.d, "two" in kinds, "axisymmetric" in kinds
    geometry = next(kind for kind in GEOMETRIES if kind in kinds)
    friction = float(rng.choice([0.0, 0.1, 0.3, 0.6, 1.0]))
    drags = (friction > 0 or "tied" in kinds) and not ring
    level = rng.uniform(0.8, 1.08)
    strength = 1.155 if geometry == "plane strain" else 1.0
    Y = 1.0 / level / strength  # a mean pressure of 1 is `level` of what the block bears
    strain = Y / E
    area = {2: 2.0, 3: 4.0}[d] * (np.pi / 2 if ring else 1.0)
    thickness = float(rng.choice([1.0, 0.3])) if geometry in GEOMETRIES[:2] else 1.0
    law = next(kind for kind in LAWS if kind in kinds)
    warmth = strain / EXPANSION if "softened" in kinds else 0.0
    stiff = float(rng.choice([70.0, 200.0, 600.0]))
    upper = sg.Elastic(E=E, nu=NU, expansion=EXPANSION, plastic=plastic(rng, law, Y, warmth))
    lower = sg.Elastic(E=stiff, nu=NU, plastic=None if kinds & {"elastic", "rigid"} else plastic(rng, law, Y))
    motion = 2.0 * len(made.names) * strain
    made.act("press", d - 1, -area * thickness, -motion)
    if drags:
        made.act("drag", 0, area * thickness, motion)
    fixed = [k for k in range(d - 1) if not (drags and k == 0) and not (ring and k == 0)]
    if fixed:
        made.hold(made.top, fixed, "guide")
    for name in made.names:
        if ring and not (name == "lower" and "rigid" in kinds):
            made.hold(made.boundary(name, "left"), [0])
    columns = _foot(made) if two else []
    drag = rng.uniform(-0.9, 0.9) * (friction * (0.5 if friction > 0.5 else 0.95) or 0.3) if drags else 0.0
    tilt = rng.normal(size=d)
    if "heated" in kinds:
        hot = rng.uniform(-2.0, 2.0) * strain / EXPANSION
        made.loads.append(sg.Load(made.names[0], temperature=lambda x: hot * (1.0 + x @ tilt / 4.0), name="heat"))
    floor = (rng.uniform(-1.0, 1.0, d) if not ring else np.array([0.0, rng.uniform(-1.0, 1.0)])) * strain
    steps = _steps(rng, kinds, drag, strain)
    against: Any = "lower.top" if two else sg.Plane((0.0,) * d, (0.0,) * (d - 1) + (1.0,))
    if "round" in kinds:
        radius = rng.uniform(20.0, 100.0)
        against = (sg.Sphere if d == 3 else sg.Circle)((*(0.0,) * (d - 1), -radius), radius)
    obstacles = [sg.Rigid("floor", against, u=tuple(floor.tolist()))] if "moving" in kinds else []
    model = sg.Model(
        mesh,
        kind="3d" if d == 3 else geometry,
        thickness=thickness,
        bodies=[
            sg.Body(name, material, "incompatible" if "incompatible" in kinds else None)
            for name, material in zip(made.names, (upper, lower), strict=False)
        ],
        supports=made.supports,
        loads=made.loads,
        contacts=[
            sg.Contact(
                made.boundary(made.names[0], "bottom"),
                "floor" if obstacles else against,
                friction="tied" if "tied" in kinds else friction,
                name="c",
            )
        ],
        obstacles=obstacles,
        rigid_bodies=[sg.RigidBody("rock", "lower", (0.0,) * d)] if "rigid" in kinds else [],
        steps=steps,
    )
    structure = in_words(model, made.held, made.groups, friction, columns)
    case = Case(
        seed=seed,
        kinds=kinds,
        model=model,
        structure=structure,
        unit={
            name: replace(Acts.none(structure), **{what: np.pad(unit, (0, len(structure.T) - unit.size))})
            for name, (what, unit) in made.acting.items()
        },
        overlaps=[0.0, *(step.interference.get("c", 0.0) for step in steps)],
    )
    if "heated" in kinds:
        places, ours = structure.points.places, structure.points.body == 0
        heat = np.where(ours, EXPANSION * hot * (1.0 + places @ tilt / 4.0), 0.0)
        case.unit["heat"] = replace(Acts.none(structure), heat=heat)
    if "moving" in kinds:
        apart = _interface_motions(model)[:, :, mesh.points.size :][:, :, :d] @ floor
        case.unit["floor"] = replace(Acts.none(structure), apart=apart)
    return case


def _foot(made: _Maker) -> list[np.ndarray]:
    """What holds the lower body; motions that are left to it as a rigid one, (dofs,)."""
    d, ring = made.d, "axisymmetric" in made.kinds
    if "rigid" not in made.kinds:
        made.hold("lower.bottom", range(d))
        return []
    (cells,) = made.mesh.cells.values()
    nodes = np.unique(cells[made.mesh.bodies["lower"]])
    made.held |= {int(d * node + k) for node in nodes for k in range(d)}
    rocks = d == 2 and not ring and "driven" not in made.kinds  # where sides part nothing would hold it
    turns: list[float | None] = [None if rocks else 0.0] * (1 if d == 2 else 3)
    made.supports.append(sg.Support("rock", u=(*(0.0,) * d, *turns)))
    if not rocks:
        return []
    turn = np.zeros(made.mesh.points.size)
    turn[d * nodes], turn[d * nodes + 1] = -made.mesh.points[nodes, 1], made.mesh.points[nodes, 0]
    return [turn]


def _steps(rng: np.random.Generator, kinds: frozenset[str], drag: float, strain: float) -> list[sg.Step]:
    """Press, drag, let go, reverse, let go; without drag press, let go and again."""
    ends = [(1.0, 0.0), (1.0, drag), (0.3, 0.0), (1.0, -drag), (0.05, -0.05 * drag)]
    if not drag:
        ends = [(1.0, 0.0), (0.2, 0.0), (1.0, 0.0), (0.05, 0.0)]
    count = int(rng.choice([1, 1, 2, 5]))
    factors = [{"press": press, **({"drag": sideways} if drag else {})} for press, sideways in ends]
    for name, kind in (("heat", "heated"), ("floor", "moving")):
        if kind in kinds:
            for given in factors:
                given[name] = float(rng.uniform(-1.0, 1.0))
    overlaps = rng.uniform(0.0, 1.0, len(ends)) * strain
    return [
        sg.Step(
            scale=given,
            increments="auto" if "auto" in kinds else count,
            interference={"c": float(overlap)} if "overlap" in kinds else {},
            at="events",
        )
        for given, overlap in zip(factors, overlaps, strict=True)
    ]


def _interface_motions(model: sg.Model) -> np.ndarray:
    """(d, n, dofs) What pairs measure of all displacements, those of obstacles too."""
    interface = prepare(model).interface
    B: np.ndarray = interface.B.toarray()
    return B.reshape(interface.directions, len(interface), B.shape[1])


def _formulation(model: sg.Model, b: int) -> str:
    """What a body says, or in the words of the package's defaults."""
    body = model.bodies[b]
    if body.formulation is not None:
        return str(body.formulation)
    locks = body.material.yields and model.kind != "plane stress" and "wedge15" not in model.mesh.cells
    return "mean dilatation" if locks else "standard"


def in_words(
    model: sg.Model,
    held: set[int],
    groups: Sequence[np.ndarray] = (),
    friction: float = 0.0,
    motions: Sequence[np.ndarray] = (),
) -> own.Structure:
    """The model in the words of the adversary; of the package only what pairs measure.

    Parameters
    ----------
    model : of cells of one family
    held : displacements that are prescribed
    groups : displacements that are the same
    friction : of all pairs
    motions : (dofs,) displacements of rigid bodies
    """
    mesh, interface = model.mesh, prepare(model).interface
    (family, cells), dofs = next(iter(mesh.cells.items())), mesh.points.size
    owner = np.zeros(len(cells), int)
    for b, body in enumerate(model.bodies):
        owner[mesh.bodies[body.name]] = b
    laws = []
    for body in model.bodies:
        law = body.material.plastic
        tables = [np.array([[0.0, np.inf]])] if law is None else [np.array(curve) for curve in law.curves]
        backs = np.zeros((0, 2)) if law is None or not law.backstresses else np.array(law.backstresses)
        beyond = 0.0 if law is None else law.hardening
        laws.append(
            own.Law(
                E=body.material.E,
                nu=body.material.nu,
                expansion=body.material.expansion,
                tables=tables,
                temperatures=np.zeros(1) if law is None else law.temperatures,
                beyond=beyond,
                backs=backs,
            )
        )
    thin = model.kind == "plane stress"
    both = [
        own.points(
            mesh.points,
            family,
            np.asarray(cells)[owner == b],
            owner[owner == b],
            kind=model.kind,
            thickness=model.thickness,
            formulation=str(_formulation(model, b)),
        )
        for b in range(len(model.bodies))
    ]
    joined = {part: np.concatenate([getattr(one, part) for one in both]) for part in ("weights", "places", "body")}
    own_columns = [one.B[..., dofs:].reshape(9 * len(one.B), one.B.shape[-1] - dofs) for one in both]
    B = np.concatenate([one.B[..., :dofs] for one in both])
    modes = block_diag(*own_columns).reshape(*B.shape[:3], sum(one.shape[1] for one in own_columns))
    columns = [np.eye(dofs)[:, [k]] for k in range(dofs) if k not in held and not any(k in g for g in groups)]
    for group in groups:
        column = np.zeros((dofs, 1))
        column[group] = 1.0
        columns.append(column)
    columns += [motion[:, None] for motion in motions]
    return own.Structure(
        points=own.Points(B=np.concatenate([B, modes], axis=-1), **joined),
        laws=laws,
        thin=thin,
        T=block_diag(np.hstack(columns), np.eye(modes.shape[-1])),
        inner=slice(dofs, dofs + modes.shape[-1]),
        pairs=np.pad(_interface_motions(model)[:, :, :dofs], ((0, 0), (0, 0), (0, modes.shape[-1]))),
        gap=np.array(interface.gap),
        friction=np.full(len(interface), friction),
        tied=np.array(interface.tied),
    )

# SPDX-License-Identifier: BSD-3-Clause
"""The whole problem: mesh, bodies, supports, loads, contacts and steps that fit together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from typing import Any, Literal

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.checks import choice, members, number
from signorini.errors import InputError, one_of
from signorini.model.body import Body, refuse_other_owners
from signorini.model.bolt import Bolt
from signorini.model.conditions import BODY_LOADS, Foundation, Load, Place, Support
from signorini.model.contact import Contact
from signorini.model.fatigue import Fatigue
from signorini.model.kind import KINDS, TWIST, WITHOUT_THICKNESS, Kind, axes, revolves
from signorini.model.labels import Labelled, refuse_same_names, refuse_wrong_changes
from signorini.model.links import CyclicSymmetry, Equation, RigidBody, directions
from signorini.model.material import Orthotropic
from signorini.model.mesh import Mesh
from signorini.model.obstacle import Obstacle
from signorini.model.revolution import check_loads, check_rigid_motions, check_twist
from signorini.model.rigid import Rigid
from signorini.model.step import Step
from signorini.short import Drawable


@dataclass(frozen=True, eq=False, repr=False)
class Model(Drawable):
    """A contact problem, checked for everything that can be checked without numerics.

    Parameters
    ----------
    mesh : the mesh; its names are what the rest speaks of
    kind : "plane strain", "plane stress" or "axisymmetric": coordinates are then the radius and the height, forces and
        areas are for the whole circumference; "axisymmetric twist": bodies turn about the axis, too, and displacements
        and forces have a third component along the hoop; a mesh in space is "3d". Empty: "plane strain" or "3d"
    thickness : of plane models, length; forces and areas are for this thickness; bodies may have one of their own
    bodies : every cell of the mesh belongs to exactly one
    supports, foundations, loads, contacts : see :class:`Support`, :class:`Foundation`, :class:`Load`,
        :class:`Contact`
    obstacles : rigid ones that move, see :class:`Rigid`; fixed ones are said in the contact itself
    equations, rigid_bodies, cyclic_symmetries : what couples displacements without an element, see :class:`Equation`,
        :class:`RigidBody`, :class:`CyclicSymmetry`
    bolts : sections that are drawn together, see :class:`Bolt`
    fatigue : criteria that are asked along the history, see :class:`signorini.model.fatigue.Fatigue`
    steps : the load history; by default one step, all loads from 0 to 1, in one increment
    title, units : said again in the results

    Raises
    ------
    InputError
        With the path of the value, as ``support[0].on``, what was found and what is expected.

    Examples
    --------
    >>> from signorini.model.material import Elastic
    >>> mesh = Mesh(points=[[0, 0], [1, 0], [1, 1], [0, 1]], cells={"quad": [[0, 1, 2, 3]]}, bodies={"block": [0]},
    ...             boundaries={"bottom": [[0, 1]], "top": [[2, 3]]})
    >>> block = Body("block", Elastic(E=1.0, nu=0.3))
    >>> Model(mesh, bodies=[block], supports=[Support("botom", u=(0, 0))])
    Traceback (most recent call last):
    signorini.errors.InputError: support[0].on: unknown boundary or node set 'botom'; did you mean 'bottom'? Known: ...
    """

    mesh: Mesh
    _: KW_ONLY
    kind: Kind | Literal[""] = ""
    thickness: float = 1.0
    bodies: Sequence[Body] = ()
    supports: Sequence[Support] = ()
    foundations: Sequence[Foundation] = ()
    loads: Sequence[Load] = ()
    contacts: Sequence[Contact] = ()
    obstacles: Sequence[Rigid] = ()
    equations: Sequence[Equation] = ()
    rigid_bodies: Sequence[RigidBody] = ()
    cyclic_symmetries: Sequence[CyclicSymmetry] = ()
    bolts: Sequence[Bolt] = ()
    fatigue: Sequence[Fatigue] = ()
    steps: Sequence[Step] = (Step(name="load"),)
    title: str = ""
    units: str = "as given, consistent"

    def __post_init__(self) -> None:
        if not isinstance(self.mesh, Mesh):
            raise InputError(f"is {type(self.mesh).__name__}; expected a Mesh", where=("mesh",))
        if not self.kind:
            object.__setattr__(self, "kind", "plane strain" if self.dimension == 2 else "3d")
        choice(self.kind, KINDS, ("kind",), "kind")
        if (self.kind == "3d") != (self.dimension == 3):
            raise InputError(f"is '{self.kind}', but the mesh has {self.dimension} coordinates", where=("kind",))
        object.__setattr__(self, "thickness", number(self.thickness, ("thickness",), above=0.0))
        if self.thickness != 1.0:
            self._refuse_thickness(self.thickness, ("thickness",))
        kinds = {"bodies": Body, "supports": Support, "foundations": Foundation, "loads": Load, "contacts": Contact}
        kinds |= {"obstacles": Rigid, "equations": Equation, "rigid_bodies": RigidBody, "bolts": Bolt, "steps": Step}
        kinds |= {"cyclic_symmetries": CyclicSymmetry, "fatigue": Fatigue}
        for part, kind in kinds.items():
            object.__setattr__(self, part, members(getattr(self, part), kind, part))
        bodies = (body.in_kind(self.kind, self.mesh.families(body.name)) for body in self.bodies)
        object.__setattr__(self, "bodies", tuple(bodies))
        self._check_bodies()
        self._check_links()
        for i, support in enumerate(self.supports):
            self._check_place(support.on, ("support", i, "on"), nodes=True, rigid=True)
            self._check_dimension(support.u, ("support", i, "u"), on=support.on)
        for i, foundation in enumerate(self.foundations):
            self._check_place(foundation.on, ("foundation", i, "on"), nodes=False)
        for i, load in enumerate(self.loads):
            self._check_load(i, load)
        for i, contact in enumerate(self.contacts):
            self._check_contact(i, contact)
        for i, obstacle in enumerate(self.obstacles):
            self._check_obstacle(i, obstacle)
        if self.axisymmetric:
            self._check_revolution()
        held: tuple[Support | Foundation, ...] = (*self.supports, *self.foundations)
        named: dict[str, Sequence[Labelled]] = {"support": held, "load": self.loads, "contact": self.contacts}
        refuse_same_names(named | {"obstacle": self.obstacles, "bolt": self.bolts})
        self._check_steps()
        if self.fatigue:
            self._check_fatigue()

    @property
    def dimension(self) -> int:
        """Of space: 2 or 3."""
        return self.mesh.dimension

    @property
    def axisymmetric(self) -> bool:
        """Whether the coordinates are radius and height."""
        return revolves(self.kind)

    @property
    def twists(self) -> bool:
        """Whether points move along the hoop, too."""
        return self.kind == TWIST

    @property
    def axes(self) -> str:
        """Letters of the components of displacements, see :func:`signorini.model.kind.axes`."""
        return axes(self.kind)

    @property
    def components(self) -> int:
        """Of a displacement: 2 or 3."""
        return len(self.axes)

    @property
    def number_of_dofs(self) -> int:
        """Displacements of all nodes of the mesh."""
        return self.mesh.number_of_nodes * self.components

    def body_of_cells(self) -> IntArray:
        """For every cell the index of its body, (m,)."""
        owner = np.full(self.mesh.number_of_cells, -1)
        for i, body in enumerate(self.bodies):
            owner[self.mesh.bodies[body.name]] = i
        return owner

    @property
    def yields(self) -> bool:
        """Whether any body is plastic beyond some stress."""
        return any(body.material.yields for body in self.bodies)

    @property
    def wears(self) -> bool:
        """Whether sliding wears any contact."""
        return any(contact.wear is not None for contact in self.contacts)

    @property
    def couples(self) -> bool:
        """Whether equations, rigid bodies or cyclic symmetries couple displacements."""
        return bool(self.equations or self.rigid_bodies or self.cyclic_symmetries)

    @property
    def heats(self) -> bool:
        """Whether any load is a temperature."""
        return any(load.temperature is not None for load in self.loads)

    @property
    def slides(self) -> bool:
        """Whether the sides of any contact slide far."""
        return any(contact.slides for contact in self.contacts)

    @property
    def thicknesses(self) -> list[float]:
        """Of every body, length; 1 in models that have none."""
        return [self.thickness if body.thickness is None else body.thickness for body in self.bodies]

    @property
    def cell_thickness(self) -> Array:
        """(m,) Thickness of every cell, length."""
        return np.array(self.thicknesses)[self.body_of_cells()]

    def _refuse_thickness(self, found: float, where: tuple[str | int, ...]) -> None:
        if self.kind in WITHOUT_THICKNESS:
            raise InputError(f"is {found:g}; {WITHOUT_THICKNESS[self.kind]}", where=where)

    def _check_bodies(self) -> None:
        known = self.mesh.bodies
        if not self.bodies:
            raise InputError(f"there is none; the mesh has {', '.join(known) or 'no named body'}", where=("body",))
        count = np.zeros(self.mesh.number_of_cells, int)
        rigid = {rigid_body.on for rigid_body in self.rigid_bodies}
        for i, body in enumerate(self.bodies):
            if body.name not in known:
                raise InputError(one_of(body.name, known, "body"), where=("body", i, "name"))
            count[known[body.name]] += 1
            if body.thickness is not None:
                self._refuse_thickness(body.thickness, ("body", i, "thickness"))
            if self.dimension == 3 and isinstance(body.material, Orthotropic) and not body.material.solid:
                raise InputError("has no G13 and G23; a model in space needs them", where=("body", i, "material"))
            if body.material.yields and body.name not in rigid:
                body.check_flow(("body", i), self.kind, self.mesh.families(body.name))
        refuse_other_owners(self.mesh, count)

    def _check_load(self, i: int, load: Load) -> None:
        where = ("load", i, "on")
        if load.kind in BODY_LOADS:
            self._check_body_load(i, load)
        elif load.kind in ("force", "nodal_forces", "torque") and load.spread == "traction":
            self._check_place(load.on, where, nodes=True, rigid=load.kind == "force")
        else:
            self._check_place(load.on, where, nodes=False)
        if load.nodal_forces is not None:
            expected = (1 if not isinstance(load.on, str) else len(self.mesh.nodes_of(load.on)), self.components)
            if load.nodal_forces.shape != expected:
                raise InputError(
                    f"has shape {load.nodal_forces.shape}; expected {expected}, one force for each of the nodes",
                    where=("load", i, "nodal_forces"),
                )
        self._check_dimension(load.force, ("load", i, "force"), on=load.on)
        for kind in ("traction", "body_force", "gravity"):
            if not callable(getattr(load, kind)):
                self._check_dimension(getattr(load, kind), ("load", i, kind))
        if load.torque is not None and not self.axisymmetric:
            raise InputError("is for axisymmetric models with twist; expected a force", where=("load", i, "torque"))
        for kind in ("bearing", "centre"):
            self._check_point(getattr(load, kind), ("load", i, kind))
        if load.axis is not None and len(load.axis) != self.dimension:
            raise InputError(f"has {len(load.axis)} components; expected 3, in space", where=("load", i, "axis"))
        if load.axis is not None and self.dimension == 2:
            raise InputError("is for models in space; expected none", where=("load", i, "axis"))

    def _check_body_load(self, i: int, load: Load) -> None:
        """What the loads inside a body need from its material, and from the kind of model."""
        names = [body.name for body in self.bodies]
        if load.on not in names:
            raise InputError(one_of(str(load.on), names, "body"), where=("load", i, "on"))
        body = self.bodies[names.index(str(load.on))]
        if load.kind in ("gravity", "centrifugal") and body.material.density == 0.0:
            raise InputError(
                f"'{body.name}' has no density; expected one in its material", where=("load", i, load.kind)
            )
        if load.kind == "temperature" and not body.material.feels_heat:
            raise InputError(f"'{body.name}' has no thermal expansion; expected it in its material", where=("load", i))
        count = self.mesh.number_of_nodes
        if isinstance(load.temperature, np.ndarray) and len(load.temperature) != count:
            raise InputError(
                f"has {len(load.temperature)} values; expected one per node of the mesh, {count}",
                where=("load", i, "temperature"),
            )

    def _check_contact(self, i: int, contact: Contact) -> None:
        try:
            contact.check_bodies([body.name for body in self.bodies if body.material.yields])
            contact.check_meshed(linked=bool(self.bolts or self.cyclic_symmetries))
            if self.components == 2:
                contact.check_plane()
        except InputError as error:
            raise error.inside("contact", i) from error
        self._check_place(contact.nonmortar, ("contact", i, "nonmortar"), nodes=False)
        if isinstance(contact.mortar, Obstacle):
            if contact.mortar.dimension != self.dimension:
                raise InputError(
                    f"has {contact.mortar.dimension} components; expected {self.dimension}",
                    where=("contact", i, type(contact.mortar).__name__.lower()),
                )
            return
        if any(contact.mortar == obstacle.name for obstacle in self.obstacles):
            contact.check_alone()
            return
        if self.obstacles and contact.mortar not in self.mesh.boundaries:
            known = {*self.mesh.boundaries, *(obstacle.name for obstacle in self.obstacles)}
            raise InputError(one_of(contact.mortar, known, "boundary or obstacle"), where=("contact", i, "mortar"))
        self._check_place(contact.mortar, ("contact", i, "mortar"), nodes=False)
        if contact.mortar == contact.nonmortar:
            raise InputError(f"'{contact.mortar}' touches itself; expected another boundary", where=("contact", i))

    def _check_obstacle(self, i: int, obstacle: Rigid) -> None:
        if obstacle.shape.dimension != self.dimension:
            raise InputError(
                f"is in {obstacle.shape.dimension} dimensions; expected {self.dimension}", where=("obstacle", i)
            )
        if obstacle.name in self.mesh.boundaries:
            raise InputError(f"'{obstacle.name}' is a boundary of the mesh too", where=("obstacle", i, "name"))
        if not any(contact.mortar == obstacle.name for contact in self.contacts):
            raise InputError(f"'{obstacle.name}' is the mortar side of no contact", where=("obstacle", i, "name"))

    def _check_revolution(self) -> None:
        rigid = {body.name for body in self.rigid_bodies}
        check_rigid_motions(self.supports, self.obstacles, rigid, twists=self.twists)
        check_loads(self.loads, self.cyclic_symmetries, twists=self.twists)
        if self.twists:
            check_twist(self.bodies, self.contacts)

    def _check_links(self) -> None:
        """Equations and rigid bodies."""
        taken = {*self.mesh.boundaries, *self.mesh.nodes, *(obstacle.name for obstacle in self.obstacles)}
        for i, body in enumerate(self.rigid_bodies):
            where = ("rigid_body", i)
            if body.name in taken:
                raise InputError(
                    f"'{body.name}' is a boundary, a node set or another rigid one too; expected a name of its own",
                    where=(*where, "name"),
                )
            taken.add(body.name)
            if body.on not in self.mesh.bodies:
                self._check_place(body.on, (*where, "on"), nodes=True)
            self._check_point(body.point, (*where, "point"))
        for i, symmetry in enumerate(self.cyclic_symmetries):
            for key in ("first", "second"):
                self._check_place(getattr(symmetry, key), ("cyclic_symmetry", i, key), nodes=True)
            if symmetry.point:
                self._check_point(symmetry.point, ("cyclic_symmetry", i, "point"))
        for i, equation in enumerate(self.equations):
            for k, (on, _, _) in enumerate(equation.terms):
                if not isinstance(on, int):
                    self._check_place(on, ("equation", i, "terms", k), nodes=True, rigid=True)

    def _check_place(self, on: Any, where: tuple[str | int, ...], *, nodes: bool, rigid: bool = False) -> None:
        if not isinstance(on, str):
            if not nodes:
                raise InputError(f"is the point {on}; expected a boundary", where=where)
            self._check_point(on, where)
            return
        bodies = {body.name for body in self.rigid_bodies} if rigid else set()
        known = set(self.mesh.boundaries) | (set(self.mesh.nodes) if nodes else set()) | bodies
        if on not in known:
            raise InputError(one_of(on, known, "boundary or node set" if nodes else "boundary"), where=where)
        if on not in bodies and not len(self.mesh.nodes_of(on)):
            raise InputError(f"'{on}' is empty in the mesh", where=where)

    def _check_dimension(self, parts: Sequence[object] | None, where: tuple[str | int, ...], on: Place = "") -> None:
        """Of a displacement or force; a rigid body has rotations too."""
        rigid = any(on == body.name for body in self.rigid_bodies)
        expected = directions(self.dimension) if rigid else self.axes
        if parts is not None and len(parts) != len(expected):
            words = f", one for each of {', '.join(expected)}" if rigid else ""
            raise InputError(f"has {len(parts)} components; expected {len(expected)}{words}", where=where)

    def _check_point(self, parts: Sequence[object] | None, where: tuple[str | int, ...]) -> None:
        if parts is not None and len(parts) != self.dimension:
            raise InputError(f"has {len(parts)} components; expected {self.dimension}", where=where)

    def _check_steps(self) -> None:
        if not self.steps:
            raise InputError("there is none; expected at least one", where=("step",))
        names = self.scaled_names
        for i, step in enumerate(self.steps):
            for name in step.scale or ():
                if name not in names:
                    raise InputError(one_of(name, names, "load or moving support"), where=("step", i, "scale"))
            refuse_wrong_changes(i, step, self.contacts, [*self.supports, *self.bolts])
            if step.block is not None and not self.wears:
                raise InputError("is given, but no contact wears", where=("step", i, "block"))
            if step.path == "exact":
                for contact in self.contacts:
                    contact.check_exact(("step", i, "path"), in_space=self.components == 3)

    def _check_fatigue(self) -> None:
        places = [*self.mesh.boundaries, *self.mesh.nodes, *(body.name for body in self.bodies)]
        contacts, steps = [contact.label for contact in self.contacts], [step.name for step in self.steps]
        for i, request in enumerate(self.fatigue):
            request.check(("fatigue", i), contacts, places, steps)

    @property
    def scaled_names(self) -> tuple[str, ...]:
        """What steps can scale: loads, moving supports, and obstacles that are moved or loaded."""
        moving = (s.label for s in self.supports if s.moves)
        driven = (o.label for o in self.obstacles if o.acts)
        own = (*(load.label for load in self.loads), *(bolt.label for bolt in self.bolts))
        return tuple(dict.fromkeys([*own, *moving, *driven]))

    def factors(self) -> list[dict[str, float]]:
        """Load factors by name: before the first step (all 0) and at the end of every step."""
        history = [dict.fromkeys(self.scaled_names, 0.0)]
        for step in self.steps:
            history.append(step.ends(history[-1])[-1])
        return history

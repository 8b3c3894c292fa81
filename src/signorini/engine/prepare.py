# SPDX-License-Identifier: BSD-3-Clause
"""What does not depend on the loads: assembled, checked for free motions and condensed once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray
from signorini.checks import number
from signorini.clock import Clock
from signorini.condense.condensed import Condensed, condense
from signorini.condense.ties import Ties
from signorini.engine.duplicate_check import refuse_idle, refuse_same_contacts
from signorini.engine.free_motion_check import refuse_free_motions, refuse_unheld
from signorini.engine.memory_check import iterates, refuse_unassembled
from signorini.errors import InputError, one_of
from signorini.fem.links import linked_nodes
from signorini.fem.loads import nodal_loads
from signorini.fem.locking import refuse_locking
from signorini.fem.rigid import Part, free_motions, make_parts, rigid_motions
from signorini.fem.space import Space, make_space
from signorini.fem.stiffness import reduced_stiffness, stiffness
from signorini.fem.supports import Constraints, make_constraints
from signorini.friction.problem import CoulombProblem
from signorini.friction.spatial import SpatialProblem
from signorini.interface.interface import Interface, anisotropy_of, friction_of, make_interface
from signorini.interface.reach import candidates
from signorini.iterative.bodies import ITERATIVE, Bodies, make_bodies
from signorini.linalg.protocol import NotPositiveDefinite
from signorini.linalg.threads import one_thread
from signorini.model.conditions import Load, Temperature
from signorini.model.model import Model
from signorini.model.stage import Stage, Standing, stages
from signorini.solution.checkpoint import Checkpoint
from signorini.solution.scale import Loading, Scale, data_scale, loading_of

_ROUNDING = (
    1e-4  # of the largest gap or displacement: times the tolerance of the law's solver, 1e-10, a few roundings of it
)
_UNCONDENSED = (
    "an exact path needs the condensed interface, and this model is solved by iteration, because its factor does not "
    "fit or because it was asked for; expected path = 'increments'"
)


@dataclass(frozen=True, kw_only=True, eq=False)
class Examined:
    """A model on its mesh, checked; nothing is assembled yet.

    Attributes
    ----------
    loads : name to nodal forces at factor 1, each (dofs,)
    parts, motions : connected pieces and their rigid motions, (dofs, motions of all parts)
    floating : (motions, k) rigid motions that supports leave free and contact must hold
    scale : sizes from the data
    """

    model: Model
    space: Space
    constraints: Constraints
    interface: Interface
    loads: Mapping[str, Array]
    parts: tuple[Part, ...]
    motions: sp.csr_array
    floating: Array
    scale: Scale


@dataclass(frozen=True, kw_only=True, eq=False)
class Prepared(Examined):
    """A model ready for any load.

    Attributes
    ----------
    K : (dofs, dofs) stiffness of bodies and elastic foundations, supports not applied
    released : supports that do not hold
    multiplied : what values of moving supports are multiplied by, beyond the model's
    bodies : the interface as the bodies feel it, condensed; or, where that does not fit, the bodies as they are
    law_or_none : the contact law on the condensed interface, see `law`
    clock : seconds spent so far
    backend : of the factorisation, or "iterative", as asked for
    absent : (n,) pairs whose contact is switched off
    resting : (dofs,) rigid displacement of bodies that rest, see `engine.floating_bodies`; empty where none does
    softness : the farthest that any load moves the bodies, of its size, where springs hold the pairs: length per force
    """

    K: sp.csr_array
    bodies: Condensed | Bodies
    law_or_none: CoulombProblem | SpatialProblem | None
    clock: Clock
    backend: str
    absent: BoolArray
    softness: float = 0.0
    released: frozenset[str] = frozenset()
    multiplied: Mapping[str, float] = field(default_factory=dict)
    resting: Array = field(default_factory=lambda: np.zeros(0))

    @property
    def ties(self) -> Ties | None:
        """Tied pairs on the condensed interface; None where there is none."""
        return None if isinstance(self.bodies, Bodies) else self.bodies.ties

    @property
    def condensed(self) -> Condensed:
        """The condensed interface.

        Raises
        ------
        InputError
            Where contact is solved on the bodies as they are.
        """
        if isinstance(self.bodies, Bodies):
            raise InputError(_UNCONDENSED, where=("step",))
        return self.bodies

    @property
    def law(self) -> CoulombProblem | SpatialProblem:
        """The contact law, without load; ``dataclasses.replace(law, b=...)`` shares what it has computed.

        Raises
        ------
        InputError
            Where there is no condensed interface.
        """
        if self.law_or_none is None:
            raise InputError(_UNCONDENSED, where=("step",))
        return self.law_or_none

    @property
    def limited(self) -> bool:
        """Whether pairs that seemed too far apart were left out."""
        return not (self.bodies.active | self.bodies.settled).all()

    def widened(self) -> Prepared:
        """The same with every pair in the law, factorised anew."""
        everything = np.ones(len(self.interface), bool)
        return self._again(self, everything)

    def upheld(self, released: frozenset[str]) -> Prepared:
        """The same under other supports, factorised anew."""
        if released == self.released:
            return self
        constraints = make_constraints(self.space, self.model, without=released)
        prescribed = {name: self.multiplied.get(name, 1.0) * u for name, u in constraints.prescribed.items()}
        examined = _under(self, replace(constraints, prescribed=prescribed))
        near = _near(examined) if self.limited else np.ones(len(self.interface), bool)
        return replace(self._again(examined, near), released=released)

    def _again(self, examined: Examined, near: BoolArray) -> Prepared:
        made = _made(examined, self.K, near, self.backend, self.clock)
        return replace(made, released=self.released, multiplied=self.multiplied)

    def law_under(self, interface: Interface, scale: Scale) -> CoulombProblem | SpatialProblem | None:
        """The law of the same pairs with other friction, gaps or sizes of the data."""
        if isinstance(self.bodies, Bodies):
            return None
        size = _size(interface, self.bodies, scale)
        return replace(self.law, scale=size, **_cones(interface, self.bodies))

    def changed(
        self,
        *,
        friction: Mapping[str, float] | None = None,
        interference: Mapping[str, float] | None = None,
        loads: Mapping[str, float] | None = None,
    ) -> Prepared:
        """The same bodies under another law or load; nothing is factorised again.

        Parameters
        ----------
        friction : contact to Coulomb's coefficient
        interference : contact to its overlap beyond the geometry, length
        loads : load or moving support to what its value is multiplied by

        Raises
        ------
        InputError
            For an unknown name, a wrong value, or a body that is left with nothing but frictionless contact.
        """
        contacts = list(self.model.contacts)
        _refuse_unknown(friction, [c.label for c in contacts], "contact", "friction")
        _refuse_unknown(interference, [c.label for c in contacts], "contact", "interference")
        _refuse_unknown(loads, self.model.scaled_names, "load or moving support", "loads")
        gap = self.interface.gap.copy()
        for i, contact in enumerate(contacts):
            for key, given in (("friction", friction), ("interference", interference)):
                if contact.tied and given is not None and contact.label in given:
                    raise InputError("is tied for good; only contacts can change", where=(key, contact.label))
            if friction is not None and contact.label in friction:
                contacts[i] = replace(contacts[i], friction=friction[contact.label])
            if interference is not None and contact.label in interference:
                contacts[i] = replace(contacts[i], interference=interference[contact.label])
                gap[self.interface.contact == i] += contact.interference - contacts[i].interference
        factor = {name: number(value, ("loads", name)) for name, value in (loads or {}).items()}
        hot = [replace(load, temperature=_times(load, factor)) for load in self.model.loads]
        model = replace(self.model, contacts=contacts, loads=hot)
        mu = friction_of(self.space, model, self.interface.node, self.interface.contact)
        ratio = anisotropy_of(model, self.interface.tangents, self.interface.contact)
        interface = replace(self.interface, gap=gap, friction=mu, anisotropy=ratio)
        constraints = replace(
            self.constraints,
            prescribed={name: factor.get(name, 1.0) * u for name, u in self.constraints.prescribed.items()},
        )
        forces = {name: factor.get(name, 1.0) * f for name, f in self.loads.items()}
        refuse_free_motions(self.space, constraints, interface, self.parts, self.motions)
        scale = data_scale(self.space, model, _loading(stages(model), forces, constraints), interface)
        scale = scale.bent(self.softness)
        return replace(
            self,
            model=model,
            interface=interface,
            constraints=constraints,
            loads=forces,
            scale=scale,
            law_or_none=self.law_under(interface, scale),
            clock=Clock(),
            multiplied=factor | {name: factor.get(name, 1.0) * old for name, old in self.multiplied.items()},
        )


def examine(model: Model, *, start: Checkpoint | None = None) -> Examined:
    """Put a model on its mesh and check what can be checked without solving.

    Parameters
    ----------
    start : from which its history goes on

    Raises
    ------
    InputError
        If something in the model does not fit the mesh or the start, a load never acts, two contacts are between the
        same sides, or a body can move freely: it is named, with its motion.
    """
    refuse_locking(model)
    factors = {} if start is None else start.state.point.factors
    before = Standing() if start is None else start.standing
    refuse_idle(model, factors)
    schedule = list(stages(model, factors=factors, before=before))
    refuse_same_contacts(model, schedule)
    carriers = len(model.obstacles) + len(model.rigid_bodies)
    space = make_space(model.mesh, axisymmetric=model.axisymmetric, obstacles=carriers, linked=linked_nodes(model))
    first, sometimes = schedule[0].released, schedule[-1].loosened
    constraints = make_constraints(space, model, without=first)
    always = make_constraints(space, model, without=sometimes) if sometimes != first else constraints
    loads = nodal_loads(space, model)
    interface = make_interface(space, model, always)
    if start is not None:
        start.check(model, interface)
    parts = make_parts(space, model)
    motions = rigid_motions(space, parts)
    refuse_unheld(model, space, constraints, interface, parts, motions, schedule)
    loading = _loading(schedule, loads, constraints, None if start is None else start.loading)
    return Examined(
        model=model,
        space=space,
        constraints=constraints,
        interface=interface,
        loads=loads,
        parts=parts,
        motions=motions,
        floating=_floating(motions, constraints, interface),
        scale=data_scale(space, model, loading, interface),
    )


def _loading(
    schedule: Iterable[Stage], loads: Mapping[str, Array], constraints: Constraints, before: Loading | None = None
) -> Loading:
    """The most that is imposed in any step, or was before."""
    most = before or Loading()
    for stage in schedule:
        most = loading_of(stage, loads, constraints, most)
    return most


def _floating(motions: sp.csr_array, constraints: Constraints, interface: Interface) -> Array:
    return free_motions(motions, constraints, interface.B[interface.rows(interface.tied)])


def _under(examined: Examined, constraints: Constraints) -> Examined:
    """The same under other supports."""
    floating = _floating(examined.motions, constraints, examined.interface)
    known = {field.name: getattr(examined, field.name) for field in fields(Examined)}
    return Examined(**(known | {"constraints": constraints, "floating": floating}))


@one_thread()
def prepare(
    model: Model, *, start: Checkpoint | None = None, backend: str = "auto", clock: Clock | None = None
) -> Prepared:
    """Examine, assemble and condense; pairs that seem too far apart to touch are left out.

    Parameters
    ----------
    start : from which the history goes on; its pairs are taken along

    Raises
    ------
    InputError
        See :func:`examine`; or a compliance is so large that contact hardly holds a body.
    """
    clock = clock or Clock()
    with clock.phase("assembly"):
        examined = examine(model, start=start)
        refuse_unassembled(model)
        K = stiffness(examined.space, model)
        for springs in examined.constraints.springs.values():
            K = sp.csr_array(K + springs.T @ springs)
        near = _near(examined) if start is None else _near(examined) | start.near
    made = _made(examined, K, near, backend, clock)
    before = None if start is None else start.standing
    return replace(made, released=next(stages(model, before=before)).released)


def _near(examined: Examined) -> BoolArray:
    """Pairs that can touch, or all of them where those alone would not hold a body."""
    scale = examined.scale
    if examined.space.dimension == 3:
        near = candidates(examined.interface, scale.imposed, scale.squeezed)
    else:
        near = candidates(examined.interface, scale.length)
    holding = examined.interface.B[examined.interface.rows(near)]
    if free_motions(examined.motions, examined.constraints, holding).shape[1]:
        return np.ones_like(near)
    return near


def _made(examined: Examined, K: sp.csr_array, near: BoolArray, backend: str, clock: Clock) -> Prepared:
    """Factorise the bodies with the nodes of the candidates last and put the law on them, or leave them as they are."""
    interface, T, nodes = examined.interface, examined.constraints.transform, examined.constraints.nodes
    with clock.phase("assembly"):
        reduced, relative = reduced_stiffness(K, T), sp.csr_array(interface.B @ T)
        whole = iterates(reduced, relative, interface, nodes, examined.space.places, candidates=near, backend=backend)
        law: CoulombProblem | SpatialProblem | None = None
        bodies: Condensed | Bodies
        softness = 0.0
        if whole:
            bodies = as_they_are(examined, reduced, relative, near)
    if not whole:
        bodies = _condensed(examined, reduced, relative, near, backend, clock)
        softness = _softness(examined, bodies)
        examined = replace(examined, scale=examined.scale.bent(softness))
        law = contact_law(interface, bodies, examined.scale)
        examined = replace(examined, constraints=_with_ties(examined, bodies.ties))
    return Prepared(
        **{field.name: getattr(examined, field.name) for field in fields(Examined)},
        K=K,
        bodies=bodies,
        law_or_none=law,
        clock=clock,
        backend=backend,
        absent=np.zeros(len(interface), bool),
        softness=softness,
    )


def _softness(examined: Examined, condensed: Condensed) -> float:
    """The farthest that any load moves the bodies, of the sum of its forces: what bends moves far beyond F / (E t)."""
    T, found = examined.constraints.transform, [0.0]
    for forces in examined.loads.values():
        if size := float(np.abs(forces).sum()):
            moved = T @ condensed.on_springs(T.T @ forces)
            found.append(float(np.abs(moved).max(initial=0.0)) / size)
    return max(found)


def as_they_are(examined: Examined, K: sp.csr_array, B: sp.csr_array, near: BoolArray) -> Bodies:
    """The bodies as they are."""
    T, d, interface = examined.constraints.transform, examined.space.dimension, examined.interface
    if interface.facets.any() or (interface.anisotropy != 1.0).any():
        i = int(interface.contact[np.argmax((interface.facets > 0) | (interface.anisotropy != 1.0).any(axis=1))])
        raise InputError(
            "two coefficients and facets need the condensed interface, and this model is solved by iteration, because "
            "its factor does not fit or because it was asked for; expected one coefficient and no facets",
            where=("contact", i),
        )
    return make_bodies(
        K,
        B,
        interface,
        examined.constraints.nodes,
        examined.constraints.leaders % d,
        points=examined.space.mesh.points,
        rigid=sp.csr_array(T.T @ examined.motions),
        candidates=near,
    )


def _condensed(
    examined: Examined, K: sp.csr_array, B: sp.csr_array, near: BoolArray, backend: str, clock: Clock
) -> Condensed:
    """Factorise the bodies with the nodes of the candidates last."""
    rigid = (examined.motions @ examined.floating)[examined.constraints.leaders]
    try:
        return condense(
            K,
            B,
            examined.interface,
            examined.constraints.nodes,
            examined.space.places,
            candidates=near,
            rigid=rigid,
            stiffness=examined.scale.force / examined.scale.compressed,
            backend="auto" if backend == ITERATIVE else backend,
            clock=clock,
        )
    except NotPositiveDefinite as error:
        raise _singular(examined, error) from error
    except np.linalg.LinAlgError as error:
        raise InputError(
            "the compliance of the contacts is so large, or the moduli are so far apart, that contact hardly holds a "
            "body; expected smaller compliances, or supports",
            where=("contact",),
        ) from error


def _with_ties(examined: Examined, ties: Ties) -> Constraints:
    """What moving supports prescribe, and with it what ties make of it at once: pairs that are tied do not part."""
    constraints, B, T = examined.constraints, examined.interface.B[ties.rows], examined.constraints.transform
    prescribed = {name: u + T @ ties.closing(B @ u) for name, u in constraints.prescribed.items()}
    return replace(constraints, prescribed=prescribed)


def contact_law(interface: Interface, condensed: Condensed, scale: Scale) -> CoulombProblem | SpatialProblem:
    """The contact law of the active pairs, with no load yet."""
    kind: type[CoulombProblem] | type[SpatialProblem] = CoulombProblem if interface.directions == 2 else SpatialProblem
    return kind(
        image=condensed.image,
        b=np.zeros(len(condensed.root)),
        scale=_size(interface, condensed, scale),
        **_cones(interface, condensed),
    )


def _cones(interface: Interface, condensed: Condensed) -> dict[str, Any]:
    """The friction of the active pairs as the laws take it, forces scaled."""
    active = condensed.active
    area = interface.area[active] / condensed.root[: int(active.sum())]
    adheres, limited = interface.adhesion[active].any(), np.isfinite(interface.shear_limit[active]).any()
    bounds = {
        "adhesion": interface.adhesion[active] * area if adheres else None,
        "limit": interface.shear_limit[active] * area if limited else None,
    }
    if interface.directions == 2:
        return {"friction": interface.friction[active], **bounds}
    return {"friction": interface.coefficients[active], "facets": interface.facets[active], **bounds}


def _size(interface: Interface, condensed: Condensed, scale: Scale) -> float:
    """Of the right-hand side of the law: what compresses, for forces to have their digits.

    Gaps far larger than that, and displacements of what bends, leave their rounding in it.
    """
    gap = float(np.abs(interface.gap[condensed.active]).max(initial=0.0))
    return max(scale.compressed, _ROUNDING * max(gap, scale.length)) * (float(condensed.root.max(initial=0.0)) or 1.0)


def _times(load: Load, factors: Mapping[str, float]) -> Temperature | None:
    """The temperature of a load times its factor; stresses refer to it, other loads are in the nodal forces."""
    given, factor = load.temperature, factors.get(load.label, 1.0)
    if given is None or factor == 1.0:
        return given
    if callable(given):
        return lambda points: factor * given(points)
    return factor * given


def _refuse_unknown(given: Mapping[str, float] | None, known: Sequence[str], what: str, key: str) -> None:
    for name in given or {}:
        if name not in known:
            raise InputError(one_of(name, known, what), where=(key,))


def _singular(examined: Examined, error: NotPositiveDefinite) -> InputError:
    node = examined.constraints.nodes[error.dof]
    label = next((part.label for part in examined.parts if node in part.nodes), "")
    if not label:
        return InputError(
            "a rigid body or obstacle has no stiffness against some motion; expected a support or contact"
        )
    at = tuple(float(x) for x in examined.model.mesh.points[node].round(6))
    number = examined.model.mesh.labels[node]
    return InputError(
        f"{label} has no stiffness against some motion of node {number} at {at}, though no rigid motion is free; "
        "expected cells that are joined by edges (a hinge at a single node?) and moduli that are not extremely apart"
    )

# SPDX-License-Identifier: BSD-3-Clause
"""What does not depend on the loads: assembled, checked for free motions and condensed once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields, replace

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray
from signorini.checks import number
from signorini.clock import Clock
from signorini.condense.condensed import Condensed, condense
from signorini.condense.ties import Ties
from signorini.engine.examine import Examined, examine, floating_motions, most_imposed
from signorini.engine.free_motion_check import refuse_free_motions
from signorini.engine.memory_check import iterates, refuse_unassembled
from signorini.engine.multipliers import MAX_ENTRIES, PATIENCE, MultiplierSolver, make_multipliers
from signorini.engine.solver import CondensedSolver, ContactSolver
from signorini.errors import InputError, one_of
from signorini.fem.rigid import free_motions
from signorini.fem.stiffness import reduced_stiffness, stiffness
from signorini.fem.supports import Constraints, make_constraints
from signorini.interface.active import FreeBodies
from signorini.interface.interface import Interface, under_laws
from signorini.interface.reach import candidates
from signorini.iterative.bodies import ITERATIVE
from signorini.linalg.protocol import NotPositiveDefinite
from signorini.linalg.threads import one_thread
from signorini.model.conditions import Load, Temperature
from signorini.model.contact import Contact
from signorini.model.model import Model
from signorini.model.stage import stages
from signorini.settings import SolverSettings
from signorini.solution.checkpoint import Checkpoint
from signorini.solution.discrete_model import DiscreteModel
from signorini.solution.scale import Loading, data_scale

_UNCONDENSED = (
    "an exact path needs the condensed interface, and this model is solved by iteration, because its factor does not "
    "fit or because it was asked for; expected path = 'increments'"
)


@dataclass(frozen=True, kw_only=True, eq=False)
class Prepared(Examined, DiscreteModel):
    """A model ready for any load.

    Attributes
    ----------
    solver : the bodies as their contact pairs feel them, and the law
    clock : seconds spent so far
    backend : of the factorisation, or "iterative", as asked for
    settings : limits of the methods
    softness : the farthest that any load moves the bodies, of its size, where springs hold the pairs: length per force
    released : supports that do not hold
    multiplied : what values of moving supports are multiplied by, beyond the model's
    resting : (dofs,) rigid displacement of bodies that rest, see `engine.floating_bodies`; empty where none does
    """

    solver: ContactSolver
    clock: Clock
    backend: str
    settings: SolverSettings = field(default_factory=SolverSettings)
    softness: float = 0.0
    released: frozenset[str] = frozenset()
    multiplied: Mapping[str, float] = field(default_factory=dict)
    resting: Array = field(default_factory=lambda: np.zeros(0))

    @property
    def paths(self) -> CondensedSolver:
        """The solver on the condensed interface.

        Raises
        ------
        InputError
            Where contact is solved on the bodies as they are.
        """
        if self.solver.paths is None:
            raise InputError(_UNCONDENSED, where=("step",))
        return self.solver.paths

    @property
    def near(self) -> BoolArray:
        """(n,) Pairs that the law of contact is asked of, or that supports or ties decide."""
        return self.solver.active | self.solver.settled

    @property
    def limited(self) -> bool:
        """Whether pairs that seemed too far apart were left out."""
        return not self.near.all()

    def widened(self) -> Prepared:
        """With every pair in the law, factorised anew."""
        return self._made_again(np.ones(len(self.interface), bool))

    def supported(self, released: frozenset[str]) -> Prepared:
        """Under all supports but some that are released, factorised anew."""
        if released == self.released:
            return self
        constraints = make_constraints(self.space, self.model, without=released)
        prescribed = {name: self.multiplied.get(name, 1.0) * u for name, u in constraints.prescribed.items()}
        floating = floating_motions(self.motions, constraints, self.interface)
        now = replace(
            self,
            constraints=replace(constraints, prescribed=prescribed),
            floating=floating,
            released=released,
        )
        return now._made_again(_near(now) if self.limited else np.ones(len(self.interface), bool))

    def _made_again(self, near: BoolArray) -> Prepared:
        made = _made(self, self.K, near, self.backend, self.settings, self.clock)
        return replace(made, released=self.released, multiplied=self.multiplied)

    def under(self, interface: Interface, loading: Loading, absent: BoolArray) -> Prepared:
        """Under another law of the pairs, and the sizes of what is imposed; nothing is factorised again.

        Parameters
        ----------
        interface : with the friction and the gaps of the moment
        loading : the most that was imposed: what certificates refer to
        absent : (n,) pairs that are switched off
        """
        scale = data_scale(self.space, self.model, loading, interface).bent(self.softness)
        solver = self.solver.under(interface, scale, absent)
        return replace(self, interface=interface, scale=scale, solver=solver, absent=absent)

    def with_multipliers(self, patience: int = PATIENCE) -> Prepared:
        """Solved on the bodies as they are, factored with the springs of their contacts.

        Parameters
        ----------
        patience : rounds without progress after which an increment is given up
        """
        return replace(self, solver=self.multipliers(patience))

    def multipliers(self, patience: int) -> MultiplierSolver:
        """The solver of `with_multipliers`; ``patience`` as there."""
        T, nodes = self.constraints.transform, self.constraints.nodes
        K, B = reduced_stiffness(self.K, T), sp.csr_array(self.interface.B @ T)
        solver = make_multipliers(self, K, B, self.solver.active, self.settings)
        bodies = solver.under(self.interface, self.scale, self.absent).bodies
        return replace(solver, bodies=bodies.factored(nodes, self.space.places, patience=patience))

    @property
    def watched(self) -> bool:
        """Whether increments in space can be followed to events: condensed, and friction has straight branches."""
        interface = self.interface
        return interface.directions == 3 and self.solver.paths is not None and interface.friction.straight

    @property
    def has_multipliers(self) -> bool:
        """Whether there is another way than the condensed interface, and nobody has asked for this one alone."""
        interface = self.interface
        return (
            self.backend == "auto"
            and self.solver.paths is not None
            and bool(self.solver.active.any())
            and 0 < self.K.nnz <= MAX_ENTRIES
            and not interface.facets.any()
            and not (interface.anisotropy != 1.0).any()
        )

    def changed(
        self,
        *,
        friction: Mapping[str, float] | None = None,
        interference: Mapping[str, float] | None = None,
        loads: Mapping[str, float] | None = None,
    ) -> Prepared:
        """Under other friction, interferences or loads; nothing is factorised again.

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
        labels = [contact.label for contact in self.model.contacts]
        _refuse_unknown(friction, labels, "contact", "friction")
        _refuse_unknown(interference, labels, "contact", "interference")
        _refuse_unknown(loads, self.model.scaled_names, "load or moving support", "loads")
        contacts = [_changed_contact(contact, friction or {}, interference or {}) for contact in self.model.contacts]
        factor = {name: number(value, ("loads", name)) for name, value in (loads or {}).items()}
        hot = [replace(load, temperature=_times(load, factor)) for load in self.model.loads]
        model = replace(self.model, contacts=contacts, loads=hot)
        own, pairs = self.interface.contact, zip(contacts, self.model.contacts, strict=True)
        overlap = np.array([contact.interference - old.interference for contact, old in pairs])
        interface = replace(
            under_laws(self.interface, model, [contact.law for contact in contacts]),
            gap=self.interface.gap - overlap[own],
        )
        now = replace(
            self,
            model=model,
            constraints=replace(self.constraints, prescribed=_scaled(self.constraints.prescribed, factor)),
            loads=_scaled(self.loads, factor),
            multiplied=factor | {name: factor.get(name, 1.0) * old for name, old in self.multiplied.items()},
            clock=Clock(),
        )
        refuse_free_motions(self.space, now.constraints, interface, self.parts, self.motions)
        return now.under(interface, most_imposed(stages(model), now.loads, now.constraints), self.absent)


def _scaled(given: Mapping[str, Array], factor: Mapping[str, float]) -> dict[str, Array]:
    """Loads or prescribed displacements times their factors, 1 where there is none."""
    return {name: factor.get(name, 1.0) * values for name, values in given.items()}


def _changed_contact(contact: Contact, friction: Mapping[str, float], interference: Mapping[str, float]) -> Contact:
    """A contact with another friction or interference where its name is given."""
    name = contact.label
    for key, given in (("friction", friction), ("interference", interference)):
        if contact.tied and name in given:
            raise InputError("is tied for good; only contacts can change", where=(key, name))
    if name not in friction and name not in interference:
        return contact
    return replace(
        contact,
        friction=friction.get(name, contact.friction),
        interference=interference.get(name, contact.interference),
    )


@one_thread()
def prepare(
    model: Model,
    *,
    start: Checkpoint | None = None,
    backend: str = "auto",
    settings: SolverSettings | None = None,
    clock: Clock | None = None,
) -> Prepared:
    """Examine, assemble and condense; pairs that seem too far apart to touch are left out.

    Parameters
    ----------
    model : the problem
    start : from which the history goes on; its pairs are taken along
    backend : of the factorisation, "auto", a name or "iterative"
    settings : limits of the methods
    clock : counts the seconds

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
    made = _made(examined, K, near, backend, settings or SolverSettings(), clock)
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


def _made(
    examined: Examined, K: sp.csr_array, near: BoolArray, backend: str, settings: SolverSettings, clock: Clock
) -> Prepared:
    """Factorise the bodies with the nodes of the candidates last and put the law on them, or leave them as they are."""
    interface, T = examined.interface, examined.constraints.transform
    data = {field.name: getattr(examined, field.name) for field in fields(Examined)}
    softness = 0.0
    with clock.phase("assembly"):
        reduced, relative = reduced_stiffness(K, T), sp.csr_array(interface.B @ T)
        bodies = FreeBodies(reduced, relative, examined.constraints.nodes, examined.space.places)
        whole = iterates(bodies, interface, candidates=near, backend=backend)
        solver: ContactSolver
        if whole:
            solver = make_multipliers(examined, reduced, relative, near, settings)
    if not whole:
        condensed = _condensed(examined, bodies, near, backend, clock)
        softness = _softness(examined, condensed)
        data["scale"] = examined.scale.bent(softness)
        data["constraints"] = _with_ties(examined, condensed.ties)
        solver = CondensedSolver.of(condensed, interface, data["scale"], settings)
    absent = np.zeros(len(interface), bool)
    return Prepared(
        **data,
        K=K,
        absent=absent,
        solver=solver,
        clock=clock,
        backend=backend,
        settings=settings,
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


def _condensed(examined: Examined, bodies: FreeBodies, near: BoolArray, backend: str, clock: Clock) -> Condensed:
    """Factorise the bodies with the nodes of the candidates last."""
    rigid = (examined.motions @ examined.floating)[examined.constraints.leaders]
    try:
        return condense(
            bodies,
            examined.interface,
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


def _times(load: Load, factors: Mapping[str, float]) -> Temperature | None:
    """The temperature of a load times its factor; stresses refer to it, other loads are in the nodal forces."""
    given, factor = load.temperature, factors.get(load.label, 1.0)
    if given is None or factor == 1.0:
        return given
    if callable(given):
        return lambda points: factor * given(points)
    return factor * given


def _refuse_unknown(given: Iterable[str] | None, known: Iterable[str], what: str, key: str) -> None:
    for name in given or ():
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

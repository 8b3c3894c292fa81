# SPDX-License-Identifier: BSD-3-Clause
"""What does not depend on the loads: assembled, checked for free motions and condensed once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray
from signorini.blas_threads import one_thread
from signorini.clock import Clock
from signorini.condense.condensed import Condensed
from signorini.distributed.ranks import ON_RANKS, PETSC
from signorini.distributed.refusals import refuse_model
from signorini.engine.bond_company import refuse_held
from signorini.engine.bond_solver import with_laws
from signorini.engine.candidate_pairs import candidate_pairs
from signorini.engine.changed_model import changed_interface, changed_model, scaled
from signorini.engine.condensation import assembled, condense_bodies, free_bodies, reduced_bodies, softness, with_ties
from signorini.engine.examine import Examined, examine, floating_motions, on_ranks, refuse_free_motions
from signorini.engine.memory_check import way_through
from signorini.engine.multipliers import MAX_ENTRIES, PATIENCE, MultiplierSolver, make_multipliers, with_factors
from signorini.engine.plastic_solver import PlasticSolver
from signorini.engine.solver import CondensedSolver, ContactSolver
from signorini.engine.tangent_bodies import TangentBodies
from signorini.engine.way_costs import CONDENSED, increments_before, increments_of
from signorini.errors import InputError
from signorini.fem.rigid_motions import resistance
from signorini.fem.stiffness import reduced_stiffness
from signorini.fem.supports import make_constraints
from signorini.interface.interface import Interface
from signorini.interface.worn_sides import WornSides, worn_sides
from signorini.linalg.plan import Plans
from signorini.model.model import Model
from signorini.model.stage import Stage, stages
from signorini.plasticity.bodies import YieldingBodies, yielding_bodies
from signorini.settings import DEFAULT_SETTINGS, SolverSettings
from signorini.solution.checkpoint import Checkpoint
from signorini.solution.discrete_model import DiscreteModel
from signorini.solution.scale import Loading, data_scale, loading_of
from signorini.solution.state import State

_ITERATED = "the condensed interface, and this model is solved by iteration, because its factor does not fit or because"
UNCONDENSED = f"an exact path needs {_ITERATED} it was asked for; expected path = 'increments'"
_UNCONDENSED_WEAR = f"needs {_ITERATED} it was asked for; expected a smaller model, or none that wears"

_KEPT = 4  # factorisations: a history needs one for each set of supports, and seldom two for its pairs


@dataclass(frozen=True, kw_only=True, eq=False)
class Prepared(Examined, DiscreteModel):
    """A model ready for any load.

    Attributes
    ----------
    solver : the bodies as their contact pairs feel them, and the law
    clock : seconds spent so far
    backend : of the factorisation, or "iterative", as asked for
    settings : limits of the methods
    candidates : (n,) pairs that may touch: the law is asked of those that neither supports nor ties decide
    posed : what supports prescribe, without what ties make of it: name to (dofs,) displacements at factor 1
    softness : the farthest that any load moves the bodies, of its size, where springs hold the pairs: length per force
    released : supports that do not hold
    multiplied : what values of moving supports are multiplied by, beyond the model's
    resting : (dofs,) rigid displacement of bodies that rest, see `engine.floating_bodies`; empty where none does
    flowed : (dofs,) forces of plastic strain that does not change, so that bodies answer as elastic ones; else empty
    wearing : sides that wear, as the pairs see them; None where none does
    meshed : the same on the mesh as it was given, where it has moved with what is worn; None where it has not
    plans, reduced : of the factorisation, and (z, z) stiffness, for tangents of bodies that yield; None where none does
    kept : the last that was factorised, by supports released and candidates, to be found again; None: nothing is kept
    increments : that a factor would have served so far; infinite where the cheaper way is not asked for
    worth : how many of them are worth a factorisation; 0 where bodies are condensed, infinite where none fits
    """

    solver: ContactSolver
    clock: Clock
    backend: str
    candidates: BoolArray
    posed: Mapping[str, Array]
    settings: SolverSettings = field(default_factory=SolverSettings)
    softness: float = 0.0
    released: frozenset[str] = frozenset()
    multiplied: Mapping[str, float] = field(default_factory=dict)
    resting: Array = field(default_factory=lambda: np.zeros(0))
    flowed: Array = field(default_factory=lambda: np.zeros(0))
    wearing: WornSides | None = None
    meshed: Prepared | None = None
    plans: Plans | None = None
    reduced: sp.csr_array | None = None
    kept: dict[tuple[frozenset[str], bytes], Condensed] | None = None
    increments: float = np.inf
    worth: float = 0.0

    @property
    def paths(self) -> CondensedSolver:
        """The solver on the condensed interface.

        Raises
        ------
        InputError
            Where contact is solved on the bodies as they are.
        """
        if self.solver.paths is None:
            raise InputError(UNCONDENSED, where=("step",))
        return self.solver.paths

    @property
    def limited(self) -> bool:
        """Whether pairs that seemed too far apart were left out, and neither supports nor ties decide them."""
        return not (self.candidates | self.solver.held | self.interface.tied).all()

    def widened(self) -> Prepared:
        """With every pair in the law, factorised anew; where all are in it, condensed after all."""
        if self.limited:
            return self._made_again(np.ones(len(self.interface), bool))
        return replace(self, increments=np.inf)._made_again(self.candidates)

    @property
    def spared(self) -> bool:
        """Whether bodies that could be condensed are iterated on, because that is cheaper."""
        return 0.0 < self.worth < np.inf

    def ready(self, stage: Stage, before: Loading) -> tuple[Prepared, Loading]:
        """Under the supports of a step and with the pairs that it can close; and the most imposed up to its end.

        Factorised anew where supports change, the step reaches farther than any before, or it is worth it at last.

        Parameters
        ----------
        stage : the step
        before : the most that was imposed before it
        """
        same = stage.released == self.released
        now = self if same else self._released(stage.released)
        loading = loading_of(stage, now.loads, now.posed, before)
        now = replace(now, increments=self.increments + increments_of(stage, now)) if self.spared else now
        stays = same and (now.increments < self.worth or not self.spared)
        known = stays and bool(self.candidates.all())
        found = self.candidates if known else candidate_pairs(now, loading, self.candidates, held=same)
        if stays and found is self.candidates:
            return now, loading
        return now._made_again(found), loading

    def _released(self, released: frozenset[str]) -> Prepared:
        """Under all supports but some; what is factorised is not theirs yet."""
        constraints = make_constraints(self.space, self.model, without=released, spread=self.constraints.spread)
        prescribed = {name: self.multiplied.get(name, 1.0) * u for name, u in constraints.prescribed.items()}
        resisted = resistance(self.rigid, constraints)
        return replace(
            self,
            constraints=constraints.prescribing(prescribed),
            posed=prescribed,
            resisted=resisted,
            floating=floating_motions(self.rigid, resisted, self.interface),
            released=released,
        )

    def _made_again(self, candidates: BoolArray) -> Prepared:
        posed = replace(self, constraints=self.constraints.prescribing(self.posed))
        key = self.released, candidates.tobytes()
        known = self.kept.get(key) if self.kept else None
        asked = self.backend, self.settings, self.clock, known, self.increments
        made = condensed_model(posed, self.K, candidates, *asked)
        if known is None and self.kept is not None and made.solver.condensed is not None:
            if len(self.kept) >= _KEPT:
                self.kept.pop(next(iter(self.kept)))
            self.kept[key] = made.solver.condensed
        same = {name: getattr(self, name) for name in ("released", "multiplied", "kept", "wearing", "meshed")}
        return _flowing(replace(made, **same), self.yielding)

    def keeping(self) -> Prepared:
        """To be solved many times: what steps factorise for other supports or pairs is kept, the last few."""
        condensed = self.solver.condensed
        known = {} if condensed is None else {(self.released, self.candidates.tobytes()): condensed}
        return replace(self, kept=known)

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
        T = self.constraints.transform
        K, B = reduced_stiffness(self.K, T), sp.csr_array(self.interface.B @ T)
        solver = make_multipliers(self, K, B, self.solver.active, self.settings).without(self.absent)
        return with_factors(solver, self.constraints.nodes, self.space.places, patience)

    @property
    def flows(self) -> bool:
        """Whether points may yield: some body does, and what has flowed is not held as it is."""
        return self.yielding is not None and not len(self.flowed)

    def worn_gap(self, state: State) -> Array:
        """(n,) What sides that are worn as in a state add to the gaps, length."""
        if self.wearing is None or state.wear is None:
            return np.zeros(len(self.interface))
        return np.asarray(self.wearing.gap @ state.wear.beyond, dtype=np.float64)

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
            and self.yielding is None
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
        model, factor = changed_model(self.model, friction=friction, interference=interference, loads=loads)
        interface = changed_interface(self.interface, self.model, model)
        now = replace(
            self,
            model=model,
            constraints=self.constraints.prescribing(scaled(self.constraints.prescribed, factor)),
            posed=scaled(self.posed, factor),
            loads=scaled(self.loads, factor),
            multiplied=factor | {name: factor.get(name, 1.0) * old for name, old in self.multiplied.items()},
            clock=Clock(),
        )
        refuse_free_motions(self.space, self.resisted, interface, self.parts, self.rigid)
        return now.under(interface, loading_of(next(stages(model)), now.loads, now.posed), self.absent)


@one_thread()
def prepare(
    model: Model,
    *,
    start: Checkpoint | None = None,
    backend: str = "auto",
    settings: SolverSettings | None = None,
    clock: Clock | None = None,
    saves: bool = False,
) -> Prepared:
    """Examine, assemble and condense; pairs that seem too far apart to touch are left out.

    Parameters
    ----------
    model : the problem
    start : from which the history goes on; its pairs are taken along
    backend : of the factorisation, "auto", a name, "iterative", or on ranks "petsc" or "mumps"
    settings, clock : limits of the methods; counts the seconds
    saves : whether bodies that are solved for few increments may be iterated on because that is cheaper

    Raises
    ------
    InputError
        See :func:`examine`; or a compliance is so large that contact hardly holds a body.
    """
    clock = clock or Clock()
    if backend in ON_RANKS:
        refuse_model(model)
    with clock.phase("assembly"):
        examined = examine(model, start=start)
        K, backend = assembled(examined, backend)
        near = candidate_pairs(examined, examined.loading, None if start is None else start.near)
    before = None if start is None else start.standing
    first = increments_before(examined, start, backend) if saves else np.inf
    number = first + increments_of(next(stages(model, before=before)), examined) if saves else np.inf
    made = condensed_model(examined, K, near, backend, settings or DEFAULT_SETTINGS, clock, increments=number)
    made = replace(made, increments=first) if made.spared else made  # every step counts its own
    wearing = worn_sides(made.space, made.model, made.interface) if model.wears else None
    if wearing is not None and made.solver.condensed is None:
        raise InputError(_UNCONDENSED_WEAR, where=("contact", int(wearing.contact[0]), "wear"))
    made = replace(made, released=next(stages(made.model, before=before)).released, wearing=wearing)
    return _flowing(made, yielding_bodies(made.space, made.model) if model.yields else None)


def _flowing(made: Prepared, yielding: YieldingBodies | None) -> Prepared:
    """Bodies whose points may yield, where there are any."""
    if yielding is None or made.reduced is None:
        return made
    whole, plans = made.solver.paths is None, made.plans or Plans()
    tangents = TangentBodies(
        made, yielding, made.K, made.reduced, made.candidates, whole, made.backend, made.settings, plans
    )
    solver = PlasticSolver(
        elastic=made.solver, tangents=tangents, interface=made.interface, scale=made.scale, absent=made.absent
    )
    return replace(made, yielding=yielding, solver=solver)


def condensed_model(
    examined: Examined,
    K: sp.csr_array,
    candidates: BoolArray,
    backend: str,
    settings: SolverSettings,
    clock: Clock,
    known: Condensed | None = None,
    increments: float = np.inf,
) -> Prepared:
    """Factorise the bodies with the nodes of the candidates last and put the law on them, or leave them as they are.

    Parameters
    ----------
    examined, K : the model, and its stiffness with those of foundations
    candidates, backend, settings, clock : as of `Prepared`
    known : the bodies factorised with these candidates, where they were
    increments : that a factor serves, see `Prepared`
    """
    interface, yields, plans = examined.interface, examined.model.yields, Plans() if examined.model.yields else None
    bent, condensed, reduced, way = 0.0, known, None, CONDENSED
    solver: CondensedSolver | MultiplierSolver
    with clock.phase("assembly"):
        if on_ranks(K):
            from signorini.engine.solver_on_ranks import kept_on_ranks, solver_on_ranks  # needs PETSc

            examined = kept_on_ranks(examined, K, known)
        data = {field.name: getattr(examined, field.name) for field in fields(Examined)}
        if backend == PETSC:
            solver = solver_on_ranks(examined, candidates, settings)
        elif yields or known is None:
            reduced = reduced_bodies(examined, K)
    if reduced is not None and condensed is None:
        with clock.phase("assembly"):
            bodies = free_bodies(examined, reduced)
            way = way_through(
                bodies, interface, candidates=candidates, backend=backend, yields=yields, increments=increments
            )
            if way.worth:
                solver = replace(make_multipliers(examined, reduced, bodies.B, candidates, settings), most=way.most)
        if not way.worth:
            condensed = condense_bodies(examined, bodies, candidates, backend, clock, plans)
        del bodies
    reduced = reduced if yields else None  # as large as K, and tangents alone ask for it
    if condensed is not None:
        bent = softness(examined, condensed)
        data["scale"] = examined.scale.bent(bent)
        if condensed.ties is not None:
            data["constraints"] = with_ties(examined, condensed.ties)
        solver = CondensedSolver.of(condensed, interface, data["scale"], settings)
    if interface.cohesion is not None:
        refuse_held(examined.model, interface, solver.held)
    return Prepared(
        **data,
        K=K,
        absent=np.zeros(len(interface), bool),
        solver=with_laws(solver, examined) if examined.has_laws else solver,
        clock=clock,
        backend=backend,
        candidates=candidates,
        posed=examined.constraints.prescribed,
        settings=settings,
        softness=bent,
        plans=plans,
        reduced=reduced,
        increments=increments if 0.0 < way.worth < np.inf else np.inf,
        worth=way.worth,
    )

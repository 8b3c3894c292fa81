# SPDX-License-Identifier: BSD-3-Clause
"""Displacements of the bodies at moments of a history of which the forces of the contacts alone were kept.

    K u = f + B^T r

is all of it: r are the forces of the pairs, f the loads. What nothing but contact holds is found but for a rigid
motion, which strains nothing.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array
from signorini.blas_threads import one_thread
from signorini.condense.response import held_by_springs
from signorini.engine.examine import Examined, examine
from signorini.engine.fatigue_places import refuse_unrecoverable
from signorini.errors import InputError
from signorini.fem.rigid import free_motions
from signorini.fem.stiffness import reduced_stiffness, stiffness
from signorini.linalg.protocol import Factorisation
from signorini.linalg.registry import factorise
from signorini.solution.history import History
from signorini.solution.results import Instant, StepResult

_AT_ONCE = 32  # moments that are solved for together: so many displacements of all nodes are in memory
_AGREEMENT_TOL = 1e-6  # of the largest nodal force: how far what is found may be from the state that was kept


@dataclass(frozen=True, kw_only=True, eq=False)
class Recovery:
    """The bodies of a model, factorised without contact.

    Attributes
    ----------
    examined : the model
    K : (dofs, dofs) stiffness of bodies and foundations
    factorisation : of the free displacements
    loose : (dofs, k) rigid motions that nothing but contact holds
    """

    examined: Examined
    K: sp.csr_array
    factorisation: Factorisation
    loose: Array

    @classmethod
    @one_thread()
    def of(cls, history: History) -> Recovery:
        """Assemble and factorise; free motions are held by springs, which carry nothing under balanced forces.

        Raises
        ------
        InputError
            If displacements of the model do not follow from the forces of its contacts alone.
        """
        model = history.model
        refuse_unrecoverable(model)
        # loads that its steps do not name may come from one before it
        examined = examine(replace(model, fatigue=()), start=history.end)
        constraints, T = examined.constraints, examined.constraints.transform
        K = stiffness(examined.space, model)
        for springs in constraints.springs.values():
            K = sp.csr_array(K + springs.T @ springs)
        free = free_motions(examined.resisted, examined.motions[[]])
        loose = np.asarray(examined.motions @ free)
        held = held_by_springs(reduced_stiffness(K, T), loose[constraints.leaders], examined.scale.stiffness)
        found = factorise(held, [], nodes=constraints.nodes, points=examined.space.places)
        return cls(examined=examined, K=K, factorisation=found, loose=loose)

    def displacements(self, step: StepResult, moments: Sequence[Instant]) -> Iterator[Array]:
        """Displacements (nodes, d) at moments of a step; see `dofs`."""
        yield from (self.examined.space.at_nodes(u) for u in self.dofs(step, moments))

    @one_thread()
    def dofs(self, step: StepResult, moments: Sequence[Instant]) -> Iterator[Array]:
        """Displacements (dofs,) at moments of a step, some at once; compared with those at its end, which are kept.

        Raises
        ------
        InputError
            If what is found there is not what was kept.
        """
        asked = [*moments, step.instants[-1]]
        cuts = [*range(0, len(asked), _AT_ONCE), len(asked)]
        for low, high in pairwise(cuts):
            columns = self.solved(asked[low:high])
            yield from columns.T[: len(moments) - low]
            if high == len(asked) and not self._agrees(columns[:, -1], step, asked[-1]):
                words = f"displacements on the way of '{step.name}' do not follow from loads and contacts alone"
                raise InputError(f'{words}; expected at = "events" in it, which keeps them', where=("steps",))

    def solved(self, moments: Sequence[Instant]) -> Array:
        """(dofs, k) Displacements of all dofs at k moments."""
        examined, constraints = self.examined, self.examined.constraints
        loads = np.column_stack([self.loads(moment) + self.pressed(moment) for moment in moments])
        imposed = np.column_stack(
            [
                sum((moment.factors[name] * u for name, u in constraints.prescribed.items()), np.zeros(len(loads)))
                for moment in moments
            ]
        )
        given = loads - self.K @ imposed if imposed.any() else loads
        reduced = self.factorisation.reduce(examined.constraints.on_free(given))
        free = reduced.expand(reduced.load)
        return np.asarray(constraints.transform @ free + imposed)

    def loads(self, moment: Instant) -> Array:
        """(dofs,) Nodal forces of the loads."""
        loads = (moment.factors[name] * f for name, f in self.examined.loads.items())
        return np.asarray(sum(loads, np.zeros(self.examined.space.number_of_dofs)))

    def external(self, moment: Instant, u: Array) -> Array:
        """(dofs,) Loads and reactions at a moment with displacements (dofs,), as a `State` has them."""
        inner = self.K @ u - self.pressed(moment)
        return np.where(self.examined.constraints.alone, self.loads(moment), inner)

    def held(self, moment: Instant, u: Array) -> Array:
        """(dofs,) Forces of supports at a moment with displacements (dofs,)."""
        return self.examined.constraints.support_forces(self.external(moment, u) - self.loads(moment))

    def pressed(self, moment: Instant) -> Array:
        """(dofs,) Forces of the pairs on the bodies."""
        interface = self.examined.interface
        forces = np.zeros((interface.directions, len(interface)))
        for i, contact in enumerate(moment.contacts):
            own = interface.contact == i
            forces[0, own] = contact.area * contact.pressure
            forces[1:, own] = (contact.area * contact.traction.T).reshape(interface.directions - 1, -1)
        return np.asarray(interface.on_bodies(forces))

    def _agrees(self, found: Array, step: StepResult, end: Instant) -> bool:
        """Whether displacements mean the same nodal forces as those at the end of a step; rigid motions make none."""
        kept = found.copy()
        kept[: step.displacement.size] = step.displacement.ravel()
        forces = self.K @ found
        size = max(
            float(np.abs(forces).max(initial=0.0)), float(np.abs(self.loads(end) + self.pressed(end)).max(initial=0.0))
        )
        return bool(np.abs(self.K @ kept - forces).max(initial=0.0) <= _AGREEMENT_TOL * size)

# SPDX-License-Identifier: BSD-3-Clause
"""Bodies of a model cut among ranks and solved there, iterated on or factorised."""

from __future__ import annotations

from dataclasses import fields

import numpy as np

from signorini.arrays import BoolArray, among
from signorini.condense.condensed import Condensed
from signorini.distributed.bodies import RowsOnRanks, make_bodies_on_ranks
from signorini.distributed.constraints import ConstraintsOnRanks, kept_away
from signorini.distributed.direct import FactorsOnRanks, MatrixOnRanks
from signorini.distributed.mesh_rows import at_hand, let_go
from signorini.distributed.ranks import MUMPS, PETSC, the_team
from signorini.distributed.refusals import refuse_without_mumps
from signorini.distributed.room import room_for
from signorini.distributed.stiffness import StiffnessOnRanks
from signorini.engine.examine import Examined
from signorini.engine.memory_check import likely_entries
from signorini.engine.multipliers import MultiplierSolver
from signorini.fem.kinematics import straining_groups
from signorini.fem.supports import Constraints
from signorini.settings import SolverSettings
from signorini.solution.checkpoint import digest

# least bytes an entry of the stiffness, on all ranks together: where they are iterated on cubes of 25,000 to 130,000
# unknowns take 80, with coarse grids and springs; for MUMPS pieces and rows, 12 each, and the factor when it is known
_LEAST = {PETSC: 70.0, MUMPS: 24.0}


def way_on_ranks(examined: Examined) -> str:
    """The back end for a model on ranks: contact is iterated on, where nothing asks for the condensed interface.

    Exact paths, friction cones whose section is no circle, and unknowns without any stiffness, for which multigrid by
    PETSc has no equation, ask for it.

    Parameters
    ----------
    examined : the model
    """
    interface = examined.interface
    exact = any(step.path == "exact" for step in examined.model.steps)
    sections = bool(interface.facets.any() or (interface.anisotropy != 1.0).any())
    return MUMPS if exact or sections or _bare(examined) else PETSC


def _bare(examined: Examined) -> bool:
    """Whether there are unknowns without any stiffness: of rigid bodies and obstacles that contact alone holds."""
    space, T, count = examined.space, examined.constraints.transform, len(examined.space.mesh.points)
    strained = among([group.cells for group in straining_groups(space, examined.model)], count)
    nodes = np.repeat(np.arange(T.shape[0]) // space.components, np.diff(T.indptr))
    felt = np.zeros(T.shape[1], dtype=np.bool_)
    felt[T.indices[np.append(strained, False)[np.minimum(nodes, count)]]] = True
    return not felt.all()


def stiffness_on_ranks(examined: Examined, backend: str) -> tuple[StiffnessOnRanks, str]:
    """Cut the mesh among the ranks and assemble there; and the back end that it is for, see `way_on_ranks`.

    Parameters
    ----------
    examined, backend : the model and what is asked for

    Raises
    ------
    InputError
        If it is to be factorised, and PETSc cannot; or a machine of the ranks has too little memory.
    """
    way = way_on_ranks(examined) if backend == PETSC else backend
    if way == MUMPS:
        refuse_without_mumps()
    team = the_team()
    share = _LEAST[way] * likely_entries(examined.model) / team.size
    team.everywhere(room_for, share)[0].refuse(f"back end '{way}', for {examined.model.number_of_dofs} unknowns,")
    space, model, constraints = examined.space, examined.model, examined.constraints
    cells = way == MUMPS  # of which derivatives are asked; little beside the factor
    return StiffnessOnRanks(team, space, model, constraints, examined.interface, cells=cells), way


def kept_on_ranks(examined: Examined, K: StiffnessOnRanks, known: Condensed | None = None) -> Examined:
    """A model of which all that is as large as the mesh stays on the ranks from now on, and the mesh if it was lent.

    That is supports, and what they prescribe, and loads. Rigid motions are made anew where somebody asks for them.

    Parameters
    ----------
    examined : the model
    K : its pieces on the ranks, which are cut anew where constraints ask for more
    known : the bodies factorised under these constraints, where they were
    """
    constraints, space = examined.constraints, examined.space
    there, always = _known(constraints, known), examined.always
    if there is None:
        with at_hand(space.mesh, space.blocks):
            if not K.serves(constraints):
                K.cut(constraints)
            rows = RowsOnRanks(K, space, constraints, examined.rigid)
            there = ConstraintsOnRanks.of(constraints, rows, examined.rigid)
    space.forget("facets", "facets_at_boundaries", "volumes", "used", "used_nodes")
    examined.rigid.forget()
    digest(examined.model.mesh)  # checkpoints know the mesh by it
    let_go(space)
    data = {field.name: getattr(examined, field.name) for field in fields(Examined)}  # `examined` may be more than that
    data["constraints"] = there
    data["always"] = there if always is constraints else kept_away(always, K.vectors)
    data["loads"] = {name: K.vectors.of(forces) for name, forces in examined.loads.items()}
    return Examined(**data)


def _known(constraints: Constraints, known: Condensed | None) -> ConstraintsOnRanks | None:
    """Constraints that ranks have already; those that bodies were factorised under prescribe what is asked now."""
    if isinstance(constraints, ConstraintsOnRanks) or known is None:
        return constraints if isinstance(constraints, ConstraintsOnRanks) else None
    assert isinstance(known.factorisation, FactorsOnRanks)
    there = known.factorisation.held.matrix.constraints
    return there.prescribing({name: there.placed(u) for name, u in constraints.prescribed.items()})


def solver_on_ranks(examined: Examined, candidates: BoolArray, settings: SolverSettings) -> MultiplierSolver:
    """The method of multipliers on bodies that are on all ranks.

    Parameters
    ----------
    examined : the model, as it is kept there
    candidates : (n,) pairs that may touch
    settings : limits of the rounds
    """
    constraints, interface = examined.constraints, examined.interface
    assert isinstance(constraints, ConstraintsOnRanks)
    B, places = constraints.in_free(interface.B), examined.space.mesh.places_of
    bodies = make_bodies_on_ranks(constraints.rows, places, B, interface, candidates)
    return MultiplierSolver(bodies=bodies, settings=settings)


def matrix_on_ranks(examined: Examined) -> MatrixOnRanks:
    """The stiffness of the free displacements on all ranks, for MUMPS to factorise.

    Parameters
    ----------
    examined : the model, as it is kept there
    """
    assert isinstance(examined.constraints, ConstraintsOnRanks)
    return MatrixOnRanks.of(examined.constraints)

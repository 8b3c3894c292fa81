# SPDX-License-Identifier: BSD-3-Clause
"""Bodies of a model cut among ranks and solved there; what that does not take is refused before anything is cut."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from signorini.arrays import BoolArray, among
from signorini.distributed.bodies import RowsOnRanks, make_bodies_on_ranks
from signorini.distributed.ranks import the_team
from signorini.distributed.refusals import refusal
from signorini.distributed.stiffness import StiffnessOnRanks
from signorini.engine.examine import Examined
from signorini.engine.multipliers import MultiplierSolver, refuse_sections
from signorini.fem.kinematics import straining_groups
from signorini.settings import SolverSettings


def stiffness_on_ranks(examined: Examined) -> StiffnessOnRanks:
    """Cut the mesh among the ranks and assemble there.

    Parameters
    ----------
    examined : the model

    Raises
    ------
    InputError
        If something in the model is not known here, or PETSc is not installed.
    """
    team, constraints = the_team(), examined.constraints
    refuse_sections(examined.interface)
    _refuse_bare(examined)
    return StiffnessOnRanks(team, examined.space, examined.model, constraints, examined.interface)


def _refuse_bare(examined: Examined) -> None:
    """Refuse unknowns without any stiffness: multigrid by PETSc has no equation for them.

    Raises
    ------
    InputError
        The first rigid body or obstacle that contact alone holds.
    """
    space, T, count = examined.space, examined.constraints.transform, len(examined.space.mesh.points)
    strained = among([group.cells for group in straining_groups(space, examined.model)], count)
    nodes = np.repeat(np.arange(T.shape[0]) // space.components, np.diff(T.indptr))
    felt = np.zeros(T.shape[1], dtype=np.bool_)
    felt[T.indices[np.append(strained, False)[np.minimum(nodes, count)]]] = True
    if not felt.all():
        raise refusal("rigid bodies and obstacles that contact alone holds", "prescribed motions")


def solver_on_ranks(
    examined: Examined, K: StiffnessOnRanks, candidates: BoolArray, settings: SolverSettings
) -> MultiplierSolver:
    """The method of multipliers on bodies that are on all ranks.

    Parameters
    ----------
    examined : the model
    K : its pieces on the ranks, which are cut anew where constraints ask for more
    candidates : (n,) pairs that may touch
    settings : limits of the rounds
    """
    constraints = examined.constraints
    if not K.serves(constraints):
        K.cut(constraints)
    T = constraints.transform
    rows = RowsOnRanks(K, examined.space, constraints, sp.csr_array(T.T @ examined.motions))
    B, points = sp.csr_array(examined.interface.B @ T), examined.space.mesh.points
    bodies = make_bodies_on_ranks(rows, points, B, examined.interface, candidates)
    return MultiplierSolver(bodies=bodies, settings=settings)

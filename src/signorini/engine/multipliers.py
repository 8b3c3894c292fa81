# SPDX-License-Identifier: BSD-3-Clause
"""Where the condensed interface loses its digits, contact is solved on the bodies as they are.

What a thin body yields to a force is many orders of magnitude more than what it is compressed by; a dense compliance
keeps the digits of the large one. The stiffness of the bodies has both. So where the condensed way finds nothing, and
nothing is proved either, multipliers are iterated with factors of the bodies and the springs of their contacts.
"""

from __future__ import annotations

from dataclasses import replace

import scipy.sparse as sp

from signorini.engine.prepare import Prepared, as_they_are
from signorini.fem.stiffness import reduced_stiffness
from signorini.iterative.bodies import Bodies
from signorini.model.step import Step

GIVEN_WAY = "the condensed interface gave no certified answer; contact was solved on the bodies as they are"
"""What a step says that was solved so."""

_MOST = 3_000_000  # entries of K: what factors some dozen times within minutes
_PATIENCE = 30  # rounds: what converges takes some 20 in all


def gives_way(prepared: Prepared, step: Step) -> bool:
    """Whether a step that is lost may go the other way: pairs that were left out come first, exact paths have none."""
    return step.path != "exact" and not prepared.limited and has_another_way(prepared)


def has_another_way(prepared: Prepared) -> bool:
    """Whether there is another way than the condensed interface, and nobody has asked for this one alone."""
    interface = prepared.interface
    return (
        prepared.backend == "auto"
        and not isinstance(prepared.bodies, Bodies)
        and bool(prepared.bodies.active.any())
        and 0 < prepared.K.nnz <= _MOST
        and not interface.facets.any()
        and not (interface.anisotropy != 1.0).any()
    )


def given_way(prepared: Prepared, *, patience: int = _PATIENCE) -> Prepared:
    """The same model, its bodies as they are and factored with the springs of their contacts.

    Parameters
    ----------
    patience : rounds without progress after which an increment is given up
    """
    T, nodes = prepared.constraints.transform, prepared.constraints.nodes
    K, B = reduced_stiffness(prepared.K, T), sp.csr_array(prepared.interface.B @ T)
    bodies = as_they_are(prepared, K, B, prepared.bodies.active).among(~prepared.absent)
    bodies = bodies.factored(nodes, prepared.space.places, patience=patience)
    return replace(prepared, bodies=bodies, law_or_none=None)

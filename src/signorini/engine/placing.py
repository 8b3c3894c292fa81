# SPDX-License-Identifier: BSD-3-Clause
"""Where the arrays of a model are that are as large as its mesh: here, or on the ranks of MPI."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from signorini.condense.condensed import Condensed
from signorini.engine.condensation import on_ranks
from signorini.engine.examine import Examined


def placed(examined: Examined, K: Any, known: Condensed | None = None) -> Examined:
    """A model whose arrays are where its stiffness is: here, or on ranks what is as large as the mesh.

    Parameters
    ----------
    examined, K : the model, and its stiffness as it was assembled
    known : the bodies factorised under its constraints, where they were
    """
    if not on_ranks(K):
        return examined
    from signorini.engine.solver_on_ranks import kept_on_ranks  # needs PETSc

    data = {field.name: getattr(examined, field.name) for field in fields(Examined)}
    return Examined(**data | kept_on_ranks(examined, K, known))

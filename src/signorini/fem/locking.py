# SPDX-License-Identifier: BSD-3-Clause
"""Bodies whose cells would answer far too stiffly: refused where they must, named where they may."""

from __future__ import annotations

import numpy as np

from signorini.errors import InputError
from signorini.fem.space import Space
from signorini.model.model import Model

# bulk over shear modulus, Poisson's ratio 0.49: compatible displacements cannot keep the volume of their cells
_STIFF = 50.0
_FEW = 4  # cells: a body of fewer is a toy


def refuse_locking(model: Model) -> None:
    """Refuse what cannot be meant.

    Raises
    ------
    InputError
        If a body is nearly incompressible, its strain is prescribed across the plane and its cells have no internal
        modes, or if the incompatible formulation is asked for a body without linear quadrilaterals.
    """
    owner = model.body_of_cells()
    for i, body in enumerate(model.bodies):
        families, first = set(), 0
        for family, cells in model.mesh.cells.items():
            if (owner[first : first + len(cells)] == i).any():
                families.add(family)
            first += len(cells)
        where = ("body", i, "formulation")
        if body.formulation == "incompatible" and not families & {"quad", "hexahedron"}:
            found = " and ".join(sorted(families))
            raise InputError(
                f"is 'incompatible', but '{body.name}' has no 'quad' or 'hexahedron' cells; it has {found}", where=where
            )
        ratio = body.material.bulk_modulus / body.material.shear_modulus
        if model.kind == "plane stress" or ratio <= _STIFF:
            continue
        if body.formulation != "incompatible" or families not in ({"quad"}, {"hexahedron"}):
            raise InputError(
                f"'{body.name}' is nearly incompressible (bulk over shear modulus {ratio:.3g}): its cells would lock. "
                "Expected linear quadrilaterals ('quad') or hexahedra alone, with formulation = 'incompatible'",
                where=where,
            )


def thin_bodies(space: Space, model: Model) -> tuple[str, ...]:
    """Bodies of standard linear quadrilaterals of which every one lies at an outer edge: too stiff in bending."""
    if "quad" not in model.mesh.cells:
        return ()
    key, count = np.unique(space.edges.key, return_counts=True)
    outer = space.edges.cell[count[np.searchsorted(key, space.edges.key)] == 1]
    at_edge = np.zeros(model.mesh.number_of_cells, bool)
    at_edge[outer] = True
    quads = np.zeros(model.mesh.number_of_cells, bool)
    block = next(block for block in space.blocks if block.family == "quad")
    quads[block.first : block.first + len(block.cells)] = True
    owner = model.body_of_cells()
    names = []
    for i, body in enumerate(model.bodies):
        own = owner == i
        if body.formulation == "standard" and own.sum() > _FEW and (at_edge & quads)[own].all():
            names.append(body.name)
    return tuple(names)

# SPDX-License-Identifier: BSD-3-Clause
"""Bodies whose cells would answer far too stiffly: refused where they must, named where they may."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from signorini.errors import InputError, Where
from signorini.fem.space import Space, has_mean_dilatation
from signorini.model.body import Body, locking_families
from signorini.model.material import Elastic
from signorini.model.model import Model

# bulk over shear modulus, Poisson's ratio 0.49: compatible displacements cannot keep the volume of their cells
_LOCKING_RATIO = 50.0
_NOTICED_RATIO = 10.0  # 0.45: from here on it shows, but in cells with so many functions as these
_SUPPLE = {"quad8", "quad9", "hexahedron20", "hexahedron27"}
_TOY_CELLS = 4  # cells: a body of fewer is a toy


def refuse_locking(model: Model) -> None:
    """Refuse what cannot be meant.

    Raises
    ------
    InputError
        If a body is nearly incompressible, its strain is prescribed across the plane and its cells would lock; if a
        formulation is asked for cells, a material or a kind of model that do not have it.
    """
    for i, body in enumerate(model.bodies):
        where = ("body", i, "formulation")
        families = model.mesh.families(body.name)
        found = " and ".join(sorted(families))
        if body.formulation == "incompatible" and not _has_modes(body, families):
            raise InputError(
                f"is 'incompatible', but '{body.name}' has no 'quad' or 'hexahedron' cells; it has {found}", where=where
            )
        if body.formulation == "mean dilatation":
            _refuse_mean_dilatation(model, body, families, where)
            continue
        ratio = body.material.bulk_modulus / body.material.shear_modulus
        if model.kind == "plane stress" or ratio <= _LOCKING_RATIO:
            continue
        # with a hoop strain, and in space, internal modes do not keep the volume of distorted cells
        if body.formulation == "incompatible" and set(families) == {"quad"} and model.kind == "plane strain":
            continue
        raise InputError(
            f"'{body.name}' is nearly incompressible (bulk over shear modulus {ratio:.3g}): its cells ({found}) would "
            "lock. Expected quadrilaterals, hexahedra, quadratic triangles or tetrahedra, with formulation = 'mean "
            "dilatation'",
            where=where,
        )


def _refuse_mean_dilatation(model: Model, body: Body, families: Mapping[str, int], where: Where) -> None:
    """Only for isotropic bodies, of cells that it helps, whose strain across the plane is given."""
    if model.kind == "plane stress":
        raise InputError("is 'mean dilatation', of which plane stress has no need; expected 'standard'", where=where)
    if not isinstance(body.material, Elastic):
        raise InputError(f"is 'mean dilatation', but the material of '{body.name}' is not isotropic", where=where)
    lost = sorted(locking_families(families) | {family for family in families if not has_mean_dilatation(family)})
    if lost:
        raise InputError(
            f"is 'mean dilatation', but '{body.name}' has {' and '.join(lost)} cells, which lock all the same; "
            "expected quadrilaterals, hexahedra, quadratic triangles or tetrahedra",
            where=where,
        )


def stiffened_bodies(model: Model) -> tuple[str, ...]:
    """Bodies that are not refused, but whose standard cells are noticeably too stiff in their volume."""
    if model.kind == "plane stress":
        return ()
    return tuple(
        body.name
        for body in model.bodies
        if body.formulation == "standard"
        and not model.mesh.families(body.name).keys() <= _SUPPLE
        and body.material.bulk_modulus > _NOTICED_RATIO * body.material.shear_modulus
    )


def modes_in_flow(model: Model) -> dict[str, str]:
    """Bodies that yield in cells with internal modes which leave few motions that keep the volume, and what of it.

    In space, and around an axis, every point of such a cell asks for its volume, as linear tetrahedra do.
    """
    if model.kind != "3d" and not model.axisymmetric:
        return {}
    where = "around an axis" if model.axisymmetric else "in space"
    return {
        body.name: (
            f"body '{body.name}' yields in cells with incompatible modes, which {where} hardly keep their volume: they "
            "flow too stiffly, and beyond the limit load its load may rise on; take formulation = 'mean dilatation'"
        )
        for body in model.bodies
        if body.material.yields and _has_modes(body, model.mesh.families(body.name))
    }


def _has_modes(body: Body, families: Iterable[str]) -> bool:
    """Whether cells of some of the families have internal modes in a body."""
    return any(body.formulation_in(family) == "incompatible" for family in families)


def thin_bodies(space: Space, model: Model) -> tuple[str, ...]:
    """Bodies of standard linear quadrilaterals of which every one lies at an outer edge: too stiff in bending."""
    if "quad" not in model.mesh.cells:
        return ()
    edges = space.facets[2]
    key, count = np.unique(edges.key, return_counts=True)
    outer = edges.cell[count[np.searchsorted(key, edges.key)] == 1]
    at_edge = np.zeros(model.mesh.number_of_cells, bool)
    at_edge[outer] = True
    quads = np.zeros(model.mesh.number_of_cells, bool)
    block = next(block for block in space.blocks if block.family == "quad")
    quads[block.first : block.first + len(block.cells)] = True
    owner = model.body_of_cells()
    names = []
    for i, body in enumerate(model.bodies):
        own = owner == i
        if body.formulation == "standard" and own.sum() > _TOY_CELLS and (at_edge & quads)[own].all():
            names.append(body.name)
    return tuple(names)

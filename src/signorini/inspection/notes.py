# SPDX-License-Identifier: BSD-3-Clause
"""Notes on models that look wrong though they can be solved: meshes, units, contacts that supports hold or are far."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.spatial import KDTree

from signorini.arrays import IntArray
from signorini.engine.examine import Examined
from signorini.model.model import Model
from signorini.model.stage import stages

_SAME_PLACE_TOL = 1e-9  # of the size: nodes that are nearer lie at one place
_MAX_OPENING = 0.05  # of the size: contacts that start farther apart hardly mean to touch
_MAX_NUMBERS = 3  # of nodes in a note
_MAX_MODULUS_RATIO = 1e5  # a factor that no two solids have between their moduli
# Young's moduli of metals in Pa and MPa, the sizes that go with them, densities that go with them
_METALS = (
    ("Pa", (3e10, 6e11), "m", (1e-4, 50.0), (1e2, 1e5)),
    ("MPa", (3e4, 6e5), "mm", (0.05, 1e6), (1e-10, 1e-7)),
)


def mesh_notes(model: Model) -> Iterator[str]:
    """Nodes of no element and no rigid surface, and nodes of one body that lie at one place."""
    mesh, labels = model.mesh, model.mesh.labels
    used = np.unique(np.concatenate([cells.ravel() for cells in mesh.cells.values()]))
    rigid = [mesh.nodes_of(name) for name in mesh.boundaries if mesh.bounds_nothing(name)]
    loose = np.setdiff1d(np.arange(len(mesh.points)), np.concatenate([used, *rigid]))
    if len(loose):
        yield f"{len(loose)} nodes belong to no element: {_some(labels[loose])}"
    body = np.full(len(mesh.points), -1)
    for cells, owner in zip(mesh.cells.values(), mesh.by_family(model.body_of_cells()), strict=True):
        body[cells] = owner[:, None]
    size = float(np.ptp(mesh.points, axis=0).max())
    pairs = KDTree(mesh.points[used]).query_pairs(_SAME_PLACE_TOL * size, output_type="ndarray")
    pairs = used[pairs[body[used[pairs[:, 0]]] == body[used[pairs[:, 1]]]]] if len(pairs) else pairs
    if len(pairs):
        a, b = labels[pairs[0]]
        where = tuple(float(x) for x in mesh.points[pairs[0, 0]].round(6))
        name = model.bodies[body[pairs[0, 0]]].name
        yield (
            f"{len(pairs)} pairs of nodes of one body lie at one place, the first, {a} and {b} of '{name}', at "
            f"{where}: a crack, or nodes that should be one"
        )


def unit_notes(model: Model) -> Iterator[str]:
    """Moduli, sizes and densities that do not seem to be in one system of units."""
    size = float(np.ptp(model.mesh.points, axis=0).max())
    moduli = {body.name: body.material.smallest_modulus for body in model.bodies}
    softest, stiffest = min(moduli, key=lambda name: moduli[name]), max(moduli, key=lambda name: moduli[name])
    if moduli[stiffest] > _MAX_MODULUS_RATIO * moduli[softest]:
        apart = moduli[stiffest] / moduli[softest]
        yield f"the moduli of '{softest}' and '{stiffest}' are {apart:.1g} times apart: units?"
    for body in model.bodies:
        modulus, density = body.material.smallest_modulus, body.material.density
        for unit, (low, high), length, sizes, densities in _METALS:
            if low <= modulus <= high:
                seems = f"'{body.name}': E {modulus:g} looks like {unit}"
                if not sizes[0] <= size <= sizes[1]:
                    yield f"{seems}, but the model's size {size:g} not like {length}"
                if density and not densities[0] <= density <= densities[1]:
                    yield f"{seems}, to which the density {density:g} does not fit"


def held_notes(examined: Examined) -> Iterator[str]:
    """Contact nodes that supports hold along the normal: there the gap is given, whatever contact does."""
    interface, space = examined.interface, examined.space
    for i, contact in enumerate(examined.model.contacts):
        own = interface.contact == i
        nodes, normals = interface.node[own], interface.normals[own]
        held = examined.constraints.owner[space.dofs(nodes)][:, : normals.shape[1]] >= 0
        blocked = nodes[np.abs(normals * held).sum(axis=1) > 0.999 * np.abs(normals).sum(axis=1)]
        if len(blocked):
            numbers = examined.model.mesh.labels[blocked]
            yield f"supports hold {len(blocked)} nodes of contact '{contact.label}' along its normal: {_some(numbers)}"


def idle_notes(examined: Examined) -> Iterator[str]:
    """Supports that hold nothing, because others hold it already."""
    released = next(stages(examined.model)).released
    holding = np.unique(examined.constraints.owner)
    for i, support in enumerate(examined.model.supports):
        if i not in holding and support.label not in released:
            yield f"support '{support.label}' holds nothing that those before it do not: its reaction is zero"


def far_notes(examined: Examined) -> Iterator[str]:
    """Contacts that start open by a large part of the model's size."""
    size = float(np.ptp(examined.model.mesh.points, axis=0).max())
    for i, contact in enumerate(examined.model.contacts):
        gap = examined.interface.gap[examined.interface.contact == i]
        if len(gap) and gap.min() > _MAX_OPENING * size:
            yield f"contact '{contact.label}' starts far open: by {gap.min() / size:.0%} of the model's size"


def _some(numbers: IntArray) -> str:
    more = ", ..." if len(numbers) > _MAX_NUMBERS else ""
    return ", ".join(str(number) for number in numbers[:_MAX_NUMBERS]) + more

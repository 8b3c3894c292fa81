# SPDX-License-Identifier: BSD-3-Clause
"""A model said in other units, seen from elsewhere, or numbered differently."""

from dataclasses import replace

import numpy as np

from signorini.model.mesh import Mesh
from signorini.model.obstacle import Plane

# a mirror is a map like a rotation; (2, 2) matrices throughout


def _parts(values, factor):
    return None if values is None else tuple(None if v is None else factor * v for v in values)


def rescaled(model, *, length=1.0, displacement=1.0, modulus=1.0):
    """Lengths of the geometry, displacements (imposed, gaps) beyond that, and moduli, each times a factor.

    Geometry and displacements go together in the equations only if gaps do not come from the geometry.
    """
    strain = displacement
    moved, stress = length * displacement, modulus * strain
    bodies = [replace(body, material=replace(body.material, E=modulus * body.material.E)) for body in model.bodies]
    supports = [replace(support, u=_parts(support.u, moved), on=_at(support.on, length)) for support in model.supports]
    loads = [
        replace(
            load,
            on=_at(load.on, length),
            force=_parts(load.force, stress * length),
            traction=_parts(load.traction, stress),
            pressure=None if load.pressure is None else stress * load.pressure,
            body_force=_parts(load.body_force, stress / length),
        )
        for load in model.loads
    ]
    contacts = [
        replace(
            contact,
            gap=contact.gap if contact.gap == "geometry" else moved * contact.gap,
            interference=moved * contact.interference,
            normal_compliance=length / modulus * contact.normal_compliance,
            tangential_compliance=length / modulus * contact.tangential_compliance,
            mortar=replace(contact.mortar, point=_at(contact.mortar.point, length))
            if isinstance(contact.mortar, Plane)
            else contact.mortar,
        )
        for contact in model.contacts
    ]
    mesh = replace(model.mesh, points=length * model.mesh.points)
    return replace(model, mesh=mesh, bodies=bodies, supports=supports, loads=loads, contacts=contacts)


def _at(place, length):
    return place if isinstance(place, str) else tuple(length * x for x in place)


def mapped(model, Q, shift=(0.0, 0.0)):
    """The whole model under ``x -> Q x + shift``, Q orthogonal; supports must be full vectors or follow the axes."""
    Q, shift = np.asarray(Q), np.asarray(shift)

    def vector(v):
        if v is None:
            return None
        turned = Q @ [np.nan if part is None else part for part in v]
        if np.isnan(turned).all() and not all(part is None for part in v):  # only a mirror leaves axes alone
            turned = [None if part is None else Q[i, i] * part for i, part in enumerate(v)]
        return tuple(None if part is None or np.isnan(part) else float(part) for part in turned)

    def place(on):
        return on if isinstance(on, str) else tuple(float(x) for x in Q @ on + shift)

    contacts = [
        replace(contact, mortar=Plane(point=place(contact.mortar.point), normal=vector(contact.mortar.normal)))
        if isinstance(contact.mortar, Plane)
        else contact
        for contact in model.contacts
    ]
    loads = [
        replace(
            load,
            on=place(load.on),
            force=vector(load.force),
            traction=vector(load.traction),
            body_force=vector(load.body_force),
        )
        for load in model.loads
    ]
    return replace(
        model,
        mesh=replace(model.mesh, points=model.mesh.points @ Q.T + shift),
        supports=[replace(support, u=vector(support.u), on=place(support.on)) for support in model.supports],
        loads=loads,
        contacts=contacts,
    )


def renumbered(model, rng):
    """Nodes, cells and facets in another order, cells begun at another corner; also the new number of every node."""
    mesh = model.mesh
    new = rng.permutation(len(mesh.points))
    order = {family: rng.permutation(len(cells)) for family, cells in mesh.cells.items()}
    cells = {
        family: np.roll(new[mesh.cells[family][order[family]]], int(rng.integers(0, 4)), axis=1)
        for family in mesh.cells
    }
    start, number_of = 0, []
    for family, nodes in mesh.cells.items():
        number_of.append(start + np.argsort(order[family]))
        start += len(nodes)
    cell_number = np.concatenate(number_of)
    other = Mesh(
        points=mesh.points[np.argsort(new)],
        cells=cells,
        bodies={name: rng.permutation(cell_number[index]) for name, index in mesh.bodies.items()},
        boundaries={
            name: rng.permutation(new[facets][:, :: int(rng.choice([-1, 1]))])
            for name, facets in mesh.boundaries.items()
        },
        nodes={name: new[index] for name, index in mesh.nodes.items()},
    )
    return replace(model, mesh=other), new

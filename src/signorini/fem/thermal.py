# SPDX-License-Identifier: BSD-3-Clause
"""Thermal strain: the temperatures of the bodies, the nodal forces of it, and its part of the energy.

With the stress ``sigma = D (eps - alpha T)`` equilibrium is ``K u = f + f_T``, ``f_T = int B^T D alpha T``: nodal
forces that balance each other, so that temperature is a load like others. Stresses and energies subtract it again.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from signorini.arrays import Array
from signorini.fem.elasticity import elasticities, expansions
from signorini.fem.kinematics import Group, Kinematics, kinematics, mean_in_cells, straining_groups
from signorini.fem.space import Space
from signorini.model.conditions import Load
from signorini.model.model import Model


def temperatures(space: Space, model: Model, factors: Mapping[str, float]) -> Array | None:
    """Temperatures of every body at load factors, (bodies, nodes), or None in a model without any.

    Parameters
    ----------
    space : of the model
    """
    loads = [load for load in model.loads if load.temperature is not None]
    if not loads:
        return None
    names = [body.name for body in model.bodies]
    total = np.zeros((len(names), len(space.mesh.points)))
    for load in loads:
        total[names.index(str(load.on))] += factors.get(load.label, 0.0) * given_temperature(load, space.mesh.points)
    return total


def given_temperature(load: Load, points: Array) -> Array:
    """Temperature of a load at factor 1, (nodes,).

    Parameters
    ----------
    load : of temperature
    points : (nodes, d) of the mesh
    """
    given = load.temperature(points) if callable(load.temperature) else load.temperature
    field: Array = np.broadcast_to(np.asarray(given, float), (len(points),))
    return field


def thermal_strain(model: Model, group: Group, points: Kinematics, temperature: Array) -> Array:
    """Free thermal strain at points of a group, (m, q, 4 or 6), from temperatures (bodies, nodes).

    Parameters
    ----------
    model : tells its kind
    temperature : above that without strain
    """
    here = temperature[group.body[:, None], group.cells] @ points.values.T
    strain: Array = here[..., None] * expansions(model)[group.body][:, None]
    return strain


def thermal_forces(space: Space, model: Model, load: Load) -> Array:
    """Nodal forces of a temperature at factor 1, (dofs,).

    Parameters
    ----------
    space, model : of the bodies
    load : of temperature
    """
    forces = np.zeros((len(space.mesh.points), space.components))
    for group, points, _, stress in _held(space, model, load):
        if group.formulation == "mean dilatation":
            pressure = stress[..., :3].mean(axis=-1)
            mean = mean_in_cells(points.weights, group.block.pressures, pressure, group.block.pressures)
            stress[..., :3] += (mean - pressure)[..., None]
        np.add.at(forces, group.cells, -points.forces(stress)[:, : points.nodes])
    return forces.ravel()


def held_energy(space: Space, model: Model) -> tuple[list[str], Array]:
    """Names of the temperatures, and G: with all nodes held they store ``s G s / 2`` at the factors s."""
    loads = [load for load in model.loads if load.temperature is not None]
    G = np.zeros((len(loads), len(loads)))
    for one, _ in enumerate(loads):
        for other, _ in enumerate(loads[: one + 1]):
            for first, second in zip(_held(space, model, loads[one]), _held(space, model, loads[other]), strict=True):
                G[one, other] -= np.einsum("mq,mqc,mqc->", first[1].weights, first[2], second[3])
            G[other, one] = G[one, other]
    return [load.label for load in loads], G


def _held(space: Space, model: Model, load: Load) -> Iterator[tuple[Group, Kinematics, Array, Array]]:
    """Thermal strains of a load, and the stresses where all nodes are held, at the quadrature points of every group."""
    temperature = temperatures(space, model, {load.label: 1.0})
    assert temperature is not None
    D = elasticities(model)
    for group in straining_groups(space, model):
        own = D[group.body]
        points = kinematics(space, model, group)
        strain = thermal_strain(model, group, points, temperature)
        yield group, points, strain, points.relaxed(own, -np.einsum("mcd,mqd->mqc", own, strain))

# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that yield: what their points answer to displacements, and how much softer that makes them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from signorini.arrays import Array, IntArray
from signorini.fem import _kernels as assembly
from signorini.fem.elasticity import elasticities, expansions
from signorini.fem.kinematics import mean_in_cells
from signorini.fem.space import Space
from signorini.fem.thermal import temperatures
from signorini.model.model import Model
from signorini.plasticity import kernels, linearised, radial_return, softening
from signorini.plasticity.groups import PointGroup, point_groups
from signorini.plasticity.laws import Heat, YieldLaws, heat_of, yield_laws
from signorini.plasticity.modes import settle
from signorini.plasticity.radial_return import Points
from signorini.plasticity.state import PlasticState, no_flow

_MODE_ROUNDS = 2  # of modes into balance: the second takes up what rounding has left where plastic strains are large


@dataclass(frozen=True, kw_only=True, eq=False)
class PlasticResponse:
    """What the points answer to displacements, from the state that they come from.

    Attributes
    ----------
    state : after backward Euler
    points : the same with what a tangent needs
    dual : (p, n) relative stress over the radius, of the linear model, see `linearised.dual_stress`
    """

    state: PlasticState
    points: Points
    dual: Array

    @property
    def flows(self) -> bool:
        """Whether any point yields."""
        return bool(self.points.yields.any())


@dataclass(frozen=True, kw_only=True, eq=False)
class YieldingBodies:
    """The quadrature points of all bodies that yield.

    Attributes
    ----------
    space, model : of all bodies
    groups : of cells that may yield
    laws : material data
    body : (p,) of every point
    elasticity : (b, n, n) elastic law of every body, in the kind of the model
    pattern : rows and columns of the graph of the nodes of cells that may yield
    """

    space: Space
    model: Model
    groups: tuple[PointGroup, ...]
    laws: YieldLaws
    body: IntArray
    elasticity: Array
    pattern: tuple[IntArray, NDArray[np.int32]]

    @property
    def weights(self) -> Array:
        """(p,) Volumes of the points."""
        return np.concatenate([group.weights.ravel() for group in self.groups])

    def places(self) -> Array:
        """(p, d) Where the points are, length."""
        at = [np.einsum("qk,mki->mqi", group.values, self.space.mesh.points[group.cells]) for group in self.groups]
        return np.concatenate([points.reshape(-1, points.shape[2]) for points in at])

    @property
    def components(self) -> int:
        """Of a strain, 4 or 6."""
        return int(self.elasticity.shape[1])

    def untouched(self) -> PlasticState:
        """Nothing has flowed yet."""
        return no_flow(len(self.body), self.components, self.laws.back.shape[1], self.space.number_of_dofs)

    def heat(self, factors: Mapping[str, float]) -> Heat:
        """What the temperatures at load factors by name do to the points."""
        swelling, warm = np.zeros(len(self.body)), np.zeros(len(self.body))
        found = temperatures(self.space, self.model, factors)
        if found is not None:
            for group in self.groups:
                own = group.own
                here = found[group.group.body[:, None], group.group.cells] @ group.values.T
                warm[own] = here.ravel()
                swelling[own] = expansions(self.model)[self.body[own], :3].sum(axis=1) * warm[own]
        return heat_of(self.laws, self.body, swelling, warm)

    def cold(self) -> Heat:
        """No temperature anywhere."""
        return heat_of(self.laws, self.body, np.zeros(len(self.body)), np.zeros(len(self.body)))

    @property
    def internal(self) -> bool:
        """Whether some cells have internal modes."""
        return any(group.internal for group in self.groups)

    @property
    def heat_works(self) -> bool:
        """Whether temperature does work on plastic strain: its volume is kept, but not its area, nor that of modes."""
        return self.laws.thin or self.internal

    def strains(self, u: Array, plastic: Array | None = None, heat: Heat | None = None) -> Array:
        """(p, n) Strains of displacements; in plane stress without that across.

        Parameters
        ----------
        u : (dofs,) displacements
        plastic : (p, n) plastic strains that internal modes are in balance with; none where nothing has flowed
        heat : whose strains they are in balance with; none without temperatures
        """
        found = np.zeros((len(self.body), self.components))
        for group in self.groups:
            own = group.own
            kernels.add_strains(group.cells, group.gradients, u, self.space.components, found[own])
            if group.internal:
                free = np.zeros_like(found[own]) if plastic is None else plastic[own].copy()
                if heat is not None:
                    free[:, :3] += heat.swelling[own, None] / 3.0
                for _ in range(_MODE_ROUNDS):
                    group.add_mode_strains(
                        group.amplitudes(self._elastic_stress(self.body[own], free - found[own])), found[own]
                    )
        return found

    def dilatation(self, strain: Array) -> Array:
        """(p,) Volume strain of strains (p, n) as the stiffness sees it: projected in cells with a mean dilatation."""
        volume: Array = strain[:, :3].sum(axis=1)
        for group in self.groups:
            if group.group.formulation == "mean dilatation":
                functions, here = group.group.block.pressures, volume[group.own].reshape(group.weights.shape)
                volume[group.own] = mean_in_cells(group.weights, functions, here, functions).ravel()
        return volume

    def respond(self, u: Array, old: PlasticState, heat: Heat) -> PlasticResponse:
        """Backward Euler at every point.

        Parameters
        ----------
        u : (dofs,) displacements
        old : the state that the points come from
        heat : see `heat`
        """
        before = self._points(old, self.strains(u, old.strain, heat))
        shape = before.strain.shape
        after = Points(
            strain=before.strain,
            plastic=np.empty(shape),
            equivalent=np.empty(shape[0]),
            back=np.empty_like(old.back),
            direction=np.empty(shape),
            slack=np.empty((shape[0], 2)),
            yields=np.empty(shape[0], np.bool_),
        )
        radial_return.respond(self.laws, self.body, heat, before, after)
        for group in self.groups:
            if group.internal:
                own = group.own
                here = before.part(own), after.part(own)
                settle(self.laws, self.body[own], heat.part(own), self.elasticity, group.weights, group.modes, *here)
        forces = self.forces(after.plastic)
        state = PlasticState(strain=after.plastic, equivalent=after.equivalent, back=after.back, forces=forces)
        return PlasticResponse(state=state, points=after, dual=after.direction)

    def with_dual(
        self,
        response: PlasticResponse,
        old: PlasticState,
        heat: Heat,
        *,
        model: PlasticResponse,
        reached: PlasticResponse,
    ) -> PlasticResponse:
        """A response with the relative stresses of the linear model that led to it.

        Parameters
        ----------
        response : where the history of the rounds goes on
        old : the state that the points come from
        heat : at their end
        model : what the linear model was made at
        reached : at the displacements that the linear model reaches, which may be farther
        """
        dual = np.empty_like(response.dual)
        before = self._points(old, reached.points.strain)
        end = reached.points._replace(equivalent=response.points.equivalent)
        linearised.dual_stress(self.laws, self.body, heat.level, before, model.points, model.dual, end, dual)
        return PlasticResponse(state=response.state, points=response.points, dual=dual)

    def at_rest(self, u: Array, old: PlasticState, heat: Heat) -> PlasticResponse:
        """A response in which no point yields: what elastic bodies are linearised about.

        Parameters
        ----------
        u : (dofs,) displacements
        old : the state of the points
        heat : see `heat`
        """
        strain = self.strains(u, old.strain, heat)
        zero, none = np.zeros_like(strain), np.zeros(len(strain))
        points = Points(
            strain=strain,
            plastic=old.strain,
            equivalent=old.equivalent,
            back=old.back,
            direction=zero,
            slack=np.zeros((len(strain), 2)),
            yields=none.astype(np.bool_),
        )
        return PlasticResponse(state=old, points=points, dual=zero)

    def forces(self, plastic: Array) -> Array:
        """(dofs,) ``sum_q w B^T D eps_p`` of plastic strains (p, n)."""
        return self.internal_forces(self.eigenstress(plastic))

    def eigenstress(self, plastic: Array) -> Array:
        """(p, n) ``D eps_p`` of plastic strains (p, n), less what internal modes give way to."""
        stress = self._elastic_stress(self.body, plastic)
        for group in self.groups:
            if group.internal:
                given = np.zeros_like(stress[group.own])
                group.add_mode_strains(group.amplitudes(stress[group.own]), given)
                stress[group.own] -= self._elastic_stress(self.body[group.own], given)
        return stress

    def _elastic_stress(self, body: IntArray, strain: Array) -> Array:
        """(p, n) ``D eps`` of strains (p, n) at points of bodies (p,)."""
        stress = np.zeros_like(strain)
        for b in np.flatnonzero(self.laws.rows):
            own = body == b
            if own.all():
                return np.asarray(strain @ self.elasticity[b])
            stress[own] = strain[own] @ self.elasticity[b]
        return stress

    def internal_forces(self, stress: Array) -> Array:
        """(dofs,) ``sum_q w B^T sigma`` of stresses (p, n)."""
        found = np.zeros(self.space.number_of_dofs)
        for group in self.groups:
            d = self.space.components
            kernels.add_forces(group.cells, group.gradients, group.weights, stress[group.own], d, found)
        return found

    def softening(self, response: PlasticResponse, left: float = 0.0) -> Array:
        """Entries of what yielding takes off the stiffness, on the pattern of `rows`.

        Parameters
        ----------
        response : what the tangent is made at
        left : part of the elastic law that yielding leaves in place, 0 .. 1
        """
        data = np.zeros(self.space.components**2 * len(self.pattern[1]))
        for group in self.groups:
            own = group.own
            here = response.points.part(own)
            shape = group.gradients, group.weights, group.modes
            softening.soften(
                group.cells, shape, self.laws, self.body[own], here, response.dual[own], left, self.pattern, data
            )
        return data

    def rows(self) -> sp.csr_array:
        """(dofs, dofs) The pattern of `softening`, its entries numbered from 1."""
        indptr, indices = assembly.unknown_pattern(*self.pattern, self.space.components)
        dofs = self.space.number_of_dofs
        full = np.concatenate([indptr, np.full(dofs + 1 - len(indptr), indptr[-1], indptr.dtype)])
        return sp.csr_array((np.arange(1.0, len(indices) + 1.0), indices, full), shape=(dofs, dofs))

    def _points(self, old: PlasticState, strain: Array) -> Points:
        """A committed state as compiled loops read it."""
        none = np.zeros(0)
        return Points(
            strain=strain,
            plastic=old.strain,
            equivalent=old.equivalent,
            back=old.back,
            direction=none.reshape(0, 0),
            slack=none.reshape(0, 0),
            yields=none.astype(np.bool_),
        )


def yielding_bodies(space: Space, model: Model) -> YieldingBodies:
    """The points of the bodies of a model that yield.

    Parameters
    ----------
    space, model : the mesh and what is on it; at least one body yields
    """
    elasticity = elasticities(model)
    groups = tuple(point_groups(space, model, elasticity))
    body = np.concatenate([np.repeat(group.group.body, group.weights.shape[1]) for group in groups])
    sizes = np.concatenate([[0], *(np.full(len(group.cells), group.cells.shape[1]) for group in groups)])
    corner = np.concatenate([group.cells.ravel() for group in groups]).astype(np.int32)
    pattern = assembly.node_pattern(np.cumsum(sizes).astype(np.int64), corner, len(space.mesh.points))
    return YieldingBodies(
        space=space,
        model=model,
        groups=groups,
        laws=yield_laws(model),
        body=body.astype(np.int64),
        elasticity=elasticity,
        pattern=pattern,
    )

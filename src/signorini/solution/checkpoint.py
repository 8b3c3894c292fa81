# SPDX-License-Identifier: BSD-3-Clause
"""The end of a history, from which another goes on."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from signorini.arrays import BoolArray, IntArray
from signorini.errors import InputError
from signorini.interface.interface import Interface
from signorini.model.material import Elastic
from signorini.model.mesh import Mesh
from signorini.model.model import Model
from signorini.model.plastic import Plastic
from signorini.model.stage import Standing
from signorini.short import Short
from signorini.solution.scale import Loading
from signorini.solution.state import State

_WHERE = ("start",)

_DIGESTS: WeakKeyDictionary[Mesh, str] = WeakKeyDictionary()
"""Of meshes that were asked for one: nobody edits a mesh, and every solve asks."""

_POSED = {
    "gap": "the initial gap {}",
    "anisotropy": "the ratios of friction {}",
    "facets": "{} facets",
    "normal_compliance": "the normal compliance {}",
    "tangential_compliance": "the tangential compliance {}",
    "tied": "a tie ({})",
    "area": "the area {}",
    "normals": "the normal {}",
    "tangents": "the tangent {}",
}
"""What of an interface a state refers to, in words; parameters of its friction are said by their names."""

_ADVICE = {
    "gap": "; a step's 'interference' changes it",
    "friction": "; a step's 'friction' changes it",
    "normals": "; a plane of symmetry that lets go belongs into one run with the steps before it",
    "tangents": "; a plane of symmetry that lets go belongs into one run with the steps before it",
}

_NUMBER_TOL = 1e-9  # of a number: what compilers of other machines may change in it
_ZERO_TOL = 1e-12  # of the size of the mesh, or of 1: a gap, or part of a unit vector, that is none


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Checkpoint(Short):
    """A state, what the steps before it have set, and what it must fit.

    Attributes
    ----------
    state : of all bodies and pairs
    standing : friction, interferences, contacts and supports as steps have left them
    loading : the most that was imposed so far
    near : (n,) pairs that could touch so far: those that the law of contact was asked of
    contacts : names of all contacts, in order
    contact, node : (n,) contact and node of every pair
    posed : of every pair what the contacts themselves say, by name of an array of
        :class:`signorini.interface.interface.Interface`
    mesh : digest of points and cells
    yields : bodies that yield, by name, with their laws
    increments : solved so far on bodies that are iterated on because that is cheaper; infinite where none are
    """

    state: State
    standing: Standing
    loading: Loading
    near: BoolArray
    contacts: tuple[str, ...]
    contact: IntArray
    node: IntArray
    posed: Mapping[str, NDArray[Any]]
    mesh: str
    yields: Mapping[str, Plastic] = field(default_factory=dict)
    increments: float = np.inf

    @staticmethod
    def of(
        model: Model,
        interface: Interface,
        state: State,
        standing: Standing,
        loading: Loading,
        near: BoolArray,
        increments: float = np.inf,
    ) -> Checkpoint:
        """Of a state on the interface of a model.

        Parameters
        ----------
        model, interface, state : the model, its n pairs and where they stand
        standing, loading : what steps have set, and the most that was imposed so far
        near : (n,) pairs that could touch so far
        increments : see `Checkpoint`
        """
        return Checkpoint(
            state=state,
            standing=standing,
            loading=loading,
            near=near,
            contacts=tuple(contact.label for contact in model.contacts),
            contact=interface.contact,
            node=interface.node,
            posed=_posed(interface),
            mesh=digest(model.mesh),
            yields=_yields(model),
            increments=increments,
        )

    def check(self, model: Model, interface: Interface) -> None:
        """Refuse to be the start of a model that it does not fit.

        Raises
        ------
        InputError
            What differs: the mesh, the number of moving obstacles, the contacts, what one of them says, how a body
            yields, or a support or load that the model lacks.
        """
        dofs = len(self.state.displacement)
        rigid = len(model.obstacles) + len(model.rigid_bodies)
        own = model.number_of_dofs + 2 * model.components * rigid
        if dofs != own or self.mesh != digest(model.mesh):
            found = f"was computed on another mesh ({dofs} dofs; the model has {own})"
            raise InputError(f"{found}; expected the same mesh, moving obstacles and rigid bodies", where=_WHERE)
        labels = tuple(contact.label for contact in model.contacts)
        if self.contacts != labels:
            found, expected = (", ".join(names) or "none" for names in (self.contacts, labels))
            raise InputError(f"has the contacts {found}; the model has {expected}, expected the same", where=_WHERE)
        if not np.array_equal(self.node, interface.node) or not np.array_equal(self.contact, interface.contact):
            raise InputError("pairs other nodes than the model; expected the same contact surfaces", where=_WHERE)
        for words in self._contradictions(model, interface):
            raise InputError(words, where=_WHERE)
        for words in self._other_laws(model):
            raise InputError(words, where=_WHERE)
        strange = self.standing.released - {support.label for support in model.supports}
        if strange:
            raise InputError(f"has released '{min(strange)}'; expected a support of that name", where=_WHERE)
        for name, factor in self.state.point.factors.items():
            if factor and name not in model.scaled_names:
                raise InputError(
                    f"carries '{name}' at factor {factor:g}, which the model has not; expected a load or "
                    "moving support of that name",
                    where=_WHERE,
                )

    def _contradictions(self, model: Model, interface: Interface) -> Iterator[str]:
        """What the contacts of the model say otherwise, in words."""
        if not len(interface):
            return
        size, now = float(np.ptp(model.mesh.points, axis=0).max()), _posed(interface)
        lacking = np.full(len(interface), np.nan)
        for name in dict.fromkeys([*now, *self.posed]):
            words = _POSED.get(name, f"the {name.replace('_', ' ')} {{}}")
            old, new = self.posed.get(name, lacking), now.get(name, lacking)
            if old.dtype.kind == "f":
                atol = _ZERO_TOL * (size if name == "gap" else 1.0)
                same = np.isclose(old, new, rtol=_NUMBER_TOL, atol=atol, equal_nan=True)
            else:
                same = old == new
            other = np.flatnonzero(~same.reshape(len(same), -1).all(axis=1))
            if len(other):
                i = int(other[0])
                found, expected = (words.format(_spelled(part[i])) for part in (old, new))
                label = self.contacts[self.contact[i]]
                yield (
                    f"has {found} at node {model.mesh.labels[self.node[i]]} of contact '{label}'; the model has "
                    f"{expected}, expected the same{_ADVICE.get(name, '')}"
                )

    def _other_laws(self, model: Model) -> Iterator[str]:
        """Bodies that yield otherwise in the model, in words."""
        now = _yields(model)
        for body in dict.fromkeys([*self.yields, *now]):
            old, new = self.yields.get(body), now.get(body)
            if old != new:
                found, expected = ("does not yield" if law is None else str(law) for law in (old, new))
                model_words = f"in the model it {expected}" if expected != found else "in the model its law is another"
                yield f"has a body '{body}' that {found}; {model_words}, expected the same law"


def _posed(interface: Interface) -> dict[str, NDArray[Any]]:
    """What contacts say of their pairs."""
    closure = {} if interface.closure is None else interface.closure.parameters
    bonds = {} if interface.cohesion is None else interface.cohesion.parameters
    return interface.friction.parameters | closure | bonds | {name: getattr(interface, name) for name in _POSED}


def _yields(model: Model) -> dict[str, Plastic]:
    """Bodies that yield, by name, with their laws."""
    laws = {body.name: body.material.plastic for body in model.bodies if isinstance(body.material, Elastic)}
    return {name: law for name, law in laws.items() if law is not None}


def _spelled(value: Any) -> str:
    """A number, or several."""
    if np.ndim(value) == 0:
        return f"{value:.6g}" if isinstance(value, float) else str(value)
    return f"({', '.join(_spelled(part) for part in value)})"


def digest(mesh: Mesh) -> str:
    """Letters that two meshes share only if points and cells are the same.

    >>> mesh = Mesh(points=[[0, 0], [1, 0], [0, 1]], cells={"triangle": [[0, 1, 2]]}, bodies={}, boundaries={})
    >>> len(digest(mesh))
    32
    """
    known = _DIGESTS.get(mesh)
    if known is not None:
        return known
    found = hashlib.blake2b(np.ascontiguousarray(mesh.points).tobytes(), digest_size=16)
    for family, cells in mesh.cells.items():
        found.update(family.encode())
        found.update(np.ascontiguousarray(cells, dtype=np.int64).tobytes())
    return _DIGESTS.setdefault(mesh, found.hexdigest())

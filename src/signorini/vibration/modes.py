# SPDX-License-Identifier: BSD-3-Clause
"""Natural modes of a model about a state, each certified on the matrices as posed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from signorini.arrays import Array
from signorini.blas_threads import one_thread
from signorini.checks import choice, whole
from signorini.errors import InputError, SolveFailed
from signorini.fem.space import Space
from signorini.linalg.definite import ROUNDOFF
from signorini.model.model import Model
from signorini.model.modes import JOINTS, MOST_MODES, STUCK
from signorini.outcome import Outcome
from signorini.solution.checkpoint import Checkpoint
from signorini.solution.history import History
from signorini.solution.modes import NaturalModes
from signorini.vibration.bodies import vibrating_bodies
from signorini.vibration.eigen import Pairs, lowest
from signorini.vibration.inverse import JointInverse, ShiftedBodies, shifted
from signorini.vibration.waves import waves_of

_MODE_TOL = 1e-6  # of omega^2 + s, and of 1: residuals and products of different modes; half of it in frequencies


def natural_modes(of: Model | History, number: int, *, joint: str = STUCK, nodal_diameters: int = 0) -> NaturalModes:
    """The lowest natural modes of bodies as they are drawn, or about the end of a history.

    Parameters
    ----------
    of : a model, whose loads do not act and whose bodies may be free: pairs without a gap touch; or a solution: those
        touch that do at its end, under the supports that hold there
    number : of modes
    joint : "stuck" (pairs that touch move as one), "slipping" (they stay closed), or "open"
    nodal_diameters : of a cyclic sector: h waves around the ring, ``u(R x) = exp(2 pi i h / N) R u(x)``, up to half the
        number of sectors; 0: all sectors move alike

    Raises
    ------
    InputError
        If a body has no density, the history finished no step, there are fewer modes, or the model has something that
        modes do not know: contacts that slide far, rigid obstacles that move freely.
    SolveFailed
        If the modes found fail their certificate.

    Examples
    --------
    >>> import signorini as sg
    >>> bar = sg.Model(sg.rectangle(width=1.0, height=0.1, nx=20), kind="plane stress",
    ...                bodies=[sg.Body("block", sg.Elastic(E=1.0, nu=0.0, density=1.0))],
    ...                supports=[sg.Support("left", u=(0, None)), sg.Support("bottom", u=(None, 0))])
    >>> sg.natural_modes(bar, 2).frequencies.round(2)  # of a bar (2 k - 1) / 4
    array([0.25, 0.75])
    """
    if isinstance(of, Model):
        return modes_by_joint(of, number, (joint,), diameters=nodal_diameters)[joint]
    if of.end is None:
        raise InputError("has finished no step; there is no state to vibrate about", where=("of",))
    return modes_by_joint(of.model, number, (joint,), of.end, diameters=nodal_diameters)[joint]


@one_thread()
def modes_by_joint(
    model: Model, number: int, joints: Sequence[str], end: Checkpoint | None = None, *, diameters: int = 0
) -> dict[str, NaturalModes]:
    """The lowest modes by state of the joints; one factorisation serves all of them.

    Parameters
    ----------
    model : the model
    number : of modes
    joints : of :data:`signorini.model.modes.JOINTS`
    end : of a history of the model, about whose state the bodies vibrate; None: as they were drawn
    diameters : nodal diameters, see `natural_modes`

    Raises
    ------
    InputError
        See :func:`signorini.vibration.bodies.vibrating_bodies`; or there are fewer modes.
    SolveFailed
        If the modes found fail their certificate.
    """
    whole(number, ("number",), most=MOST_MODES)
    for joint in joints:
        choice(joint, JOINTS, ("joint",), "state of the joints")
    whole(diameters, ("nodal_diameters",), least=0)
    ready = shifted(waves_of(model, diameters, end) if diameters else vibrating_bodies(model, end))
    return {joint: _of_joint(ready, joint, number) for joint in joints}


def _of_joint(ready: ShiftedBodies, joint: str, number: int) -> NaturalModes:
    inverse = JointInverse.of(ready, joint)
    copies = ready.bodies.copies
    (squares, vectors), missed = lowest(inverse, copies * number)
    pairs = squares[::copies], vectors[:, ::copies]  # of the two that are a quarter of a wave apart the first
    modes = _measured(inverse, joint, pairs, missed)
    worst = max(float(modes.residuals.max()), modes.orthogonality, modes.parting)
    if not worst <= _MODE_TOL or missed:
        raise SolveFailed(
            f"modes of the {joint} joint are not certified: residual {modes.residuals.max():.1e}, orthogonality "
            f"{modes.orthogonality:.1e}, parting {modes.parting:.1e}, {missed or 'none'} missed",
            status=Outcome.NOT_FOUND,
        )
    return modes


def _measured(inverse: JointInverse, joint: str, pairs: Pairs, missed: int | None) -> NaturalModes:
    """Modes with Rayleigh's quotients of their shapes, and what certifies them."""
    ready, vectors = inverse.shifted, pairs[1]
    bodies, K, space = ready.bodies, inverse.K, ready.bodies.space
    on_mass, on_stiffness = bodies.M @ vectors, K @ vectors
    vectors, on_mass, on_stiffness = (
        part / np.sqrt(np.einsum("ij,ij->j", vectors, on_mass)) for part in (vectors, on_mass, on_stiffness)
    )
    squares = np.einsum("ij,ij->j", vectors, on_stiffness)
    rounding = ROUNDOFF * np.einsum("ij,ij->j", np.abs(vectors), abs(K) @ np.abs(vectors))
    squares = np.where(squares <= rounding, 0.0, squares)
    left = on_stiffness - squares * on_mass
    left += inverse.ties.B.T @ inverse.ties.forces(left)
    residuals = np.sqrt(np.abs(np.einsum("ij,ij->j", left, inverse(left))) / (squares + ready.shift))
    products = np.abs(vectors.T @ on_mass - np.eye(len(squares)))
    held = bodies.rows(joint)
    parting = np.abs(bodies.B[held[bodies.compliance.ravel()[held] == 0.0]] @ vectors).max(axis=0, initial=0.0)
    u = bodies.constraints.transform @ (vectors * _signs(vectors))
    order = np.argsort(squares, kind="stable")
    return NaturalModes(
        joint=joint,
        squares=squares[order],
        shapes=_at_nodes(u, space, bodies.copies)[order],
        forces=_at_nodes(bodies.mass @ u, space, bodies.copies)[order],
        residuals=residuals[order],
        orthogonality=float(products.max(initial=0.0)),
        parting=float((parting / np.abs(vectors).max(axis=0)).max()),
        missed=missed,
    )


def _signs(vectors: Array) -> Array:
    """(k,) By which shapes are turned so that their largest entries are positive."""
    largest = vectors[np.abs(vectors).argmax(axis=0), np.arange(vectors.shape[1])]
    return np.where(largest < 0.0, -1.0, 1.0)


def _at_nodes(values: Array, space: Space, copies: int) -> Array:
    """(k, nodes, c) Of dofs (copies dofs, k), without those of what is rigid; complex where there are two copies."""
    real, *imaginary = (part[: space.dofs_of_nodes] for part in np.split(values, copies))
    both = real + 1j * imaginary[0] if imaginary else real
    return np.ascontiguousarray(both.T.reshape(-1, len(space.mesh.points), space.components))

# SPDX-License-Identifier: BSD-3-Clause
"""The paper's method from a model: its M and q for whoever wants them, and its answer with a certificate."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg

from signorini import lcp
from signorini.arrays import Array
from signorini.checks import number
from signorini.engine.condensation import reduced_bodies
from signorini.engine.increments import applied
from signorini.engine.prepare import Prepared, prepare
from signorini.errors import InputError
from signorini.friction.paper import PaperProblem, paper_problem
from signorini.law.states import OPEN, SLIP_MINUS, SLIP_PLUS, STICK
from signorini.linalg.registry import factorise
from signorini.model.model import Model
from signorini.short import Short
from signorini.solution.certificate import Certificate, certify
from signorini.solution.state import LoadPoint, initial_state, next_state


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class PaperFormulation(Short):
    """The paper's LCP of a model: all loads at their final factors, one increment.

    Attributes
    ----------
    problem : M, q and the recovery of displacements and tractions
    E_n, E_tau : penalties, pressure per length
    prepared : the model, condensed
    """

    problem: PaperProblem
    E_n: float
    E_tau: float
    prepared: Prepared

    @property
    def M(self) -> Array:
        """(3 n, 3 n) matrix of the LCP."""
        return self.problem.M

    @property
    def q(self) -> Array:
        """(3 n,) vector of the LCP."""
        return self.problem.q


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class PaperAnswer(Short):
    """What the literal formulation gives, and how far it can be believed.

    Attributes
    ----------
    lcp : the solution of the LCP, its status included
    pressure, traction : (n,) contact pressure (positive compressive) and friction on the nonmortar body
    displacement : (nodes, d)
    normal_force : resultant of the pressures along the normals, (d,)
    condition : estimate of the condition number of K_c in the 1-norm
    certificate : on the law with the compliances 1 / E_n and 1 / E_tau
    message : empty where certified; otherwise why the answer must not be used
    """

    lcp: lcp.LCPSolution
    pressure: Array
    traction: Array
    displacement: Array
    normal_force: Array
    condition: float
    certificate: Certificate
    message: str

    @property
    def solved(self) -> bool:
        """Whether it may be used."""
        return not self.message


def formulate(model: Model | Prepared, *, E_n: float, E_tau: float) -> PaperFormulation:
    """Build the paper's LCP ``nu = M lambda + q`` of a model.

    Parameters
    ----------
    model : its loads count with their factors at the end of the last step; compliances of its contacts must be 0
    E_n, E_tau : penalties, pressure per length, > 0

    Raises
    ------
    InputError
        If a body yields, the model has no contact, a contact sticks or is compliant, or a penalty is not positive.

    References
    ----------
    Zhu Changming, A linear complementarity method for elastic contact problems based on the principle of virtual
    work, Shanghai Jiao Tong University (1993), equations (33)-(37).
    """
    prepared = model if isinstance(model, Prepared) else prepare(model)
    E_n, E_tau = number(E_n, ("E_n",), above=0.0), number(E_tau, ("E_tau",), above=0.0)
    for i, body in enumerate(prepared.model.bodies):
        if body.material.yields:
            raise InputError(f"'{body.name}' yields; the paper's bodies are elastic", where=("body", i, "material"))
    for i, contact in enumerate(prepared.model.contacts):
        supple = contact.normal_compliance or contact.tangential_compliance or contact.closure or contact.cohesion
        if contact.friction in ("stick", "tied") or supple:
            raise InputError("the paper's law has a finite friction and its own penalties", where=("contact", i))
        if contact.wear is not None:
            raise InputError("the paper's sides do not wear; expected none", where=("contact", i, "wear"))
        if not contact.coulomb:
            raise InputError("the paper's law is Coulomb's, without adhesion or shear limit", where=("contact", i))
    interface, condensed = prepared.interface, prepared.paths.condensed
    if not condensed.active.any():
        raise InputError("there is none that can move; the paper's LCP needs one", where=("contact",))
    loads, imposed = applied(prepared, _full_load(prepared))
    pairs = np.flatnonzero(condensed.active)
    order = np.arange(2 * len(pairs)).reshape(2, -1)[::-1].T.ravel()  # (tau, n) pair by pair
    offset = interface.motion(imposed)
    offset[0] += interface.gap
    f = prepared.constraints.transform.T @ (loads - prepared.K @ imposed)
    try:
        problem = paper_problem(
            factorise(reduced_bodies(prepared, prepared.K), condensed.dofs).schur(),
            condensed.B.toarray()[order],
            condensed.reduce(f).load,
            offset[:, pairs].ravel()[order],
            interface.friction.steepest[pairs],
            interface.area[pairs],
            E_tau=E_tau,
            E_n=E_n,
        )
    except np.linalg.LinAlgError as error:
        raise InputError(
            f"with E_n = {E_n:g}, E_tau = {E_tau:g} K_c is not positive definite in double precision; "
            "expected smaller penalties, or the exact law"
        ) from error
    return PaperFormulation(problem=problem, E_n=E_n, E_tau=E_tau, prepared=prepared)


def solve_literally(formulation: PaperFormulation) -> PaperAnswer:
    """Solve the paper's LCP by Lemke's method, recover displacements and tractions, and certify them.

    The answer is returned in any case, with its certificate: this is how the loss of accuracy at large penalties is
    seen. ``solved`` and ``message`` say whether it may be used. Where the LCP is not solved, all multipliers are 0.
    """
    prepared, problem = formulation.prepared, formulation.problem
    interface, condensed = prepared.interface, prepared.paths.condensed
    n, pairs = len(interface), np.flatnonzero(condensed.active)
    # large penalties leave rounding in M itself; how much is too much the certificate says, on the law
    found = lcp.solve(problem.M, problem.q, method=lcp.Lemke(covering=problem.covering), tolerance=1e-3)
    condition = _condition(prepared, problem, formulation)
    multipliers = np.zeros(3 * len(pairs)) if found.z is None else found.z
    u, P = problem.recover(multipliers)
    forces, moved = np.zeros((2, n)), np.zeros((2, n))
    forces[:, pairs] = -P[:, ::-1].T * interface.area[pairs]
    slip = multipliers.reshape(-1, 3)
    moved[:, pairs] = slip[:, 2], slip[:, 0] - slip[:, 1]
    loads, imposed = applied(prepared, _full_load(prepared))
    f = prepared.constraints.transform.T @ (loads - prepared.K @ imposed)
    displacement = prepared.constraints.transform @ condensed.reduce(f).expand(u) + imposed
    status = np.full(n, OPEN)
    closed = np.where(slip[:, 0] > 0, SLIP_MINUS, np.where(slip[:, 1] > 0, SLIP_PLUS, STICK))
    status[pairs] = np.where(slip[:, 2] > 0, OPEN, closed)
    before = initial_state(prepared.model.factors()[0], prepared.constraints.zeros, interface)
    state = next_state(
        prepared,
        before,
        point=_full_load(prepared),
        loads=loads,
        displacement=displacement,
        forces=forces,
        moved=moved,
        status=status,
    )
    penalties = replace(
        interface,
        normal_compliance=np.full(n, 1.0 / formulation.E_n),
        tangential_compliance=np.full(n, 1.0 / formulation.E_tau),
    )
    penalised = replace(prepared, interface=penalties)
    certificate = certify(penalised, state, loads=loads, before=before.tangential)
    return PaperAnswer(
        lcp=found,
        pressure=forces[0] / interface.area,
        traction=forces[1] / interface.area,
        displacement=prepared.space.at_nodes(displacement),
        normal_force=forces[0] @ interface.normals,
        condition=condition,
        certificate=certificate,
        message=_judge(found, certificate, condition),
    )


def _condition(prepared: Prepared, problem: PaperProblem, formulation: PaperFormulation) -> float:
    """``|K_c|_1 |K_c^-1|_1``, the second factor estimated through the factorised bodies."""
    condensed, interface, T = prepared.paths.condensed, prepared.interface, prepared.constraints.transform
    n = len(interface)
    penalty = np.concatenate([np.full(n, formulation.E_n), np.full(n, formulation.E_tau)]) * np.tile(interface.area, 2)
    B = interface.B @ T
    K_c = T.T @ prepared.K @ T + B.T @ sp.diags_array(penalty) @ B

    def solve(b: Array) -> Array:
        reduced = condensed.reduce(b)
        return reduced.expand(problem.solve(reduced.load))

    inverse = scipy.sparse.linalg.LinearOperator(K_c.shape, matvec=solve, rmatvec=solve, matmat=solve, dtype=float)
    return float(abs(K_c).sum(axis=0).max() * scipy.sparse.linalg.onenormest(inverse))


def _judge(found: lcp.LCPSolution, certificate: Certificate, condition: float) -> str:
    if not found.solved:
        return f"the LCP was not solved: {found.message}"
    if certificate.passed:
        return ""
    return (
        f"not certified: violations up to {certificate.worst:.0e}, condition number of K_c {condition:.0e}; expected "
        "smaller penalties, or the exact law"
    )


def _full_load(prepared: Prepared) -> LoadPoint:
    """The end of the history; the paper goes there in one increment."""
    gap = prepared.interface.gap
    return LoadPoint(factors=prepared.model.factors()[-1], gap=gap, given=np.zeros((2, len(gap))))

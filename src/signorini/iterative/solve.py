# SPDX-License-Identifier: BSD-3-Clause
"""The method of multipliers with a semismooth Newton inside: contact on the bodies as they are.

Trial forces ``y = E (r - D (B z + h_0))`` are projected on the law, Pi, with the friction bounds of the round before.
With ``E = (1 + D C)^-1`` a compliance C in series is exact. Rounds repeat

    K z = f + B' Pi(y(z)),    r <- Pi(y),    bound <- F(r_n), in Coulomb's law mu r_n

where the first, the minimum of a convex energy, is approached by Newton steps, symmetric positive definite systems
that conjugate gradients solve no further than the rest of the round deserves. A fixed point is a solution of the
contact problem as posed, whatever D. Only the bound's lag is not a minimisation: for friction far above the usual it
need not converge.

A round gains a digit. So after the first one Newton's method is tried on equilibrium and law together
(`iterative.whole_newton`), whose systems gain three digits each once no state changes; where it gets nowhere, rounds go
on from where they were.

References
----------
Alart, Curnier (1991), A mixed formulation for frictional contact problems, CMAME 92:353-375.
Rockafellar (1976), Augmented Lagrangians and applications of the proximal point algorithm, Math. Oper. Res. 1:97-116.
"""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array
from signorini.iterative.pressed import IncrementLoad, PressedBodies
from signorini.iterative.rounds import MultiplierRounds
from signorini.iterative.whole_newton import newton_on_all
from signorini.law.result import ContactAnswer

_STILL_FALLS = 0.9  # of the least residual: what a round leaves of it where another one is worth it


def solve_iteratively(
    bodies: PressedBodies, load: IncrementLoad, z: Array, forces: Array
) -> tuple[ContactAnswer, Array]:
    """Solve one increment: the answer of the pairs, tied ones too, in their own units, and (b,) displacements.

    Parameters
    ----------
    bodies, load : what is pressed, and by what
    z : (b,) displacements to start from
    forces : (d, a) of the pairs, to start from
    """
    rounds = MultiplierRounds(bodies, load, z, forces)
    worst, best = np.inf, [np.inf]
    for number in range(load.rounds):
        rounds.newton()
        worst = rounds.update()
        if number == 0 and worst > load.tolerance and bodies.whole:
            newton_on_all(rounds)
            worst = rounds.update()
        best.append(min(worst, best[-1]))
        as_good_as_it_gets = worst <= bodies.aim or worst > _STILL_FALLS * best[-2]
        if (worst <= load.tolerance and as_good_as_it_gets) or not np.isfinite(worst):
            break
        if sum(rounds.iterations) > load.most:
            break
        if len(best) > bodies.patience and best[-1] > 0.5 * best[-1 - bodies.patience]:
            break
    return rounds.answer(worst)

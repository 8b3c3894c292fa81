# SPDX-License-Identifier: BSD-3-Clause
"""The Python door to models that are factorised once and solved many times."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from signorini.api import dressed, tell_first_solve
from signorini.clock import Clock
from signorini.derivative.function import AnswerFunction
from signorini.engine.prepare import Prepared
from signorini.engine.prepare import prepare as prepare_model
from signorini.engine.solve import solve_prepared
from signorini.model.model import Model
from signorini.model.outputs import Output
from signorini.settings import SolverSettings
from signorini.solved import Solution


class PreparedModel:
    """A model factorised once, for many loads, friction coefficients and interferences; see :func:`prepare`."""

    def __init__(self, prepared: Prepared) -> None:
        self._prepared = prepared

    def __repr__(self) -> str:
        return f"PreparedModel({self._prepared.model.title or 'untitled'}, back end {self._prepared.backend})"

    def solve(
        self,
        *,
        friction: float | Mapping[str, float] | None = None,
        interference: float | Mapping[str, float] | None = None,
        loads: Mapping[str, float] | None = None,
        raise_on_failure: bool = True,
    ) -> Solution:
        """Solve the load history, with another law or load where given.

        Nothing is factorised again that was for any of the last few histories: other supports, or loads that reach
        more than twice as far, are factorised once.

        Parameters
        ----------
        friction, interference : one number for every contact, or contact to number
        loads : load or moving support to what its value is multiplied by
        raise_on_failure : see :func:`solve`

        Raises
        ------
        InputError, SolveFailed
            As :func:`solve`.
        """
        changed = self._prepared.changed(
            friction=self._by_contact(friction), interference=self._by_contact(interference), loads=loads
        )
        return dressed(solve_prepared(changed, raise_on_failure=False), raise_on_failure)

    def function(self, inputs: Sequence[str], outputs: Sequence[Output]) -> AnswerFunction:
        """Outputs as a function of inputs, with its derivatives: ``values, vjp = f(x)``.

        Parameters
        ----------
        inputs : ``"friction.contact"``, ``"load.name"``, ``"gap.contact"`` (one number a node), ``"E.body"``, ...
        outputs : ``sg.pressure("contact").peak``, ...

        Examples
        --------
        >>> import signorini as sg
        >>> from signorini.gallery.cylinder import zhu_cylinder
        >>> f = prepare(zhu_cylinder()).function(["load.cut"], [sg.force("foundation", along=(0, 1))])
        >>> values, vjp = f([0.5])
        >>> values.round(9), vjp([1.0]).round(9)
        (array([39.]), array([78.]))
        """
        return AnswerFunction(self._prepared, inputs, outputs)

    def _by_contact(self, value: float | Mapping[str, float] | None) -> Mapping[str, float] | None:
        if value is None or isinstance(value, Mapping):
            return value
        return {contact.label: value for contact in self._prepared.model.contacts}


def prepare(
    model: Model, *, backend: str = "auto", settings: SolverSettings | None = None, clock: Clock | None = None
) -> PreparedModel:
    """Assemble and condense a model once, to solve it many times.

    Parameters
    ----------
    model : the problem
    backend : of the sparse factorisation, "auto" or a name
    settings : limits of the methods that solve contact
    clock : counts the seconds and tells progress

    Raises
    ------
    InputError
        If the model is wrong; a body that nothing holds is named with its free motion.

    Examples
    --------
    >>> from signorini.gallery.cylinder import zhu_cylinder
    >>> prepared = prepare(zhu_cylinder())
    >>> for mu in (0.0, 0.4):
    ...     print(mu, prepared.solve(friction=mu).contact("foundation").pressure[0].round(2))
    0.0 36.15
    0.4 38.02
    >>> light = prepared.solve(friction=0.0, loads={"cut": 0.25})
    >>> print(light.contact("foundation").normal_force[1].round(9))
    19.5
    """
    tell_first_solve()
    return PreparedModel(prepare_model(model, backend=backend, settings=settings, clock=clock).keeping())

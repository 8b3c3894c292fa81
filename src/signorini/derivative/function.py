# SPDX-License-Identifier: BSD-3-Clause
"""A prepared model as a function of some of its parameters, with its derivatives: for optimisers and other programs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array
from signorini.derivative.derivative import Derivative
from signorini.derivative.functionals import value
from signorini.derivative.modulus_pairs import with_material
from signorini.derivative.parameters import given_value, names_of, split
from signorini.derivative.step_friction import coefficients
from signorini.derivative.taped_history import TapedHistory
from signorini.engine.prepare import Prepared, prepare
from signorini.engine.solve import solve_prepared
from signorini.engine.tape import Tape
from signorini.errors import InputError
from signorini.model.outputs import Output, WeightedSum

_CHANGED = {"friction": "friction", "interference": "interference", "load": "loads", "support": "loads"}
_MATERIAL = ("E", "nu", "expansion")


class AnswerFunction:
    """Answers as a function of parameters: ``values, vjp = f(x)``, ``f.values(x)``, ``f.jacobian(x)``.

    Coefficients of friction, interferences, factors of loads and supports, and gaps are changed on the factorisation
    that is there; for materials the bodies are factorised anew. The last history is kept.

    Parameters
    ----------
    prepared : the model
    inputs : parameters, ``kind.name``, of which "gap.contact" is one number for each of its nodes, on top of what is
        given; loads and supports are factors
    outputs : what is asked

    Attributes
    ----------
    start : (n,) the parameters as the model has them
    """

    def __init__(self, prepared: Prepared, inputs: Sequence[str], outputs: Sequence[Output]) -> None:
        self._prepared, self.inputs, self.outputs = prepared, tuple(inputs), tuple(outputs)
        self._parts = [split(name) for name in self.inputs]
        found = [self._given(kind, name) for kind, name in self._parts]
        self._ends = np.cumsum([len(part) for part in found])[:-1]
        self.start = np.concatenate(found) if found else np.zeros(0)
        self._last: tuple[Array, TapedHistory] | None = None

    def __call__(self, x: ArrayLike) -> tuple[Array, Callable[[ArrayLike], Array]]:
        """The answers (m,) at parameters (n,), and what takes weights (m,) of them to derivatives (n,) of their sum.

        Raises
        ------
        InputError, SolveFailed
            As :func:`signorini.solve`, and where derivatives do not know what happens.
        """
        at = np.array(x, dtype=np.float64)
        history = self._history(at)

        def vjp(weights: ArrayLike) -> Array:
            chosen = zip(np.asarray(weights, dtype=np.float64), self.outputs, strict=True)
            parts = tuple((float(weight), output) for weight, output in chosen if weight)
            return self._gradient(history, at, WeightedSum(parts=parts)) if parts else np.zeros(len(at))

        return np.array([value(output, history.view) for output in self.outputs]), vjp

    def values(self, x: ArrayLike) -> Array:
        """(m,) The answers at parameters (n,)."""
        return self(x)[0]

    def jacobian(self, x: ArrayLike) -> Array:
        """(m, n) The derivatives of the answers at parameters (n,); at those of the last values nothing is solved."""
        at = np.array(x, dtype=np.float64)
        history = self._history(at)
        return np.array([self._gradient(history, at, output) for output in self.outputs])

    def _given(self, kind: str, name: str) -> Array:
        """What the model has of a parameter."""
        known, model = names_of(self._prepared, kind), self._prepared.model
        by_step = kind == "friction" and name in coefficients(model)
        if name not in known or by_step or kind in ("adhesion", "shear_limit"):
            raise InputError(f"'{kind}.{name}' is no input that can change", where=("inputs",))
        if kind == "gap":
            own = [contact.label for contact in model.contacts].index(name)
            return np.zeros(int((self._prepared.interface.contact == own).sum()))
        given = given_value(self._prepared, kind, name)
        if not np.isfinite(given):
            raise InputError(f"'{kind}.{name}' is not one number", where=("inputs",))
        return np.array([given])

    def _history(self, x: Array) -> TapedHistory:
        """The history at parameters, the last one where they are its own."""
        if x.shape != self.start.shape:
            raise InputError(f"has shape {x.shape}; expected {self.start.shape}", where=("x",))
        if self._last is None or not np.array_equal(self._last[0], x):
            tape = Tape()
            solve_prepared(self._changed(x), tape=tape)
            self._last = x.copy(), TapedHistory(tape, self._prepared.model)
        return self._last[1]

    def _changed(self, x: Array) -> Prepared:
        """The model with parameters (n,)."""
        given: dict[str, dict[str, float]] = {}
        model, gap = self._prepared.model, self._prepared.interface.gap.copy()
        for (kind, name), part in zip(self._parts, np.split(x, self._ends), strict=True):
            if kind in _MATERIAL:
                body = [body.name for body in model.bodies].index(name)
                model = with_material(model, body, **{kind: float(part[0])})
            elif kind == "gap":
                own = [contact.label for contact in model.contacts].index(name)
                gap[self._prepared.interface.contact == own] += part
            else:
                given.setdefault(_CHANGED[kind], {})[name] = float(part[0])
        now = self._prepared
        if model is not now.model:
            now = prepare(model, backend=now.backend, settings=now.settings)
            gap += now.interface.gap - self._prepared.interface.gap
        now = replace(now, interface=replace(now.interface, gap=gap))
        return now.changed(**given)

    def _gradient(self, history: TapedHistory, x: Array, output: Output) -> Array:
        """(n,) The derivatives of an output at the history of parameters (n,)."""
        derivative = Derivative(history, output)
        found = []
        for (kind, name), part in zip(self._parts, np.split(x, self._ends), strict=True):
            if kind == "gap":
                found.append(derivative.gap[name])
                continue
            if kind in ("load", "support") and not part[0]:
                raise InputError(f"the factor of '{name}' is 0; its derivative is not known there", where=("x",))
            by = derivative.by(f"{kind}.{name}")
            found.append(np.array([by / part[0] if kind in ("load", "support") else by]))
        return np.concatenate(found)

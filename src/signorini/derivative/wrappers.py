# SPDX-License-Identifier: BSD-3-Clause
"""Functions of prepared models for JAX and PyTorch, which are no part of an installation."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np

from signorini.derivative.function import AnswerFunction
from signorini.errors import InputError


def jax(function: AnswerFunction) -> Any:
    """The function for JAX: a callable of an array (n,) that gives (m,), differentiable once backwards.

    Numbers have 7 digits unless ``jax.config.update("jax_enable_x64", True)`` was called.

    Raises
    ------
    InputError
        Where JAX is not installed.
    """
    library = _library("jax")

    def shape(count: int) -> Any:
        return library.ShapeDtypeStruct((count,), library.numpy.result_type(float))

    def values(x: Any) -> Any:
        return library.pure_callback(lambda at: function.values(np.asarray(at)), shape(len(function.outputs)), x)

    def pulled(x: Any, weights: Any) -> tuple[Any]:
        def vjp(at: Any, given: Any) -> Any:
            return function(np.asarray(at))[1](np.asarray(given))

        return (library.pure_callback(vjp, shape(len(function.start)), x, weights),)

    wrapped = library.custom_vjp(values)
    wrapped.defvjp(lambda x: (values(x), x), pulled)
    return wrapped


def torch(function: AnswerFunction) -> Any:
    """The function for PyTorch: a callable of a tensor (n,) of 64-bit numbers that gives one (m,).

    Raises
    ------
    InputError
        Where PyTorch is not installed.
    """
    library = _library("torch")

    class Answers(library.autograd.Function):  # type: ignore[misc, name-defined]
        """Answers, and what comes back through them."""

        @staticmethod
        def forward(ctx: Any, x: Any) -> Any:
            """The answers."""
            found, ctx.vjp = function(x.detach().numpy())
            return library.from_numpy(found)

        @staticmethod
        def backward(ctx: Any, weights: Any) -> Any:
            """The derivatives of their weighted sum."""
            return library.from_numpy(ctx.vjp(weights.numpy()))

    return Answers.apply


def _library(name: str) -> Any:
    try:
        return importlib.import_module(name)
    except ImportError:
        raise InputError(f"'{name}' is not installed; 'pip install {name}' brings it") from None

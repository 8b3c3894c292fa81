# SPDX-License-Identifier: BSD-3-Clause
"""Functions of prepared models for JAX and PyTorch, which are no part of an installation."""

from __future__ import annotations

import importlib
from collections.abc import Callable
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

    def called(answer: Callable[..., Any], count: int, *given: Any) -> Any:
        shape = library.ShapeDtypeStruct((count,), library.numpy.result_type(float))
        # one history after the other where JAX maps over several
        return library.pure_callback(answer, shape, *given, vmap_method="sequential")

    def values(x: Any) -> Any:
        return called(lambda at: function.values(np.asarray(at)), len(function.outputs), x)

    def pulled(x: Any, weights: Any) -> tuple[Any]:
        def vjp(at: Any, given: Any) -> Any:
            return function(np.asarray(at))[1](np.asarray(given))

        return (called(vjp, len(function.start), x, weights),)

    wrapped = library.custom_vjp(values)
    wrapped.defvjp(lambda x: (values(x), x), pulled)
    return wrapped


def torch(function: AnswerFunction) -> Any:
    """The function for PyTorch: a callable of a tensor (n,) that gives one (m,), differentiable once backwards.

    Numbers have as many digits as those of the tensor: 64-bit ones are meant. Derivatives of one history may differ in
    their last digits (``gradcheck(..., nondet_tol=1e-9)``): its pairs are factorised from one state to the next.

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
            found, ctx.vjp = function(x.detach().cpu().numpy())
            ctx.like = x.detach()
            return library.from_numpy(found).to(ctx.like)

        @staticmethod
        @library.autograd.function.once_differentiable  # type: ignore[untyped-decorator]
        def backward(ctx: Any, weights: Any) -> Any:
            """The derivatives of their weighted sum."""
            return library.from_numpy(ctx.vjp(weights.cpu().numpy())).to(ctx.like)

    return Answers.apply


def _library(name: str) -> Any:
    try:
        return importlib.import_module(name)
    except ImportError:
        raise InputError(f"'{name}' is not installed; 'pip install {name}' brings it") from None

# SPDX-License-Identifier: BSD-3-Clause
"""Data that vary over a body or a boundary: along a coordinate or a boundary, by a formula, at nodes or places."""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from signorini.arrays import Array, IntArray, frozen
from signorini.checks import choice, number, rows, text, vector
from signorini.errors import InputError, Where
from signorini.short import Short

_AXES = {"x": 0, "r": 0, "y": 1, "z": 1}


@dataclass(frozen=True, repr=False)
class Along(Short):
    """Values at places on a coordinate axis: linear in between, constant beyond the first and the last.

    Parameters
    ----------
    axis : "x" or "y"; of axisymmetric bodies "r" or "z"
    at : (n,) increasing coordinates, length
    values : (n,)

    Examples
    --------
    >>> Along("x", at=(0, 2), values=(0.1, 0.3))(np.array([[1.0, 5.0], [4.0, 5.0]]))
    array([0.2, 0.3])
    """

    axis: str
    at: tuple[float, ...]
    values: tuple[float, ...]

    def __post_init__(self) -> None:
        choice(self.axis, tuple(_AXES), ("axis",), "axis")
        _check_table(self)

    def __call__(self, points: Array) -> Array:
        """At points (k, d), (k,)."""
        return np.interp(np.asarray(points)[:, _AXES[self.axis]], self.at, self.values)


_FORMULA_LENGTH = 1000
"""Characters of a formula: what is longer is no formula that anybody wrote."""

_OPERATORS: dict[type[ast.AST], Callable[..., Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.UAdd: operator.pos,
    ast.USub: operator.neg,
}
_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "abs": np.abs,
    "cos": np.cos,
    "exp": np.exp,
    "log": np.log,
    "max": np.maximum,
    "min": np.minimum,
    "sin": np.sin,
    "sqrt": np.sqrt,
    "tanh": np.tanh,
}
_PAIRED = ("max", "min")
_COORDINATES = ("x", "y", "z")


@dataclass(frozen=True)
class Formula:
    """A formula of the coordinates x, y, z, in an axisymmetric model the radius x and the height y.

    Numbers, ``pi``, ``+ - * /``, ``**`` or ``^`` for powers, ``abs cos exp log max min sin sqrt tanh``. It is read, not
    run: whatever else a text holds is refused.

    Parameters
    ----------
    text : the formula

    Raises
    ------
    InputError
        Says what is no part of a formula.

    Examples
    --------
    >>> Formula("0.5*x^2 - y")(np.array([[2.0, 1.0], [4.0, 0.0]]))
    array([1., 8.])
    """

    text: str

    def __post_init__(self) -> None:
        text(self.text, ())
        if len(self.text) > _FORMULA_LENGTH:
            raise InputError(f"has {len(self.text)} characters; expected a formula of at most {_FORMULA_LENGTH}")
        try:
            tree = ast.parse(self.text.strip().replace("^", "**"), mode="eval")
            _value(tree.body, np.ones((1, len(_COORDINATES))))
        except InputError:
            raise
        except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
            raise InputError(f"'{self.text}' is no formula; expected one of x, y, z, such as '0.5*x^2 - y'") from error

    def __call__(self, points: Array) -> Array:
        """At points (k, d), (k,); not finite where the formula has no value."""
        with np.errstate(all="ignore"):
            found = _value(self._tree.body, np.asarray(points, float))
        return np.broadcast_to(np.asarray(found, float), (len(points),)).copy()

    def __str__(self) -> str:
        return self.text

    @property
    def _tree(self) -> ast.Expression:
        return ast.parse(self.text.strip().replace("^", "**"), mode="eval")


def _value(node: ast.AST, points: Array) -> Any:
    """Of a part of a formula at points (k, d), in floating point: whole numbers have no room to grow."""
    if isinstance(node, ast.Constant) and isinstance(node.value, int | float) and not isinstance(node.value, bool):
        return np.float64(node.value)
    if isinstance(node, ast.Name):
        if node.id == "pi":
            return np.float64(np.pi)
        if node.id in _COORDINATES[: points.shape[1]]:
            return points[:, _COORDINATES.index(node.id)]
        known = ", ".join((*_COORDINATES[: points.shape[1]], "pi"))
        raise InputError(f"has '{node.id}'; expected one of {known}")
    with np.errstate(all="ignore"):
        if isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
            return _OPERATORS[type(node.op)](_value(node.left, points), _value(node.right, points))
        if isinstance(node, ast.UnaryOp) and type(node.op) in _OPERATORS:
            return _OPERATORS[type(node.op)](_value(node.operand, points))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
            name = choice(node.func.id, _FUNCTIONS, (), "function")
            expected = 2 if name in _PAIRED else 1
            if len(node.args) != expected:
                raise InputError(f"has {name} of {len(node.args)} values; expected {expected}")
            return _FUNCTIONS[name](*(_value(part, points) for part in node.args))
    raise InputError(f"has '{ast.unparse(node)}'; expected numbers, coordinates, + - * / ^ and functions")


@dataclass(frozen=True)
class ArcLength:
    """Values over the arc length of a plane boundary: linear in between, constant beyond the first and the last.

    Parameters
    ----------
    at : (n,) increasing arc lengths from the end of the boundary that is nearest to ``start``
    values : (n,)
    start : a point, length; on a closed boundary arc length begins at the node next to it, the body on the left

    Examples
    --------
    >>> ArcLength(at=(0, 1), values=(0.0, 0.2), start=(0, 0)).on(np.array([0.5, 3.0]))
    array([0.1, 0.2])
    """

    at: tuple[float, ...]
    values: tuple[float, ...]
    start: tuple[float, float]

    def __post_init__(self) -> None:
        object.__setattr__(self, "start", vector(self.start, ("start",), dimension=2))
        _check_table(self)

    def on(self, length: Array) -> Array:
        """At arc lengths (k,), (k,)."""
        return np.interp(length, self.at, self.values)


@dataclass(frozen=True, eq=False, repr=False)
class NodeValues(Short):
    """Values at nodes, in between as displacements are.

    Parameters
    ----------
    values : (n,) one a node of the mesh, in its order
    nodes : (n,) numbers of the nodes, as the mesh's file has them, if there are values of some only

    Examples
    --------
    >>> NodeValues([0.1, 0.2], nodes=[7, 8]).nodes
    array([7, 8])
    """

    values: Array
    nodes: IntArray | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", frozen(vector(self.values, ("values",))))
        if self.nodes is None:
            return
        numbers = np.asarray(self.nodes)
        if numbers.shape != self.values.shape or numbers.dtype.kind not in "iu":
            words = f"are no whole numbers, {len(self.values)} as there are values; expected numbers of nodes"
            raise InputError(words, where=("nodes",))
        if len(np.unique(numbers)) != len(numbers):
            twice = int(np.sort(numbers)[np.flatnonzero(np.diff(np.sort(numbers)) == 0)[0]])
            raise InputError(f"name node {twice} twice; expected one value a node", where=("nodes",))
        object.__setattr__(self, "nodes", frozen(numbers, np.int64))


@dataclass(frozen=True, eq=False, repr=False)
class Scattered(Short):
    """Values at places, linear in simplices between them, beyond them those of the nearest.

    For what another program has computed on another mesh.

    Parameters
    ----------
    points : (n, d) coordinates, length
    values : (n,)

    Examples
    --------
    >>> corners = np.array([[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]])
    >>> Scattered(corners, values=[0.0, 2.0, 4.0])(np.array([[1.0, 0.0], [0.5, 0.5], [-3.0, 0.0]]))
    array([1. , 1.5, 0. ])
    """

    points: Array
    values: Array

    def __post_init__(self) -> None:
        size = np.shape(self.points)[1] if np.ndim(self.points) == 2 else 2
        object.__setattr__(self, "points", frozen(rows(self.points, ("points",), size=size)))
        object.__setattr__(self, "values", frozen(vector(self.values, ("values",), dimension=len(self.points))))

    def __call__(self, points: Array) -> Array:
        """At points (k, d), (k,)."""
        between, nearest = self._interpolants
        found = nearest(points) if between is None else between(points)
        return np.where(np.isnan(found), nearest(points), found)

    @cached_property
    def _interpolants(self) -> tuple[Callable[[Array], Array] | None, Callable[[Array], Array]]:
        from scipy.interpolate import LinearNDInterpolator, NearestNDInterpolator
        from scipy.spatial import QhullError

        nearest = NearestNDInterpolator(self.points, self.values)
        try:
            return LinearNDInterpolator(self.points, self.values), nearest
        except QhullError:  # on a line, or too few
            return None, nearest


Varying = float | Formula | ArcLength | NodeValues | Callable[[Array], Array]
"""A number, or what gives one at every place: functions take points (k, d) and return (k,)."""


def varying(value: Any, where: Where, *, least: float = -np.inf) -> Varying:
    """A number, an array of one value a node of the mesh, or what varies as it is; a text is a formula.

    Parameters
    ----------
    value : as the user gave it
    where : what errors call it
    least : smallest number that it may be

    Raises
    ------
    InputError
        If it is none of them.
    """
    if isinstance(value, str):
        try:
            return Formula(value)
        except InputError as error:
            raise error.inside(*where) from error
    if isinstance(value, NodeValues | ArcLength) or callable(value):
        return value
    if np.ndim(value):
        try:
            return NodeValues(value)
        except InputError as error:
            raise InputError(error.message, where=where) from error
    return number(value, where, least=least)


def spell(value: Any) -> str:
    """In a few words: the number, the formula, or "varies".

    >>> spell(0.25), spell(Formula("x^2")), spell(Along("x", at=(0, 1), values=(0, 1)))
    ('0.25', 'x^2', 'varies')
    """
    if isinstance(value, Formula):
        return value.text
    return f"{value:g}" if isinstance(value, float | int) else "varies"


def _check_table(table: Along | ArcLength) -> None:
    """Increasing places, and a value at each."""
    object.__setattr__(table, "at", vector(table.at, ("at",)))
    object.__setattr__(table, "values", vector(table.values, ("values",), dimension=len(table.at)))
    if not table.at or (np.diff(table.at) <= 0).any():
        what = "coordinates" if isinstance(table, Along) else "lengths"
        raise InputError(f"is {table.at}; expected increasing {what}", where=("at",))

# SPDX-License-Identifier: BSD-3-Clause
"""Rows of matrices in small blocks times vectors, compiled to the vector instructions of the machine.

What belongs to a node, q values, takes as many places as a vector register has lanes, `lanes`, so that one instruction
works on all of a row of a block. Compilers do not find that: they go along the row of blocks and gather. A sweep of
Gauss-Seidel then takes as long as reading the matrix, a quarter of what it takes entry by entry.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from llvmlite import ir  # type: ignore[import-untyped]
from numba.core import cgutils, types
from numba.core.errors import TypingError
from numba.extending import intrinsic

_INT = ir.IntType(64)
_CONTRACT = ("contract",)  # a product and a sum in one instruction


# the first argument of what it decorates, Numba's own, is nobody's who calls it
_emitted: Callable[[Callable[..., Any]], Callable[..., None]] = intrinsic


def lanes(size: int) -> int:
    """Places in a row of a vector that belong to ``size`` values: the next power of 2.

    Examples
    --------
    >>> [lanes(size) for size in (1, 2, 3, 6)]
    [1, 2, 4, 8]
    """
    return 1 << (size - 1).bit_length()


class _Blocks:
    """What is emitted for the blocks of a row, (d, q) each.

    Attributes
    ----------
    rows, columns : d, q
    vector : type of q values with the lanes behind them
    """

    def __init__(self, context: Any, builder: Any, sizes: tuple[int, int], entry: types.Type, data: Any) -> None:
        self.rows, self.columns = sizes
        self.builder, self.data = builder, data
        self.lanes = lanes(self.columns)
        self.align = entry.bitwidth // 8  # type: ignore[attr-defined]
        self.vector = ir.VectorType(context.get_value_type(entry), self.lanes)

    def load(self, array: Any, first: Any) -> Any:
        """As many entries of an array as there are lanes, from one on."""
        found = self.builder.load(self.at(array, first))
        found.align = self.align
        return found

    def at(self, array: Any, first: Any) -> Any:
        """Where entries of an array begin."""
        return self.builder.bitcast(self.builder.gep(array, [first]), self.vector.as_pointer())

    def row(self, number: Any, p: int) -> Any:
        """Row p of a block; lanes behind it hold anything, but nothing behind the last block is read."""
        begin = p * self.columns
        over = max(0, begin + self.lanes - self.rows * self.columns)
        first = self.builder.mul(number, ir.Constant(_INT, self.rows * self.columns))
        found = self.load(self.data, self.builder.add(first, ir.Constant(_INT, begin - over)))
        if over == 0:
            return found
        moved = [ir.Constant(ir.IntType(32), min(over + k, self.lanes - 1)) for k in range(self.lanes)]
        order = ir.Constant(ir.VectorType(ir.IntType(32), self.lanes), moved)
        return self.builder.shuffle_vector(found, ir.Constant(self.vector, ir.Undefined), order)

    def plus(self, total: Any, one: Any, other: Any) -> Any:
        """``total + one * other``."""
        product = self.builder.fmul(one, other, flags=_CONTRACT)
        return self.builder.fadd(total, product, flags=_CONTRACT)

    def everywhere(self, value: Any) -> Any:
        """A value in every lane."""
        nothing, zero = ir.Constant(self.vector, ir.Undefined), ir.Constant(ir.IntType(32), 0)
        first = self.builder.insert_element(nothing, value, zero)
        order = ir.Constant(ir.VectorType(ir.IntType(32), self.lanes), None)
        return self.builder.shuffle_vector(first, nothing, order)


def _sizes(rows: Any, columns: Any, *arrays: Any) -> tuple[int, int]:
    """Rows and columns of a block by the lengths of two tuples, for arrays that lie as they have to."""
    sizes = len(rows), len(columns)
    if any(array.layout != "C" or array.dtype != arrays[0].dtype for array in arrays):
        raise TypingError(f"arrays of one precision, row by row, were expected, not {arrays}")
    if sizes[0] * sizes[1] < lanes(sizes[1]):
        raise TypingError(f"blocks of at least {lanes(sizes[1])} entries were expected, not of {sizes}")
    return sizes


def _address(context: Any, builder: Any, signature: Any, values: Any, place: int) -> Any:
    kind = signature.args[place]
    return context.make_array(kind)(context, builder, values[place]).data


@_emitted
def gather_row(
    _: Any, rows: Any, columns: Any, data: Any, x: Any, indices: Any, begin: Any, end: Any, sums: Any
) -> Any:
    """Overwrite sums, (d,), by the sum of ``data[k] x[indices[k]]`` over k from begin to end.

    Parameters
    ----------
    _ : Numba's context of types
    rows, columns : tuples of d and of q items
    data : (k, d, q)
    x : (m, lanes(q))
    indices, begin, end : blocks of x; of k, the first and the one behind the last
    sums : (d,)
    """
    sizes = _sizes(rows, columns, data, x, sums)
    signature = types.void(rows, columns, data, x, indices, begin, end, sums)

    def emit(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        blocks = _Blocks(context, builder, sizes, data.dtype, _address(context, builder, signature, values, 2))
        vectors, place, into = (_address(context, builder, signature, values, k) for k in (3, 4, 7))
        zero = ir.Constant(blocks.vector, None)
        totals = [cgutils.alloca_once_value(builder, zero) for _ in range(sizes[0])]
        first, last = (context.cast(builder, values[k], signature.args[k], types.int64) for k in (5, 6))
        with cgutils.for_range_slice(builder, first, last, ir.Constant(_INT, 1), _INT) as (number, _):
            node = builder.sext(builder.load(builder.gep(place, [number])), _INT)
            seen = blocks.load(vectors, builder.mul(node, ir.Constant(_INT, blocks.lanes)))
            for p, total in enumerate(totals):
                builder.store(blocks.plus(builder.load(total), blocks.row(number, p), seen), total)
        for p, total in enumerate(totals):
            whole = builder.load(total)
            parts = [builder.extract_element(whole, ir.Constant(ir.IntType(32), k)) for k in range(sizes[1])]
            value = parts[0]
            for part in parts[1:]:
                value = builder.fadd(value, part)
            builder.store(value, builder.gep(into, [ir.Constant(_INT, p)]))
        return context.get_dummy_value()

    return signature, emit


@_emitted
def scatter_row(
    _: Any, rows: Any, columns: Any, data: Any, given: Any, indices: Any, begin: Any, end: Any, sums: Any
) -> Any:
    """Add ``data[k]' given`` to ``sums[indices[k]]`` for k from begin to end.

    Parameters
    ----------
    _, rows, columns, data, indices, begin, end : see `gather_row`
    given : (d,)
    sums : (m, lanes(q)); what is behind q values becomes anything
    """
    sizes = _sizes(rows, columns, data, given, sums)
    signature = types.void(rows, columns, data, given, indices, begin, end, sums)

    def emit(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        blocks = _Blocks(context, builder, sizes, data.dtype, _address(context, builder, signature, values, 2))
        vector, place, into = (_address(context, builder, signature, values, k) for k in (3, 4, 7))
        each = [builder.load(builder.gep(vector, [ir.Constant(_INT, p)])) for p in range(sizes[0])]
        factors = [blocks.everywhere(value) for value in each]
        first, last = (context.cast(builder, values[k], signature.args[k], types.int64) for k in (5, 6))
        with cgutils.for_range_slice(builder, first, last, ir.Constant(_INT, 1), _INT) as (number, _):
            node = builder.sext(builder.load(builder.gep(place, [number])), _INT)
            begin_of_node = builder.mul(node, ir.Constant(_INT, blocks.lanes))
            total = blocks.load(into, begin_of_node)
            for p, factor in enumerate(factors):
                total = blocks.plus(total, blocks.row(number, p), factor)
            builder.store(total, blocks.at(into, begin_of_node)).align = blocks.align
        return context.get_dummy_value()

    return signature, emit

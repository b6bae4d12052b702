"""Eight numbers side by side in compiled kernels: one instruction of the processor takes them all.

LLVM makes such instructions of a loop only where it can prove that its rounds do not meet in memory. Lanes
say so. A processor with narrower registers takes eight lanes in two or four parts, with equal bits.
The numbers are of double precision.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic, models, overload, register_model

WIDTH = 8  # lanes: of double precision 64 bytes, which is a cache line
LINE = 64  # bytes
ALIGNMENT = (
    8  # bytes, of one number: LLVM would load whole lines, which fault in views and copies that straddle them
)
_PLACE = ir.IntType(32)  # of the number of a lane


class _Lanes(types.Type):
    vector = ir.VectorType(ir.DoubleType(), WIDTH)

    def __init__(self) -> None:
        super().__init__(name="Lanes")


_lanes = _Lanes()


@register_model(_Lanes)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, manager: Any, of: Any) -> None:
        super().__init__(manager, of, of.vector)


def aligned(shape: tuple[int, ...]) -> np.ndarray:
    """Zeros of which each row of lanes is one cache line; rows across two take longer to read."""
    size = int(np.prod(shape))
    room = np.zeros(size + WIDTH)
    start = -room.ctypes.data % LINE // room.itemsize
    return room[start : start + size].reshape(shape)


def _lane_by_lane(action: Callable[..., Any], instruction: str) -> None:
    """Let the operator `action` take two Lanes, by the LLVM `instruction` of this name."""

    @intrinsic
    def act(typing_context: Any, a: Any, b: Any) -> Any:
        def code(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
            return getattr(builder, instruction)(*arguments)

        return a(a, a), code

    @overload(action)
    def acts_on_lanes(a, b):  # its names and annotations must be those of what it returns
        if isinstance(a, _Lanes) and isinstance(b, _Lanes):
            return lambda a, b: act(a, b)
        return None


for _action, _instruction in (
    (operator.add, "fadd"),
    (operator.sub, "fsub"),
    (operator.mul, "fmul"),
    (operator.truediv, "fdiv"),
):
    _lane_by_lane(_action, _instruction)


def _row(context: Any, builder: ir.IRBuilder, kind: Any, array: Any, *place: ir.Value) -> ir.Value:
    """Pointer to the lanes at the first indices `place` of an array whose last index numbers lanes."""
    array = context.make_array(kind)(context, builder, array)
    lengths = cgutils.unpack_tuple(builder, array.shape)
    at = place[0]
    for index, length in zip(place[1:], lengths[1:], strict=False):
        at = builder.add(builder.mul(at, length), index)
    at = builder.mul(at, at.type(WIDTH))
    return builder.gep(array.data, [at])


def _lane_pointer(builder: ir.IRBuilder, pointer: ir.Value) -> ir.Value:
    return builder.bitcast(pointer, _lanes.vector.as_pointer())


def _rows(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> list[ir.Value]:
    """Pointers to the rows of an array that numbers[block, side] name."""
    kind, numbers = signature.args[:2]
    first = _row(context, builder, numbers, arguments[1], *arguments[2:4])
    found = []
    for lane in range(WIDTH):
        row = builder.load(builder.gep(first, [_PLACE(lane)]))
        row = builder.sext(row, arguments[2].type)
        found.append(_lane_pointer(builder, _row(context, builder, kind, arguments[0], row)))
    return found


def _transposed(builder: ir.IRBuilder, rows: list[ir.Value]) -> list[ir.Value]:
    """Columns of eight rows: blocks of 1, 2 and 4 beside the diagonal change places."""
    for size in (1, 2, 4):
        first = [lane if not lane & size else lane - size + WIDTH for lane in range(WIDTH)]
        second = [lane + size if not lane & size else lane + WIDTH for lane in range(WIDTH)]
        for row in (row for row in range(WIDTH) if not row & size):
            pair = rows[row], rows[row + size]
            rows[row], rows[row + size] = (
                builder.shuffle_vector(*pair, ir.Constant(ir.VectorType(_PLACE, WIDTH), order))
                for order in (first, second)
            )
    return rows


@intrinsic
def zeros(typing_context: Any) -> Any:
    """Lanes of zero."""

    def code(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
        return ir.Constant(_lanes.vector, [0.0] * WIDTH)

    return _lanes(), code


@intrinsic
def broadcast(typing_context: Any, value: Any) -> Any:
    """One number in all lanes."""

    def code(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
        lanes = ir.Constant(_lanes.vector, ir.Undefined)
        for lane in range(WIDTH):
            lanes = builder.insert_element(lanes, arguments[0], _PLACE(lane))
        return lanes

    return _lanes(types.float64), code


@intrinsic
def sqrt(typing_context: Any, value: Any) -> Any:
    """Square roots."""

    def code(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
        kind = ir.FunctionType(_lanes.vector, [_lanes.vector])
        name = f"llvm.sqrt.v{WIDTH}f64"
        return builder.call(cgutils.get_or_insert_function(builder.module, kind, name), arguments)

    return _lanes(_lanes), code


@intrinsic
def select_greater(typing_context: Any, a: Any, b: Any, then: Any, otherwise: Any) -> Any:
    """Lanes that are `then` if a > b, else `otherwise`; NaN is not greater than anything."""

    def code(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
        # ordered: NaN is not greater than anything and takes `otherwise`
        return builder.select(builder.fcmp_ordered(">", *arguments[:2]), *arguments[2:])

    return _lanes(_lanes, _lanes, _lanes, _lanes), code


@intrinsic
def greater_bits(typing_context: Any, a: Any, b: Any) -> Any:
    """An int64 (0 to 255) of which bit k is set if a > b in lane k."""

    def code(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
        bits = builder.bitcast(builder.fcmp_ordered(">", *arguments), ir.IntType(WIDTH))
        return builder.zext(bits, ir.IntType(64))

    return types.int64(_lanes, _lanes), code


@intrinsic
def load(typing_context: Any, array: Any, block: Any, row: Any) -> Any:
    """The lanes array[block, row, :] of an `aligned` array (b, rows, WIDTH)."""

    def code(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
        at = _row(context, builder, signature.args[0], *arguments)
        return builder.load(_lane_pointer(builder, at), align=ALIGNMENT)

    return _lanes(array, types.intp, types.intp), code


@intrinsic
def store(typing_context: Any, array: Any, block: Any, row: Any, value: Any) -> Any:
    """Write lanes to array[block, row, :] of an `aligned` array (b, rows, WIDTH)."""

    def code(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
        at = _row(context, builder, signature.args[0], *arguments[:3])
        builder.store(arguments[3], _lane_pointer(builder, at), align=ALIGNMENT)
        return context.get_dummy_value()

    return types.void(array, types.intp, types.intp, _lanes), code


@intrinsic
def gather(typing_context: Any, array: Any, numbers: Any, block: Any, side: Any) -> Any:
    """The rows numbers[block, side, :] of an array (n, WIDTH), one a lane, as a tuple of WIDTH columns.

    `array` has a row for each body; `numbers` (b, sides, WIDTH) has eight for each block and side.
    """

    def code(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
        rows = [builder.load(at, align=ALIGNMENT) for at in _rows(context, builder, signature, arguments)]
        return context.make_tuple(builder, signature.return_type, _transposed(builder, rows))

    return types.UniTuple(_lanes, WIDTH)(array, numbers, types.intp, types.intp), code


@intrinsic
def scatter(typing_context: Any, array: Any, numbers: Any, block: Any, side: Any, columns: Any) -> Any:
    """Write columns to rows of `array`, the reverse of `gather`; where two lanes name one row, the last stays."""

    def code(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
        rows = _transposed(builder, cgutils.unpack_tuple(builder, arguments[4]))
        for row, at in zip(rows, _rows(context, builder, signature, arguments), strict=True):
            builder.store(row, at, align=ALIGNMENT)
        return context.get_dummy_value()

    return types.void(array, numbers, types.intp, types.intp, columns), code


@intrinsic
def total(typing_context: Any, value: Any) -> Any:
    """Sum of the lanes, first to last on every processor, and so with equal bits."""

    def code(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
        # one after another: in the same order on every processor
        lanes = [builder.extract_element(arguments[0], _PLACE(lane)) for lane in range(WIDTH)]
        result = lanes[0]
        for lane in lanes[1:]:
            result = builder.fadd(result, lane)
        return result

    return types.float64(_lanes), code


@intrinsic
def largest(typing_context: Any, value: Any) -> Any:
    """The largest of the lanes."""

    def code(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
        lanes = [builder.extract_element(arguments[0], _PLACE(lane)) for lane in range(WIDTH)]
        result = lanes[0]
        for lane in lanes[1:]:
            result = builder.select(builder.fcmp_ordered(">", lane, result), lane, result)
        return result

    return types.float64(_lanes), code

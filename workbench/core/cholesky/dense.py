"""BLAS and LAPACK for compiled kernels, called by address, so that kernels stay cacheable and hold no lock.

Every matrix is given by the address of its first entry and its leading dimension, by columns; only lower triangles are used.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic

_BYTE, _INT, _LONG, _DOUBLE = ir.IntType(8), ir.IntType(32), ir.IntType(64), ir.DoubleType()


class _Call:
    """Builds one call of a Fortran routine: each argument is the address of its value."""

    def __init__(self, builder: Any) -> None:
        self.builder = builder
        self.arguments: list[Any] = []

    def letter(self, value: str) -> _Call:
        return self._keep(ir.Constant(_BYTE, ord(value)))

    def number(self, value: float) -> _Call:
        return self.value(ir.Constant(_DOUBLE, value))

    def value(self, value: Any) -> _Call:
        return self._keep(value)

    def count(self, value: Any) -> _Call:
        return self._keep(self.builder.trunc(value, _INT))

    def matrix(self, address: Any, leading: Any) -> _Call:
        self.arguments.append(self.builder.inttoptr(address, _DOUBLE.as_pointer()))
        return self.count(leading)

    def call(self, address: Any) -> None:
        signature = ir.FunctionType(ir.VoidType(), [argument.type for argument in self.arguments])
        self.builder.call(self.builder.inttoptr(address, signature.as_pointer()), self.arguments)

    def _keep(self, value: Any) -> _Call:
        self.arguments.append(cgutils.alloca_once_value(self.builder, value))
        return self


def _signature(count: int, result: Any) -> Any:
    return result(*([types.int64] * count))


@intrinsic
def factor_dense(context, routine, n, a, lda):  # type: ignore[no-untyped-def]
    """`factor_dense(routine, n, a, lda)`: the n x n matrix at `a` becomes its Cholesky factor; returns LAPACK's `info`."""

    def build(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        routine, n, a, lda = arguments
        call = _Call(builder).letter("L").count(n).matrix(a, lda).count(ir.Constant(_LONG, 0))
        call.call(routine)
        return builder.sext(builder.load(call.arguments[-1]), _LONG)

    return _signature(4, types.int64), build


@intrinsic
def solve_dense(context, routine, m, n, a, lda, b, ldb):  # type: ignore[no-untyped-def]
    """`solve_dense(routine, m, n, a, lda, b, ldb)`: B := B A^-T, A n x n lower triangular, B m x n."""

    def build(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        routine, m, n, a, lda, b, ldb = arguments
        call = _Call(builder).letter("R").letter("L").letter("T").letter("N").count(m).count(n).number(1.0)
        call.matrix(a, lda).matrix(b, ldb).call(routine)
        return context.get_dummy_value()

    return _signature(7, types.void), build


@intrinsic
def negated_square(context, routine, n, k, a, lda, c, ldc):  # type: ignore[no-untyped-def]
    """`negated_square(routine, n, k, a, lda, c, ldc)`: C := -A A^T, A n x k; what C held is not read."""

    def build(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        routine, n, k, a, lda, c, ldc = arguments
        call = _Call(builder).letter("L").letter("N").count(n).count(k).number(-1.0).matrix(a, lda).number(0.0)
        call.matrix(c, ldc).call(routine)
        return context.get_dummy_value()

    return _signature(7, types.void), build


@intrinsic
def subtract_product(context, routine, m, n, k, a, lda, b, ldb, beta, c, ldc):  # type: ignore[no-untyped-def]
    """`subtract_product(routine, m, n, k, a, lda, b, ldb, beta, c, ldc)`: C := beta C - A B^T; A m x k, B n x k."""

    def build(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        routine, m, n, k, a, lda, b, ldb, beta, c, ldc = arguments
        call = _Call(builder).letter("N").letter("T").count(m).count(n).count(k).number(-1.0)
        call.matrix(a, lda).matrix(b, ldb).value(builder.sitofp(beta, _DOUBLE)).matrix(c, ldc).call(routine)
        return context.get_dummy_value()

    return _signature(11, types.void), build

"""A register machine that evaluates a graph on many simplices at once.

A formula is compiled to a short list of instructions (microseconds), and one kernel, compiled once for good, runs any such
list over blocks of `LANES` simplices that stay in the cache: a typed formula is as fast as a built-in one, without compilation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numba
import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.expression import SWITCH, Graph, Op

LANES = 128
"""Simplices that go through the machine together."""


@dataclass(frozen=True, eq=False)
class Tape:
    """Instructions in order.

    `code` : (k, 6) int64       operation, destination register, four arguments (registers)
    `constants` : (c,) float64  preset registers `variable_count` .. `variable_count` + c - 1
    `outputs` : (o,) int64      registers that hold the results at the end
    `register_count`, `variable_count` : int;  the inputs are registers 0 .. `variable_count` - 1
    """

    code: Integers
    constants: Floats
    outputs: Integers
    register_count: int
    variable_count: int

    def registers(self) -> Floats:
        """(register_count, LANES) float64: working memory with the constants filled in."""
        memory = np.zeros((self.register_count, LANES))
        memory[self.variable_count : self.variable_count + len(self.constants)] = self.constants[:, None]
        return memory

    def evaluate(self, variables: Floats) -> Floats:
        """(m, variable_count) float64 -> (m, outputs) float64."""
        out = np.empty((len(variables), len(self.outputs)))
        _evaluate(self.code, self.outputs, self.registers(), np.ascontiguousarray(variables, dtype=np.float64), out)
        return out


def compile_tape(graph: Graph, results: list[int]) -> Tape:
    """Instructions for `results` (nodes of `graph`), with registers reused once their last reader is done."""
    order = graph.reachable(results)
    last_use = {node: position for position, node in enumerate(order)}
    for position, node in enumerate(order):
        for argument in graph.nodes[node][2]:
            last_use[argument] = position
    keep = set(results)
    constants = [n for n in order if graph.nodes[n][0] is Op.CONSTANT]
    register = {n: int(value) for n, (op, value, _) in enumerate(graph.nodes) if op is Op.VARIABLE}
    register.update({n: graph.input_count + i for i, n in enumerate(constants)})
    next_register = graph.input_count + len(constants)
    free: list[int] = []
    code = []
    for position, node in enumerate(order):
        op, _, arguments = graph.nodes[node]
        if op in (Op.CONSTANT, Op.VARIABLE):
            continue
        sources = [register[a] for a in arguments]
        for argument in set(arguments):
            is_temporary = graph.nodes[argument][0] not in (Op.CONSTANT, Op.VARIABLE)
            if is_temporary and last_use[argument] == position and argument not in keep:
                free.append(register[argument])
        if free:
            register[node] = free.pop()
        else:
            register[node] = next_register
            next_register += 1
        code.append([int(op), register[node], *sources, *([0] * (4 - len(sources)))])
    return Tape(
        code=np.array(code, dtype=np.int64).reshape(-1, 6),
        constants=np.array([graph.nodes[n][1] for n in constants], dtype=np.float64),
        outputs=np.array([register[n] for n in results], dtype=np.int64),
        register_count=next_register,
        variable_count=graph.input_count,
    )


@numba.njit(nogil=True, cache=True, error_model="numpy")
def run_tape(code, memory):  # type: ignore[no-untyped-def]
    """Run the instructions on all lanes of `memory` (register_count, LANES)."""
    lanes = memory.shape[1]
    for k in range(code.shape[0]):
        op = code[k, 0]
        out = memory[code[k, 1]]
        a = memory[code[k, 2]]
        b = memory[code[k, 3]]
        if op == 2:
            for i in range(lanes):
                out[i] = a[i] + b[i]
        elif op == 3:
            for i in range(lanes):
                out[i] = a[i] - b[i]
        elif op == 4:
            for i in range(lanes):
                out[i] = a[i] * b[i]
        elif op == 5:
            for i in range(lanes):
                out[i] = a[i] / b[i]
        elif op == 6:
            for i in range(lanes):
                out[i] = a[i] ** b[i]
        elif op == 7:
            for i in range(lanes):
                out[i] = np.sqrt(a[i])
        elif op == 8:
            for i in range(lanes):
                out[i] = np.exp(a[i])
        elif op == 9:
            for i in range(lanes):
                out[i] = np.log(a[i])
        elif op == 10:
            for i in range(lanes):
                out[i] = abs(a[i])
        elif op == 11:
            for i in range(lanes):
                out[i] = np.sign(a[i])
        elif op == 12:
            for i in range(lanes):
                out[i] = a[i] if a[i] >= b[i] else b[i]
        elif op == 13:
            for i in range(lanes):
                out[i] = a[i] if a[i] <= b[i] else b[i]
        elif op == 14:
            c = memory[code[k, 4]]
            d = memory[code[k, 5]]
            for i in range(lanes):
                out[i] = c[i] if a[i] >= b[i] else d[i]
        elif op == 15:
            c = memory[code[k, 4]]
            d = memory[code[k, 5]]
            for i in range(lanes):
                gap = a[i] - b[i]
                near = SWITCH * (abs(a[i]) + abs(b[i]))
                if gap >= near:  # with both at 0: c, as there is nothing to tell them apart by
                    out[i] = c[i]
                elif gap <= -near:
                    out[i] = d[i]
                else:
                    out[i] = 0.5 * (c[i] + d[i]) + 0.5 * (gap / near) * (c[i] - d[i])
        elif op == 16:
            for i in range(lanes):
                near = SWITCH * (abs(a[i]) + abs(b[i]))
                out[i] = 0.5 / near if abs(a[i] - b[i]) < near else 0.0
        elif op == 17:
            for i in range(lanes):
                out[i] = 0.5 / max(abs(a[i] - b[i]), SWITCH * (abs(a[i]) + abs(b[i])), 1e-300)


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _evaluate(code, outputs, memory, variables, out):  # type: ignore[no-untyped-def]
    lanes = memory.shape[1]
    count = variables.shape[0]
    for start in range(0, count, lanes):
        stop = min(start + lanes, count)
        for i in range(stop - start):
            for v in range(variables.shape[1]):
                memory[v, i] = variables[start + i, v]
        run_tape(code, memory)
        for o in range(outputs.shape[0]):
            row = memory[outputs[o]]
            for i in range(stop - start):
                out[start + i, o] = row[i]

"""Steepest descent of one vertex at a time, those that share no simplex together."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from workbench.api import (
    ROUNDING,
    SAFETY,
    Derivatives,
    DescentSolver,
    Evaluation,
    Floats,
    Integers,
    Interrupt,
    Problem,
    State,
    Status,
    descend,
    descend_block,
    parameter,
)


@dataclass(frozen=True, eq=False)
class BlockMemory(Derivatives):
    """The derivatives at the newest map; (N,) the last accepted step of each vertex, 0 where there was none; and of the
    vertices that linear constraints bind, which move together."""

    lengths: Floats
    bound_length: float


@dataclass(frozen=True)
class BlockGradientDescent(DescentSolver):
    """Block gradient descent: a sweep over the colours of the vertices, each vertex with a step of its own.

    As Hormann and Greiner, a vertex moves while the rest stands still, along its own gradient, never past the first
    inversion of its own simplices (the content of each is linear in its step); as Fu, Liu and Guo, vertices without a common
    simplex move at once. Steps are found by Armijo's rule from `growth` times the vertex's last one, where the former
    minimise along the line and the latter take a Newton step of the vertex. Vertices that linear constraints bind make one
    block, moved together at the end of the sweep. One iteration is one sweep.
    """

    id = "block-gradient-descent"
    label = "Block gradient descent"
    short = "BGD"
    citation = "Hormann & Greiner 2000 [HG00]; Fu, Liu, Guo 2015 [FLG15]; section 4.3"
    takes_fences = False  # a simplex on the brink holds its own vertices only

    growth: float = parameter(2.0, "factor on a vertex's last step for its next first trial", minimum=1.0, maximum=100.0)
    safety: float = parameter(SAFETY, "part of the largest step without inversion that is taken", minimum=0.1, maximum=0.99)

    def prepare(self, problem: Problem) -> None:
        problem.workspace.vertex_blocks  # noqa: B018

    def advance(self, problem: Problem, state: State, evaluation: Evaluation, interrupt: Interrupt) -> State:
        memory = state.memory if isinstance(state.memory, BlockMemory) else None
        lengths = memory.lengths.copy() if memory is not None else np.zeros(len(state.positions))
        movable = np.ones(len(state.positions), dtype=bool)
        movable[problem.anchors.hard_vertices] = False
        bound = _bound_vertices(problem)
        movable[bound] = False
        x = state.positions.copy()
        promise = 0.0
        for block in problem.workspace.vertex_blocks:
            gain = descend_block(problem, block, x, lengths, movable, self.growth, self.safety, interrupt)
            if gain is None:
                return replace(state, status=Status.INTERRUPTED)
            promise += gain
        following = self._settled(problem, state, evaluation, x, promise)
        if len(bound) and following.status is Status.RUNNING:
            return self._move_bound(problem, state, following, bound, lengths, memory, interrupt)
        own = following.memory
        return replace(following, memory=BlockMemory(own.problem, own.evaluation, lengths, 0.0))

    @staticmethod
    def _settled(problem: Problem, state: State, evaluation: Evaluation, x: Floats, promise: float) -> State:
        """The state at `x`, which a sweep led to; at the old map where the sum of all steps is below rounding."""
        following = problem.evaluate(x, 1)
        still = replace(
            state,
            iteration=state.iteration + 1,
            energy=evaluation.energy,
            previous_energy=evaluation.energy,
            step_size=0.0,
            memory=Derivatives(problem, evaluation),
        )
        if not following.energy <= evaluation.energy or np.array_equal(x, state.positions):
            is_minimum = promise <= (1e-7 if problem.density.has_kinks else ROUNDING) * abs(evaluation.energy)
            rounded = following.energy <= evaluation.energy * (1.0 + 1e-12)
            return still if is_minimum or rounded else replace(still, iteration=state.iteration, status=Status.NO_DESCENT)
        return replace(
            still,
            positions=x,
            energy=following.energy,
            gradient_norm=problem.free_gradient_norm(following.gradient),
            step_size=1.0,
            inverted=following.inverted,
            anchor_error=problem.anchor_error(x),
            memory=Derivatives(problem, following),
        )

    def _move_bound(
        self,
        problem: Problem,
        state: State,
        following: State,
        bound: Integers,
        lengths: Floats,
        memory: BlockMemory | None,
        interrupt: Interrupt,
    ) -> State:
        """The step of the vertices that constraints bind, all together, along A x = const."""
        assert problem.constraints is not None
        evaluation = following.memory.evaluation
        others = np.setdiff1d(np.arange(len(following.positions)), np.setdiff1d(bound, problem.anchors.hard_vertices))
        direction = -evaluation.gradient
        direction[others] = 0.0
        direction = problem.constraints.tangential(direction, others)
        longest = float(np.linalg.norm(direction, axis=1).max(initial=0.0))
        last = memory.bound_length if memory is not None else 0.0
        first = self.growth * last if last > 0.0 else 0.1 * problem.mesh.diameter / max(longest, 1e-300)
        final = descend(problem, following, evaluation, direction, interrupt, first=first, furthest=0.0, safety=self.safety)
        if final.status is Status.INTERRUPTED:
            return replace(state, status=Status.INTERRUPTED)
        length = final.step_size
        if final.status is not Status.RUNNING or length == 0.0:
            final, length = following, 0.0
        own = final.memory
        return replace(
            final,
            iteration=state.iteration + 1,
            previous_energy=state.energy,
            step_size=max(final.step_size, following.step_size),
            memory=BlockMemory(own.problem, own.evaluation, lengths, length),
        )


def _bound_vertices(problem: Problem) -> Integers:
    """Vertices that a linear constraint names."""
    if problem.constraints is None:
        return np.empty(0, dtype=np.int64)
    return np.unique(problem.constraints.matrix.tocoo().col // problem.dimension)

"""The largest step without inversion, and Armijo's rule below it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numba
import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.threads import over_ranges

SAFETY = 0.95
"""Part of the largest step without inversion that a step may take."""


def largest_step_without_inversion(positions: Floats, direction: Floats, simplices: Integers) -> float:
    """Largest step at which some simplex first loses its orientation.

    Parameters
    ----------
    positions : (n, d) float64     current map; simplices that are inverted or degenerate may go where they like
    direction : (n, d) float64     search direction
    simplices : (m, d+1) int64

    Returns
    -------
    float     in (0, inf]; inf when no simplex can invert; unit: length of `positions` over that of `direction`

    Source: Smith & Schaefer 2015, section 3.3. Cost: O(m), releases the interpreter lock.
    """
    return largest_step(positions, direction, simplices)[0]


def largest_step(positions: Floats, direction: Floats, simplices: Integers) -> tuple[float, int]:
    """As `largest_step_without_inversion`, and the number of the simplex that sets it (-1 where none does)."""
    x = np.ascontiguousarray(positions, dtype=np.float64)
    d = np.ascontiguousarray(direction, dtype=np.float64)
    kernel = _largest_step_2d if simplices.shape[1] == 3 else _largest_step_3d

    def work(part: int, start: int, stop: int) -> tuple[float, int]:
        return kernel(x, d, simplices, start, stop)  # type: ignore[no-any-return]

    return min(over_ranges(work, len(simplices)), key=lambda r: r[0])


@dataclass(frozen=True, eq=False)
class Step:
    """Outcome of a line search; `size` 0 means that no step was found."""

    positions: Floats
    size: float
    energy: float
    inverted: int
    trials: int
    interrupted: bool = False


def armijo(
    evaluate: Callable[[Floats], tuple[float, int]],
    positions: Floats,
    direction: Floats,
    energy: float,
    slope: float,
    first: float,
    interrupt: Callable[[], bool],
    *,
    sufficient: float = 1e-4,
    shrink: float = 0.5,
    trials: int = 60,
    furthest: float = 0.0,
    most_inverted: float = math.inf,
) -> Step:
    """Backtracking from the step `first` until E(x + t d) <= E(x) + sufficient t slope.

    Parameters
    ----------
    evaluate : callable    positions -> (energy, inverted count); +inf where the map is not allowed
    slope : float          directional derivative of the energy, negative
    first : float          first trial, already below the largest step without inversion
    interrupt : callable   asked before every trial; true ends the search with the old positions
    furthest : float       where the first trial is accepted, a longer step, up to this one, is tried at the minimum of the
                           parabola through what is known: a projected Hessian is too stiff, and a trial is cheap beside it
    most_inverted : float  inverted simplices that a trial may have: close to a collapse, rounding can invert one before the
                           largest step is reached, and a distortion without a barrier does not mind

    Source: Nocedal & Wright 2006, section 3.1.
    """
    size = first
    for trial in range(1, trials + 1):
        if interrupt():
            return Step(positions, 0.0, energy, 0, trial - 1, interrupted=True)
        candidate = positions + size * direction
        value, inverted = evaluate(candidate)
        is_lower = value <= energy + sufficient * size * slope and math.isfinite(value)
        if is_lower and inverted <= most_inverted:
            found = Step(candidate, size, value, inverted, trial)
            if trial > 1 or furthest <= size:
                return found
            return _extrapolated(evaluate, positions, direction, energy, slope, found, furthest)
        size *= shrink
    return Step(positions, 0.0, energy, 0, trials)


def _extrapolated(
    evaluate: Callable[[Floats], tuple[float, int]],
    positions: Floats,
    direction: Floats,
    energy: float,
    slope: float,
    found: Step,
    furthest: float,
) -> Step:
    """The better one of `found` and a step at the minimum of the parabola through E(x), its slope and E(x + t d)."""
    curvature = (found.energy - energy - slope * found.size) / found.size**2
    size = min(furthest, -0.5 * slope / curvature if curvature > 0.0 else furthest, 4.0 * found.size)
    if not size > 1.1 * found.size:
        return found
    candidate = positions + size * direction
    value, inverted = evaluate(candidate)
    if value < found.energy and inverted <= found.inverted:
        return Step(candidate, size, value, inverted, found.trials + 1)
    return found


@numba.njit(nogil=True, cache=True, error_model="numpy")
def smallest_positive_root_quadratic(a, b, c):  # type: ignore[no-untyped-def]
    """Smallest t > 0 with a t^2 + b t + c = 0 for c > 0; inf where there is none. Never divides by a vanishing leading term.

    0 where a coefficient is not finite: no step can be trusted then.
    """
    if not abs(a) + abs(b) + c < math.inf:
        return 0.0
    scale = max(abs(a), abs(b), c)
    a, b, c = a / scale, b / scale, c / scale  # squares of tiny coefficients vanish
    if a == 0.0:
        return -c / b if b < 0.0 else math.inf
    discriminant = b * b - 4.0 * a * c
    if discriminant < 0.0:
        return math.inf
    root = math.sqrt(discriminant)
    # q has the sign of -b, so no difference of nearly equal numbers is taken
    q = -0.5 * (b + root) if b >= 0.0 else -0.5 * (b - root)
    best = math.inf
    if q != 0.0 and c / q > 0.0:
        best = c / q
    if q / a > 0.0 and q / a < best:
        best = q / a
    return best


@numba.njit(nogil=True, cache=True, error_model="numpy")
def smallest_positive_root_cubic(a, b, c, d, most=math.inf):  # type: ignore[no-untyped-def]
    """Smallest t in (0, most] with a t^3 + b t^2 + c t + d = 0 for d > 0; inf where there is none.

    0 where a coefficient is not finite: no step can be trusted then.

    The cubic is split at its turning points into monotone pieces; the first piece that ends at or below zero holds the root,
    which a bisection finds to the last bit: no closed form, no vanishing denominator. A root is met from below.
    """
    if not abs(a) + abs(b) + abs(c) + d < math.inf or d <= 0.0:  # a sum, as max may pass over what is no number
        return 0.0
    scale = max(abs(a), abs(b), abs(c), d)
    a, b, c, d = a / scale, b / scale, c / scale, d / scale
    t1, t2 = math.inf, math.inf  # turning points, ascending, where positive
    first = positive_roots_quadratic(3.0 * a, 2.0 * b, c)
    if first[0] > 0.0:
        t1 = first[0]
    if first[1] > 0.0:
        if first[1] < t1:
            t1, t2 = first[1], t1
        else:
            t2 = first[1]
    low = 0.0
    for k in range(3):
        high = min(t1 if k == 0 else (t2 if k == 1 else math.inf), most)
        if high == math.inf:
            # the last piece: it comes down to zero only if the leading behaviour is negative
            high = max(1.0, 2.0 * low)
            found = False
            for _ in range(1100):
                if ((a * high + b) * high + c) * high + d <= 0.0:
                    found = True
                    break
                high *= 2.0
                if high > 1e300:
                    break
            if not found:
                return math.inf
        elif ((a * high + b) * high + c) * high + d > 0.0:
            if high == most:
                return math.inf
            low = high
            continue
        for _ in range(1200):  # as many halvings as a float has: a turning point may lie absurdly far out
            middle = 0.5 * (low + high)
            if middle <= low or middle >= high:
                break
            if ((a * middle + b) * middle + c) * middle + d > 0.0:
                low = middle
            else:
                high = middle
        return low if low > 0.0 else high
    return math.inf


@numba.njit(nogil=True, cache=True, error_model="numpy")
def positive_roots_quadratic(a, b, c):  # type: ignore[no-untyped-def]
    """Both real roots of a t^2 + b t + c, -1 for those that are missing or not positive."""
    if a == 0.0:  # apart, as the square of a tiny b vanishes
        return -1.0, (-c / b if b != 0.0 and 0.0 < -c / b < math.inf else -1.0)
    discriminant = b * b - 4.0 * a * c
    if discriminant < 0.0:
        return -1.0, -1.0
    root = math.sqrt(discriminant)
    q = -0.5 * (b + root) if b >= 0.0 else -0.5 * (b - root)
    r1 = q / a
    r2 = c / q if q != 0.0 else -1.0
    if not 0.0 < r1 < math.inf:
        r1 = -1.0
    if not 0.0 < r2 < math.inf:
        r2 = -1.0
    return r1, r2


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _largest_step_2d(x, d, simplices, start, stop):  # type: ignore[no-untyped-def]
    best = math.inf
    index = -1
    for e in range(start, stop):
        i, j, k = simplices[e, 0], simplices[e, 1], simplices[e, 2]
        p0, p1 = x[j, 0] - x[i, 0], x[j, 1] - x[i, 1]
        q0, q1 = x[k, 0] - x[i, 0], x[k, 1] - x[i, 1]
        u0, u1 = d[j, 0] - d[i, 0], d[j, 1] - d[i, 1]
        v0, v1 = d[k, 0] - d[i, 0], d[k, 1] - d[i, 1]
        c = p0 * q1 - p1 * q0
        b = p0 * v1 - p1 * v0 + u0 * q1 - u1 * q0
        a = u0 * v1 - u1 * v0
        if c <= 0.0 or (a >= 0.0 and b >= 0.0):
            continue
        t = smallest_positive_root_quadratic(a, b, c)
        if t < best:
            best = t
            index = e
    return best, index


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _largest_step_3d(x, d, simplices, start, stop):  # type: ignore[no-untyped-def]
    best = math.inf
    index = -1
    P, D = np.empty((3, 3)), np.empty((3, 3))
    for e in range(start, stop):
        o = simplices[e, 0]
        for j in range(3):
            v = simplices[e, j + 1]
            for r in range(3):
                P[j, r] = x[v, r] - x[o, r]
                D[j, r] = d[v, r] - d[o, r]
        c0 = _triple(P, P, P)
        c1 = _triple(D, P, P) + _triple(P, D, P) + _triple(P, P, D)
        c2 = _triple(D, D, P) + _triple(D, P, D) + _triple(P, D, D)
        c3 = _triple(D, D, D)
        if c0 <= 0.0 or (c1 >= 0.0 and c2 >= 0.0 and c3 >= 0.0):
            continue
        if best < math.inf and ((min(c3, 0.0) * best + min(c2, 0.0)) * best + min(c1, 0.0)) * best + c0 > 0.0:
            continue  # cannot reach zero before the best step so far
        t = smallest_positive_root_cubic(c3, c2, c1, c0, best)
        if t < best:
            best = t
            index = e
    return best, index


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="always")
def _triple(A, B, C):  # type: ignore[no-untyped-def]
    """Determinant with row 0 of A, row 1 of B and row 2 of C."""
    return (
        A[0, 0] * (B[1, 1] * C[2, 2] - B[1, 2] * C[2, 1])
        - A[0, 1] * (B[1, 0] * C[2, 2] - B[1, 2] * C[2, 0])
        + A[0, 2] * (B[1, 0] * C[2, 1] - B[1, 1] * C[2, 0])
    )

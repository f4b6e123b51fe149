"""Substitution for `LANES` right-hand sides at once, with the factor that `band` and `zone` hold.

A recurrence makes one right-hand side wait for itself at every node; several next to each other fill
the waiting and read the factor once. Entry (node i, component c, lane s) of a block of right-hand
sides sits at base + (2 i + c) LANES + s, so that all distances within a loop are constants.
"""

from .jit import kernel
from .vector import LANES, subtract, turn
from .zone import ROW, WIDTH

TILE = 32  # nodes that are moved at once between rows and lanes, so that both stay at hand


@kernel
def interleave(m, D, row, R, base):
    """Write rows `row` .. `row` + LANES - 1 of D, each 2 m long, as the lanes of one block of R.

    The lanes are written out for the compiler, which turns them into shuffles of whole vectors.
    """
    for c in range(2):
        k, at = 2 * m * row + c * m, base + c * LANES
        for i in range(m):
            R[at + 2 * LANES * i] = D[k + i]
            R[at + 2 * LANES * i + 1] = D[k + 2 * m + i]
            R[at + 2 * LANES * i + 2] = D[k + 4 * m + i]
            R[at + 2 * LANES * i + 3] = D[k + 6 * m + i]
            R[at + 2 * LANES * i + 4] = D[k + 8 * m + i]
            R[at + 2 * LANES * i + 5] = D[k + 10 * m + i]
            R[at + 2 * LANES * i + 6] = D[k + 12 * m + i]
            R[at + 2 * LANES * i + 7] = D[k + 14 * m + i]


@kernel
def separate(m, R, base, D, row):
    """Undo `interleave`."""
    for begin in range(0, m, TILE):
        for s in range(2 * LANES):
            c, at = (row + s % LANES) * 2 * m + s // LANES * m, base + s
            for i in range(begin, min(begin + TILE, m)):
                D[c + i] = R[at + 2 * LANES * i]


@kernel
def forward_lanes(m, L, R, base, i, j, k):
    """What `band.forward` does, for every lane."""
    x, j, k = base + 2 * LANES * i, base + 2 * LANES * j, base + 2 * LANES * k
    y = x + LANES
    subtract(R, j, L[3 * m + i], x, L[5 * m + i], y)
    subtract(R, j + LANES, L[4 * m + i], x, L[6 * m + i], y)
    subtract(R, k, L[7 * m + i], x, L[9 * m + i], y)
    subtract(R, k + LANES, L[8 * m + i], x, L[10 * m + i], y)


@kernel
def backward_lanes(m, L, R, base, i, j, k):
    """What `band.backward` does, for every lane."""
    x, j, k = base + 2 * LANES * i, base + 2 * LANES * j, base + 2 * LANES * k
    y = x + LANES
    turn(R, x, y, L[i], L[m + i], L[m + i], L[2 * m + i])
    subtract(R, x, L[7 * m + i], k, L[8 * m + i], k + LANES)
    subtract(R, y, L[9 * m + i], k, L[10 * m + i], k + LANES)
    subtract(R, x, L[3 * m + i], j, L[4 * m + i], j + LANES)
    subtract(R, y, L[5 * m + i], j, L[6 * m + i], j + LANES)


@kernel
def inwards_lanes(n, L, R, base, first, last):
    """What `band.inwards` does, for every lane."""
    m, right = n + 1, n - 1 - last
    both = min(first, right)
    for e in range(both):
        forward_lanes(m, L, R, base, e, e + 1, e + 2)
        forward_lanes(m, L, R, base, n - 1 - e, n - 2 - e, n - 3 - e)
    for e in range(both, first):
        forward_lanes(m, L, R, base, e, e + 1, e + 2)
    for e in range(both, right):
        forward_lanes(m, L, R, base, n - 1 - e, n - 2 - e, n - 3 - e)


@kernel
def outwards_lanes(n, L, R, base, first, last):
    """What `band.outwards` does, for every lane."""
    m, right = n + 1, n - 1 - last
    both = min(first, right)
    for e in range(right - 1, both - 1, -1):
        backward_lanes(m, L, R, base, n - 1 - e, n - 2 - e, n - 3 - e)
    for e in range(first - 1, both - 1, -1):
        backward_lanes(m, L, R, base, e, e + 1, e + 2)
    for e in range(both - 1, -1, -1):
        backward_lanes(m, L, R, base, e, e + 1, e + 2)
        backward_lanes(m, L, R, base, n - 1 - e, n - 2 - e, n - 3 - e)


@kernel
def solve_zone_lanes(n, B, R, base, first, last):
    """What `zone.solve_zone` does, for every lane; rows of the zone follow each other in R."""
    size, row, sheave = 2 * (last - first + 1), base + 2 * LANES * first, base + 2 * LANES * n
    for k in range(size):
        for j in range(k + 1, min(k + WIDTH + 1, size)):
            subtract(R, row + LANES * j, B[ROW * j + WIDTH - (j - k)], row + LANES * k, 0.0, row)
        subtract(R, sheave, B[ROW * size + 2 * k], row + LANES * k, 0.0, row)
        subtract(R, sheave + LANES, B[ROW * size + 2 * k + 1], row + LANES * k, 0.0, row)
    corner = (ROW + 2) * size
    a, b, c, d = B[corner], B[corner + 1], B[corner + 2], B[corner + 3]
    one = 1.0 / (a * d - b * c)
    turn(R, sheave, sheave + LANES, d * one, -b * one, -c * one, a * one)
    for k in range(size - 1, -1, -1):
        at = ROW * k + WIDTH
        subtract(R, row + LANES * k, B[at + WIDTH + 1], sheave, B[at + WIDTH + 2], sheave + LANES)
        for c in range(1, min(WIDTH + 1, size - k)):
            subtract(R, row + LANES * k, B[at + c], row + LANES * (k + c), 0.0, row)
        pivot = 1.0 / B[at]
        for s in range(LANES):
            R[row + LANES * k + s] *= pivot


@kernel
def solve_lanes(n, L, B, R, base, first, last):
    """Solve the factored tangent for one block of right-hand sides, in place."""
    inwards_lanes(n, L, R, base, first, last)
    solve_zone_lanes(n, B, R, base, first, last)
    outwards_lanes(n, L, R, base, first, last)

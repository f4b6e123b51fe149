"""Substitution for many right-hand sides at once, with the factor that `block_band` and `bordered_band` hold.

A recurrence makes one right-hand side wait for itself at every node; LANES of them share each
instruction, and the blocks of LANES fill each other's waiting. Number (node i, component c) of block k
sits at (k 2 m + 2 i + c) LANES of R and has a lane for each of its right-hand sides.
"""

from ...kernels.jit import kernel
from ..runtime.simd import LANES, load, store
from .bordered_band import ROW, WIDTH


@kernel
def forward_lanes(m, L, R, begin, end, i, j, k):
    """What `block_band.forward` does, for every lane."""
    jxx, jyx, jxy, jyy = L[3 * m + i], L[4 * m + i], L[5 * m + i], L[6 * m + i]
    kxx, kyx, kxy, kyy = L[7 * m + i], L[8 * m + i], L[9 * m + i], L[10 * m + i]
    for block in range(begin, end):
        base = 2 * LANES * m * block
        to_i, to_j, to_k = base + 2 * LANES * i, base + 2 * LANES * j, base + 2 * LANES * k
        x, y = load(R, to_i), load(R, to_i + LANES)
        store(R, to_j, load(R, to_j) - jxx * x - jxy * y)
        store(R, to_j + LANES, load(R, to_j + LANES) - jyx * x - jyy * y)
        store(R, to_k, load(R, to_k) - kxx * x - kxy * y)
        store(R, to_k + LANES, load(R, to_k + LANES) - kyx * x - kyy * y)


@kernel
def backward_lanes(m, L, R, begin, end, i, j, k):
    """What `block_band.backward` does, for every lane."""
    dxx, dxy, dyy = L[i], L[m + i], L[2 * m + i]
    jxx, jxy, jyx, jyy = L[3 * m + i], L[4 * m + i], L[5 * m + i], L[6 * m + i]
    kxx, kxy, kyx, kyy = L[7 * m + i], L[8 * m + i], L[9 * m + i], L[10 * m + i]
    for block in range(begin, end):
        base = 2 * LANES * m * block
        to_i, to_j, to_k = base + 2 * LANES * i, base + 2 * LANES * j, base + 2 * LANES * k
        x, y, jx, jy = load(R, to_i), load(R, to_i + LANES), load(R, to_j), load(R, to_j + LANES)
        kx, ky = load(R, to_k), load(R, to_k + LANES)
        store(R, to_i, dxx * x + dxy * y - kxx * kx - kxy * ky - jxx * jx - jxy * jy)
        store(R, to_i + LANES, dxy * x + dyy * y - kyx * kx - kyy * ky - jyx * jx - jyy * jy)


@kernel
def forward_substitute_lanes(n, L, R, begin, end, first, last):
    """What `block_band.forward_substitute` does, for every lane."""
    m, right = n + 1, n - 1 - last
    both = min(first, right)
    for e in range(both):
        forward_lanes(m, L, R, begin, end, e, e + 1, e + 2)
        forward_lanes(m, L, R, begin, end, n - 1 - e, n - 2 - e, n - 3 - e)
    for e in range(both, first):
        forward_lanes(m, L, R, begin, end, e, e + 1, e + 2)
    for e in range(both, right):
        forward_lanes(m, L, R, begin, end, n - 1 - e, n - 2 - e, n - 3 - e)


@kernel
def back_substitute_lanes(n, L, R, begin, end, first, last):
    """What `block_band.back_substitute` does, for every lane."""
    m, right = n + 1, n - 1 - last
    both = min(first, right)
    for e in range(right - 1, both - 1, -1):
        backward_lanes(m, L, R, begin, end, n - 1 - e, n - 2 - e, n - 3 - e)
    for e in range(first - 1, both - 1, -1):
        backward_lanes(m, L, R, begin, end, e, e + 1, e + 2)
    for e in range(both - 1, -1, -1):
        backward_lanes(m, L, R, begin, end, e, e + 1, e + 2)
        backward_lanes(m, L, R, begin, end, n - 1 - e, n - 2 - e, n - 3 - e)


@kernel
def solve_bordered_lanes(n, B, R, base, first, last):
    """What `bordered_band.solve_bordered` does, for every lane of a block; rows of the zone follow each other in R."""
    size, row, sheave = 2 * (last - first + 1), base + 2 * LANES * first, base + 2 * LANES * n
    height, turn = load(R, sheave), load(R, sheave + LANES)
    for k in range(size):
        x = load(R, row + LANES * k)
        for j in range(k + 1, min(k + WIDTH + 1, size)):
            store(R, row + LANES * j, load(R, row + LANES * j) - B[ROW * j + WIDTH - (j - k)] * x)
        height = height - B[ROW * size + 2 * k] * x
        turn = turn - B[ROW * size + 2 * k + 1] * x
    corner = (ROW + 2) * size
    a, b, c, d = B[corner], B[corner + 1], B[corner + 2], B[corner + 3]
    one = 1.0 / (a * d - b * c)
    height, turn = (d * one) * height - (b * one) * turn, (a * one) * turn - (c * one) * height
    store(R, sheave, height)
    store(R, sheave + LANES, turn)
    for k in range(size - 1, -1, -1):
        at = ROW * k + WIDTH
        x = load(R, row + LANES * k) - B[at + WIDTH + 1] * height - B[at + WIDTH + 2] * turn
        for c in range(1, min(WIDTH + 1, size - k)):
            x = x - B[at + c] * load(R, row + LANES * (k + c))
        store(R, row + LANES * k, (1.0 / B[at]) * x)


@kernel
def solve_lanes(n, L, B, R, begin, end, first, last):
    """Solve the factored tangent for the right-hand sides of blocks `begin` .. `end` - 1, in place."""
    forward_substitute_lanes(n, L, R, begin, end, first, last)
    for block in range(begin, end):
        solve_bordered_lanes(n, B, R, 2 * LANES * (n + 1) * block, first, last)
    back_substitute_lanes(n, L, R, begin, end, first, last)

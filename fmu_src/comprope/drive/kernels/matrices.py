"""Matrices (n, n) in flat arrays, each beginning at an index: products, exponential, spectral radius.

All are balanced first: scaled by powers of two on both sides so that rows and columns are of like size, since the states of the
hoist have units as different as metres and newtons.
"""

from math import ceil, exp, log, log2

from ...kernels.jit import kernel

_TERMS = 14  # of Taylor's series: for norms up to a half the next one is below rounding
_LARGEST_NORM = 0.5
_SWEEPS = 20  # at most, of balancing
_SQUARINGS = 60  # after as many, what is left of transients is below rounding


@kernel
def multiply(n, A, a, B, b, C, c):
    """C = A B; C must not overlap A or B."""
    for i in range(n):
        for j in range(n):
            total = 0.0
            for k in range(n):
                total += A[a + n * i + k] * B[b + n * k + j]
            C[c + n * i + j] = total


@kernel
def copy_matrix(n, A, a, C, c):
    """C = A."""
    for k in range(n * n):
        C[c + k] = A[a + k]


@kernel
def balance(n, A, a, D, d):
    """Replace A by D^-1 A D with a diagonal D of powers of two, which is stored as a row."""
    for i in range(n):
        D[d + i] = 1.0
    for _ in range(_SWEEPS):
        changed = False
        for i in range(n):
            column, row = 0.0, 0.0
            for j in range(n):
                if j != i:
                    column += abs(A[a + n * j + i])
                    row += abs(A[a + n * i + j])
            if column == 0.0 or row == 0.0:
                continue
            power = ceil(0.5 * log2(row / column) - 0.5)
            if power == 0.0:
                continue
            factor = 2.0**power
            changed = True
            D[d + i] *= factor
            for j in range(n):
                A[a + n * j + i] *= factor
                A[a + n * i + j] /= factor
        if not changed:
            break


@kernel
def norm(n, A, a):
    """The largest sum of the absolute values of a row."""
    largest = 0.0
    for i in range(n):
        total = 0.0
        for j in range(n):
            total += abs(A[a + n * i + j])
        largest = max(largest, total)
    return largest


@kernel
def exponential(n, A, a, R, r, w, d):
    """R[r] = exp(A), by scaling and squaring of Taylor's series; A is lost, R[w] and the row R[d] are for the computation."""
    balance(n, A, a, R, d)
    halvings = 0
    size = norm(n, A, a)
    while size > _LARGEST_NORM:
        size *= 0.5
        halvings += 1
    scale = 0.5**halvings
    for k in range(n * n):
        A[a + k] *= scale
        R[r + k] = 0.0
    for i in range(n):
        R[r + (n + 1) * i] = 1.0
    for term in range(_TERMS, 0, -1):  # R = 1 + A R / term
        multiply(n, A, a, R, r, R, w)
        for k in range(n * n):
            R[r + k] = R[w + k] / term
        for i in range(n):
            R[r + (n + 1) * i] += 1.0
    for _ in range(halvings):
        copy_matrix(n, R, r, R, w)
        multiply(n, R, w, R, w, R, r)
    for i in range(n):
        for j in range(n):
            R[r + n * i + j] *= R[d + i] / R[d + j]


@kernel
def spectral_radius(n, A, a, w, d):
    """The largest absolute value of A's eigenvalues, from the growth of its powers; A is lost, A[w] and the row A[d] too.

    The radius is the limit of |A^m|^(1/m), here for m = 2^60; rounding in the k-th squaring counts with a weight of 2^-k.
    """
    balance(n, A, a, A, d)
    logarithm, weight = 0.0, 1.0
    for _ in range(_SQUARINGS):
        size = norm(n, A, a)
        if size == 0.0:
            return 0.0
        logarithm += weight * log(size)
        weight *= 0.5
        for k in range(n * n):
            A[w + k] = A[a + k] / size
        multiply(n, A, w, A, w, A, a)
    return exp(logarithm)

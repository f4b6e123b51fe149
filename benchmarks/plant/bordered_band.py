"""A band of half-width 5 with two columns and rows of the sheave beside it; no pivoting."""

from .jit import kernel


@kernel
def factor(A, N):
    """Overwrite the band A [N + 5, 11] by its factors, with reciprocal pivots on the diagonal; rows from N on are identity."""
    for k in range(N):
        pivot = 1.0 / A[k, 5]
        A[k, 5] = pivot
        for i in range(1, 6):
            f = A[k + i, 5 - i] * pivot
            A[k + i, 5 - i] = f
            for j in range(1, 6):
                A[k + i, 5 - i + j] -= f * A[k, 5 + j]


@kernel
def solve(A, N, x):
    """x = A^-1 x; x has five zeros before its N values and five after."""
    for k in range(N):
        far = A[k, 0] * x[k] + A[k, 1] * x[k + 1] + A[k, 2] * x[k + 2] + A[k, 3] * x[k + 3]
        x[k + 5] = (x[k + 5] - far) - A[k, 4] * x[k + 4]
    for k in range(N - 1, -1, -1):
        far = A[k, 7] * x[k + 7] + A[k, 8] * x[k + 8] + A[k, 9] * x[k + 9] + A[k, 10] * x[k + 10]
        x[k + 5] = ((x[k + 5] - far) - A[k, 6] * x[k + 6]) * A[k, 5]


@kernel
def bordered(A, N, B, C, D, S, x, fresh):
    """Solve [A B; C D] x = r in place, x [5 + N + 2 + 3]: band in x[5:5 + N], sheave in S [2, 2] (work) and x[5 + N:].

    B [2, N + 10] holds the sheave's columns and becomes A^-1 B when `fresh`; C [2, N] its rows; D [2, 2] its own block.
    """
    rs0, rs1 = x[5 + N], x[6 + N]
    x[5 + N] = x[6 + N] = 0.0
    if fresh:
        for s in range(2):
            solve(A, N, B[s])
            for w in range(2):
                S[w, s] = D[w, s]
        for w in range(2):
            for s in range(2):
                total = 0.0
                for k in range(N):
                    total += C[w, k] * B[s, k + 5]
                S[w, s] -= total
    solve(A, N, x)
    for k in range(N):
        rs0 -= C[0, k] * x[k + 5]
        rs1 -= C[1, k] * x[k + 5]
    det = S[0, 0] * S[1, 1] - S[0, 1] * S[1, 0]
    u0 = (S[1, 1] * rs0 - S[0, 1] * rs1) / det
    u1 = (S[0, 0] * rs1 - S[1, 0] * rs0) / det
    for k in range(N):
        x[k + 5] -= B[0, k + 5] * u0 + B[1, k + 5] * u1
    x[5 + N], x[6 + N] = u0, u1

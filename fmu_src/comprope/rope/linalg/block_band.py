"""Elimination of the rope from both ends towards the sheave.

Away from the sheave the tangent is symmetric, so nodes are eliminated in 2 x 2 blocks from the car's
end (left) and from the counterweight's end (right) at once; the two recurrences do not depend on
each other and overlap in the processor. What is left is the zone of nodes near the sheave, where friction
makes the tangent unsymmetric and the sheave's height and angle border it: `bordered_band` solves it, and
the back substitution runs from there to both ends.

Section layout of the factor L: inverse of the pivot block (3), then the blocks U1 = D^-1 E towards
the next node and U2 = D^-1 G towards the one after (4 each), "next" being nearer to the sheave.
"""

from ...kernels.jit import kernel
from ..runtime.array_layout import DXX, DXY, DYY, EXX, EXY, EYX, EYY, GXX, GXY, GYX, GYY

FACTOR = 11


@kernel
def forward(m, L, r, i, j, k):
    """Carry the right-hand side r of node i to its neighbours j and k."""
    x, y = r[i], r[m + i]
    r[j] -= L[3 * m + i] * x + L[5 * m + i] * y
    r[m + j] -= L[4 * m + i] * x + L[6 * m + i] * y
    r[k] -= L[7 * m + i] * x + L[9 * m + i] * y
    r[m + k] -= L[8 * m + i] * x + L[10 * m + i] * y


@kernel
def eliminate(m, A, L, r, i, back):
    """Eliminate node i, which couples to nodes j (next) and k (after next), and update their blocks.

    `back` is 0 from the left end and 1 from the right end, where the blocks i-j, i-k and j-k are stored transposed in
    the columns of j and k. The right-hand side r follows.
    """
    j, k = i + 1 - 2 * back, i + 2 - 4 * back
    ebase, gbase, cross = i - back, i - 2 * back, i + 1 - 3 * back
    dxx, dxy, dyy = A[DXX * m + i], A[DXY * m + i], A[DYY * m + i]
    one = 1.0 / (dxx * dyy - dxy * dxy)
    ixx, ixy, iyy = dyy * one, -dxy * one, dxx * one
    s, u = EXY + back, EYX - back
    exx, exy, eyx, eyy = A[EXX * m + ebase], A[s * m + ebase], A[u * m + ebase], A[EYY * m + ebase]
    o, w = GXY + back, GYX - back
    gxx, gxy, gyx, gyy = A[GXX * m + gbase], A[o * m + gbase], A[w * m + gbase], A[GYY * m + gbase]
    axx, axy = ixx * exx + ixy * eyx, ixx * exy + ixy * eyy
    ayx, ayy = ixy * exx + iyy * eyx, ixy * exy + iyy * eyy
    bxx, bxy = ixx * gxx + ixy * gyx, ixx * gxy + ixy * gyy
    byx, byy = ixy * gxx + iyy * gyx, ixy * gxy + iyy * gyy
    L[i], L[m + i], L[2 * m + i] = ixx, ixy, iyy
    L[3 * m + i], L[4 * m + i], L[5 * m + i], L[6 * m + i] = axx, axy, ayx, ayy
    L[7 * m + i], L[8 * m + i], L[9 * m + i], L[10 * m + i] = bxx, bxy, byx, byy
    A[DXX * m + j] -= exx * axx + eyx * ayx
    A[DXY * m + j] -= exx * axy + eyx * ayy
    A[DYY * m + j] -= exy * axy + eyy * ayy
    A[EXX * m + cross] -= exx * bxx + eyx * byx
    A[s * m + cross] -= exx * bxy + eyx * byy
    A[u * m + cross] -= exy * bxx + eyy * byx
    A[EYY * m + cross] -= exy * bxy + eyy * byy
    A[DXX * m + k] -= gxx * bxx + gyx * byx
    A[DXY * m + k] -= gxx * bxy + gyx * byy
    A[DYY * m + k] -= gxy * bxy + gyy * byy
    forward(m, L, r, i, j, k)


@kernel
def factor(n, A, L, r, first, last):
    """Eliminate nodes 0 .. first-1 and n-1 .. last+1; A keeps the Schur complement of first .. last.

    The right-hand side r is carried along, as `forward_substitute` would do it.
    """
    m, right = n + 1, n - 1 - last
    both = min(first, right)
    for e in range(both):
        eliminate(m, A, L, r, e, 0)
        eliminate(m, A, L, r, n - 1 - e, 1)
    for e in range(both, first):
        eliminate(m, A, L, r, e, 0)
    for e in range(both, right):
        eliminate(m, A, L, r, n - 1 - e, 1)


@kernel
def backward(m, L, r, i, j, k):
    """Replace node i's right-hand side by its solution, given those of j and k."""
    x, y, jx, jy, kx, ky = r[i], r[m + i], r[j], r[m + j], r[k], r[m + k]
    r[i] = (
        L[i] * x + L[m + i] * y
        - (L[7 * m + i] * kx + L[8 * m + i] * ky)
        - (L[3 * m + i] * jx + L[4 * m + i] * jy)
    )  # fmt: skip
    r[m + i] = (
        L[m + i] * x + L[2 * m + i] * y
        - (L[9 * m + i] * kx + L[10 * m + i] * ky)
        - (L[5 * m + i] * jx + L[6 * m + i] * jy)
    )  # fmt: skip


@kernel
def forward_substitute(n, L, r, first, last):
    """Forward substitution from both ends to the zone first .. last."""
    m, right = n + 1, n - 1 - last
    both = min(first, right)
    for e in range(both):
        forward(m, L, r, e, e + 1, e + 2)
        forward(m, L, r, n - 1 - e, n - 2 - e, n - 3 - e)
    for e in range(both, first):
        forward(m, L, r, e, e + 1, e + 2)
    for e in range(both, right):
        forward(m, L, r, n - 1 - e, n - 2 - e, n - 3 - e)


@kernel
def back_substitute(n, L, r, first, last):
    """Back substitution from the zone first .. last, already solved, to both ends."""
    m, right = n + 1, n - 1 - last
    both = min(first, right)
    for e in range(right - 1, both - 1, -1):
        backward(m, L, r, n - 1 - e, n - 2 - e, n - 3 - e)
    for e in range(first - 1, both - 1, -1):
        backward(m, L, r, e, e + 1, e + 2)
    for e in range(both - 1, -1, -1):
        backward(m, L, r, e, e + 1, e + 2)
        backward(m, L, r, n - 1 - e, n - 2 - e, n - 3 - e)

"""The nodes near the sheave, with the sheave's height and angle as a border: unsymmetric and small.

Rows of the zone are scalar equations in the order x, y of each node: `ROW` numbers per row, the band
of the five entries before the diagonal to the five after it, then the two columns of the border.
The border's own two rows are stored column by column at the end, before its 2 x 2 corner.
Elimination is without pivoting: the tangent is close to a positive definite one.
"""

from ...kernels.jit import kernel
from ..runtime.array_layout import COLUMNS, CONTACT, DXX, DXY, DYY, EXX, GXX, ROWS

WIDTH = 5
ROW = 2 * WIDTH + 3


@kernel
def assemble_bordered(n, A, Z, B, first, last):
    """Copy the Schur complement A, the contact tangent Z and the sheave's block into B."""
    m, size = n + 1, 2 * (last - first + 1)
    for k in range(ROW * size):
        B[k] = 0.0
    for i in range(first, last + 1):
        row = 2 * (i - first)
        for side in range(-2, 3):
            if first <= i + side <= last:
                copy_block(m, A, Z, B, row, i, side)
        for c in range(2):
            for k in range(2):
                B[ROW * (row + c) + 2 * WIDTH + 1 + k] = Z[(COLUMNS + 2 * c + k) * m + i]
                B[ROW * size + 2 * (row + c) + k] = Z[(ROWS + 2 * k + c) * m + i]
    corner = (ROW + 2) * size
    B[corner] = A[DXX * m + n] + Z[CONTACT * m]
    B[corner + 1] = A[DXY * m + n] + Z[CONTACT * m + 1]
    B[corner + 2] = A[DXY * m + n] + Z[CONTACT * m + 2]
    B[corner + 3] = A[DYY * m + n] + Z[CONTACT * m + 3]


@kernel
def copy_block(m, A, Z, B, row, i, side):
    """Copy the 2 x 2 block of node i with node i + side into rows `row`, `row + 1`."""
    for c in range(2):
        for d in range(2):
            if side == 0:
                rope = A[(DXX + c + d) * m + i]
            elif side > 0:
                rope = A[((EXX if side == 1 else GXX) + 2 * c + d) * m + i]
            else:
                rope = A[((EXX if side == -1 else GXX) + 2 * d + c) * m + i + side]
            B[ROW * (row + c) + WIDTH + 2 * side + d - c] = rope + Z[(4 * (side + 2) + 2 * c + d) * m + i]


@kernel
def factor_bordered(size, B):
    """Factor the bordered band of `size` rows in place; multipliers replace what they eliminate."""
    corner = (ROW + 2) * size
    for k in range(size):
        pivot = 1.0 / B[ROW * k + WIDTH]
        for r in range(k + 1, min(k + WIDTH + 1, size)):
            at = ROW * r + WIDTH - (r - k)
            ratio = B[at] * pivot
            B[at] = ratio
            for c in range(1, WIDTH + 1):
                B[at + c] -= ratio * B[ROW * k + WIDTH + c]
            for c in range(2):
                B[ROW * r + 2 * WIDTH + 1 + c] -= ratio * B[ROW * k + 2 * WIDTH + 1 + c]
        for s in range(2):
            at = ROW * size + 2 * k + s
            ratio = B[at] * pivot
            B[at] = ratio
            for c in range(1, min(WIDTH + 1, size - k)):
                B[at + 2 * c] -= ratio * B[ROW * k + WIDTH + c]
            for c in range(2):
                B[corner + 2 * s + c] -= ratio * B[ROW * k + 2 * WIDTH + 1 + c]


@kernel
def solve_bordered(n, B, r, first, last):
    """Solve the factored zone for the right-hand side r, in place; the sheave's part is column n."""
    m, size = n + 1, 2 * (last - first + 1)
    corner = (ROW + 2) * size
    for k in range(size):
        value = r[(k % 2) * m + first + k // 2]
        for j in range(k + 1, min(k + WIDTH + 1, size)):
            r[(j % 2) * m + first + j // 2] -= B[ROW * j + WIDTH - (j - k)] * value
        r[n] -= B[ROW * size + 2 * k] * value
        r[m + n] -= B[ROW * size + 2 * k + 1] * value
    a, b, c, d = B[corner], B[corner + 1], B[corner + 2], B[corner + 3]
    determinant = a * d - b * c
    height, turn = (d * r[n] - b * r[m + n]) / determinant, (a * r[m + n] - c * r[n]) / determinant
    r[n], r[m + n] = height, turn
    for k in range(size - 1, -1, -1):
        at = ROW * k + WIDTH
        value = r[(k % 2) * m + first + k // 2] - B[at + WIDTH + 1] * height - B[at + WIDTH + 2] * turn
        for c in range(1, min(WIDTH + 1, size - k)):
            value -= B[at + c] * r[((k + c) % 2) * m + first + (k + c) // 2]
        r[(k % 2) * m + first + k // 2] = value / B[at]

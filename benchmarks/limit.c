// The least work of one Newton iteration: a symmetric band of half-width 5 (two unknowns a node, neighbours to two
// nodes away) with a border of two, for the sheave's height and angle. Factor L D L' without pivoting, three right-hand
// sides (the residual and the two columns of the border), and the 2 x 2 Schur complement.
//
// a[6 i + k] = A(i, i - k), with five rows of the identity behind the last one, so that no bounds need checks.
// l[6 j] = 1 / D(j), l[6 j + k] = L(j + k, j). Right-hand sides interleave: b[3 i + c].
#include <time.h>

#define W 5
#define UNROLL _Pragma("GCC unroll 8")

static void factor(long n, const double *restrict a, double *restrict l) {
    double s[W][W]; // what is left of rows j .. j + 4 below and on the diagonal
    UNROLL for (int r = 0; r < W; r++) UNROLL for (int c = 0; c <= r; c++) s[r][c] = a[6 * r + r - c];
    for (long j = 0; j < n; j++) {
        const double *next = a + 6 * (j + W);
        double column[W + 1], ratio[W + 1], one = 1.0 / s[0][0];
        UNROLL for (int k = 1; k < W; k++) column[k] = s[k][0];
        column[W] = next[W];
        l[6 * j] = one;
        UNROLL for (int k = 1; k <= W; k++) l[6 * j + k] = ratio[k] = column[k] * one;
        UNROLL for (int r = 1; r <= W; r++) UNROLL for (int c = 1; c <= r; c++)
            s[r - 1][c - 1] = (r < W ? s[r][c] : next[W - c]) - ratio[r] * column[c];
    }
}

static void solve(long n, const double *restrict l, double *restrict b) {
    double w[W + 1][3], y[W + 1][3];
    UNROLL for (int k = 0; k < W; k++) UNROLL for (int c = 0; c < 3; c++) w[k][c] = b[3 * k + c];
    for (long j = 0; j < n; j++) {
        UNROLL for (int c = 0; c < 3; c++) {
            double x = w[0][c];
            w[W][c] = b[3 * (j + W) + c];
            b[3 * j + c] = x * l[6 * j];
            UNROLL for (int k = 1; k <= W; k++) w[k - 1][c] = w[k][c] - l[6 * j + k] * x;
        }
    }
    UNROLL for (int k = 0; k <= W; k++) UNROLL for (int c = 0; c < 3; c++) y[k][c] = 0.0;
    for (long j = n - 1; j >= 0; j--) {
        UNROLL for (int c = 0; c < 3; c++) {
            double x = b[3 * j + c];
            UNROLL for (int k = W; k >= 1; k--) x -= l[6 * j + k] * y[k - 1][c];
            UNROLL for (int k = W - 1; k >= 1; k--) y[k][c] = y[k - 1][c];
            b[3 * j + c] = y[0][c] = x;
        }
    }
}

static void border(long n, const double *restrict c, double *restrict b) {
    double s00 = 1e3, s01 = 0.0, s11 = 1e3, g0 = 1.0, g1 = 1.0;
    for (long i = 0; i < n; i++) {
        s00 -= c[2 * i] * b[3 * i + 1];
        s01 -= c[2 * i] * b[3 * i + 2];
        s11 -= c[2 * i + 1] * b[3 * i + 2];
        g0 -= c[2 * i] * b[3 * i];
        g1 -= c[2 * i + 1] * b[3 * i];
    }
    double d = s00 * s11 - s01 * s01, z0 = (s11 * g0 - s01 * g1) / d, z1 = (s00 * g1 - s01 * g0) / d;
    for (long i = 0; i < n; i++) b[3 * i] -= b[3 * i + 1] * z0 + b[3 * i + 2] * z1;
}

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e6 * t.tv_sec + 1e-3 * t.tv_nsec;
}

// Shortest time of `repeats` whole solutions [us]; b holds the solution of the last.
double limit(long n, const double *a, double *l, double *b, const double *b0, const double *c, long repeats) {
    double shortest = 1e300;
    for (long k = 0; k < repeats; k++) {
        for (long i = 0; i < 3 * (n + W); i++) b[i] = b0[i];
        double start = now();
        factor(n, a, l);
        solve(n, l, b);
        border(n, c, b);
        double took = now() - start;
        if (took < shortest) shortest = took;
    }
    return shortest;
}

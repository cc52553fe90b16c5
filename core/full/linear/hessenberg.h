/* The small least-squares problem of generalised minimal residuals (Saad & Schultz 1986): the
 * matrix by which products stand in the basis, made upper triangular column by column. Private to
 * core/full/linear. */
#ifndef RUGO_CORE_FULL_LINEAR_HESSENBERG_H
#define RUGO_CORE_FULL_LINEAR_HESSENBERG_H

#include <math.h>
#include <stddef.h>

enum { HESSENBERG_MOST = 120 };
struct hessenberg {
    double h[HESSENBERG_MOST + 1][HESSENBERG_MOST]; /* filled by the caller, a column a step */
    double cosine[HESSENBERG_MOST], sine[HESSENBERG_MOST];
    double right[HESSENBERG_MOST + 1]; /* right[0] is the size of the first residual */
};

/* Makes column c upper triangular by Givens' rotations. Returns the size of the residual. */
static inline double hessenberg_rotate(struct hessenberg *of, size_t c) {
    double(*h)[HESSENBERG_MOST] = of->h;
    for (size_t a = 0; a < c; a++) {
        double upper = h[a][c], lower = h[a + 1][c];
        h[a][c] = of->cosine[a] * upper + of->sine[a] * lower;
        h[a + 1][c] = of->cosine[a] * lower - of->sine[a] * upper;
    }
    double size = hypot(h[c][c], h[c + 1][c]);
    of->cosine[c] = h[c][c] / size;
    of->sine[c] = h[c + 1][c] / size;
    h[c][c] = size;
    of->right[c + 1] = -of->sine[c] * of->right[c];
    of->right[c] *= of->cosine[c];
    return fabs(of->right[c + 1]);
}

/* Fills factor[count] of the directions in the solution, of rotated columns. */
static inline void hessenberg_solve(const struct hessenberg *of, size_t count, double *factor) {
    for (size_t a = count; a-- > 0;) {
        factor[a] = of->right[a];
        for (size_t b = a + 1; b < count; b++)
            factor[a] -= of->h[a][b] * factor[b];
        factor[a] /= of->h[a][a];
    }
}

#endif

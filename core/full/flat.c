#include "core/full/flat.h"
#include "core/surface/transform.h"
#include "core/vectors.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

#define INLINE static inline __attribute__((always_inline))

/* Arrays by wave hold `waves` values in the layout of transform.h, innermost. */
struct flat {
    const struct mesh *mesh; /* borrowed */
    struct transform *transform;
    size_t d, waves;
    double *inverse;  /* [level][i*d + j][wave]: of the level's pivot, which holds all below it */
    double *coupling; /* [level][i*d + j][wave]: row of the level, column of the next */
    double *field;    /* [level][i][2][wave]: real and imaginary parts of forces, displacements */
    double *plane;    /* face: one component of one level */
};

static double *inverse_at(const struct flat *f, size_t level) {
    return f->inverse + level * f->d * f->d * f->waves;
}
static double *coupling_at(const struct flat *f, size_t level) {
    return f->coupling + level * f->d * f->d * f->waves;
}
static double *field_at(const struct flat *f, size_t level, size_t i) {
    return f->field + (level * f->d + i) * 2 * f->waves;
}

/* --- elimination --- */

/* Stiffness of one layer between its sides (0 the upper), by the step sideways from one node to
 * another: -1, 0, 1 in x, then y. */
struct layer {
    double block[2][2][9][3][3];
};

static void layer_make(const struct mesh *mesh, const struct solid *solid, double thickness,
                       struct layer *out) {
    int d = mesh->dimension;
    double position[8][3], u[8][3] = {{0}}, stiffness[ELEMENT_FREEDOMS][ELEMENT_FREEDOMS];
    struct element_shape shape;
    memset(out, 0, sizeof *out);
    for (int a = 0; a < 1 << d; a++) {
        position[a][0] = a & 1;
        position[a][1] = (a >> 1 & 1) * mesh->across;
        position[a][d - 1] = (a >> (d - 1) & 1) * thickness;
    }
    /* A brick at rest: nothing to fail. */
    (void)element_shape_make(d, position, &shape);
    (void)element_evaluate(d, solid, &shape, u, NULL, NULL, stiffness);
    for (int a = 0; a < 1 << d; a++)
        for (int b = 0; b < 1 << d; b++) {
            int along = (b & 1) - (a & 1) + 1;
            int across = d == 2 ? 1 : (b >> 1 & 1) - (a >> 1 & 1) + 1;
            double(*block)[3] = out->block[a >> (d - 1) & 1][b >> (d - 1) & 1][across * 3 + along];
            for (int i = 0; i < d; i++)
                for (int j = 0; j < d; j++)
                    block[i][j] += stiffness[a * d + i][b * d + j];
        }
}

/* cos and sin of a wave's phase over each step. */
struct phases {
    double cosine[9], sine[9];
};

static struct phases phases_of(const struct mesh *mesh, size_t mx, size_t row) {
    struct phases phases;
    double x = 2 * PI * (double)mx / (double)mesh->nx, y = 2 * PI * (double)row / (double)mesh->ny;
    for (int slot = 0; slot < 9; slot++) {
        int along = slot % 3 - 1, across = slot / 3 - 1;
        double phase = x * along + y * across;
        phases.cosine[slot] = cos(phase);
        phases.sine[slot] = sin(phase);
    }
    return phases;
}

/* The symbol of one layer between two sides, real as the header says. */
static void symbol(int d, double block[9][3][3], const struct phases *phases, double out[3][3]) {
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++) {
            bool up = i == d - 1, right = j == d - 1;
            out[i][j] = 0;
            for (int slot = 0; slot < 9; slot++)
                out[i][j] += block[slot][i][j] * (up == right ? phases->cosine[slot]
                                                  : up        ? -phases->sine[slot]
                                                              : phases->sine[slot]);
        }
}

/* Inverse of a symmetric positive definite matrix, by Gauss and Jordan without pivoting. */
static void invert(int d, double a[3][3], double out[3][3]) {
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            out[i][j] = i == j;
    for (int p = 0; p < d; p++) {
        double pivot = 1 / a[p][p];
        for (int j = 0; j < d; j++) {
            a[p][j] *= pivot;
            out[p][j] *= pivot;
        }
        for (int i = 0; i < d; i++) {
            double factor = a[i][p];
            for (int j = 0; i != p && j < d; j++) {
                a[i][j] -= factor * a[p][j];
                out[i][j] -= factor * out[p][j];
            }
        }
    }
}

/* The far side: Z is 0 but for the mean wave, whose X and Y float. */
static void hold_far_side(int d, bool mean, double pivot[3][3]) {
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++) {
            bool held = mean ? i < d - 1 && i == j : i == d - 1 || j == d - 1;
            if (held)
                pivot[i][j] = mean ? pivot[i][j] + 1 : i == j;
        }
}

static void eliminate(struct flat *f, const struct layer *layers, size_t wave, size_t mx,
                      size_t row) {
    int d = f->mesh->dimension;
    size_t last = f->mesh->layers;
    bool mean = mx == 0 && row == 0;
    struct phases phases = phases_of(f->mesh, mx, row);
    double pivot[3][3], near[3][3], between[3][3], inverse[3][3];
    for (size_t level = last + 1; level-- > 0;) {
        memset(pivot, 0, sizeof pivot);
        if (level < last) {
            const double *below = inverse_at(f, level + 1);
            struct layer layer = layers[level];
            symbol(d, layer.block[0][0], &phases, pivot);
            symbol(d, layer.block[0][1], &phases, between);
            for (int i = 0; level + 1 == last && !mean && i < d; i++)
                between[i][d - 1] = 0;
            for (int i = 0; i < d; i++)
                for (int j = 0; j < d; j++) {
                    coupling_at(f, level)[(size_t)(i * d + j) * f->waves + wave] = between[i][j];
                    for (int k = 0; k < d; k++)
                        for (int l = 0; l < d; l++)
                            pivot[i][j] -= between[i][k] * between[j][l] *
                                           below[(size_t)(k * d + l) * f->waves + wave];
                }
        }
        if (level > 0) {
            struct layer layer = layers[level - 1];
            symbol(d, layer.block[1][1], &phases, near);
            for (int i = 0; i < d; i++)
                for (int j = 0; j < d; j++)
                    pivot[i][j] += near[i][j];
        }
        if (level == last)
            hold_far_side(d, mean, pivot);
        if (level == 0 && mean) /* floats: whatever carries the load tells where it is */
            for (int i = 0; i < d; i++)
                pivot[i][d - 1] = pivot[d - 1][i] = i == d - 1;
        invert(d, pivot, inverse);
        if (level == 0 && mean)
            inverse[d - 1][d - 1] = 0;
        for (int i = 0; i < d; i++)
            for (int j = 0; j < d; j++)
                inverse_at(f, level)[(size_t)(i * d + j) * f->waves + wave] = inverse[i][j];
    }
}

static int eliminate_all(struct flat *f, const struct solid *solid, struct error *err) {
    const struct mesh *mesh = f->mesh;
    struct layer *layers = array_create(mesh->layers, sizeof *layers);
    if (layers == NULL)
        return error_memory(err, mesh->layers * sizeof *layers, "the flat block");
    for (size_t k = 0; k < mesh->layers; k++)
        layer_make(mesh, solid, mesh->depth[k + 1] - mesh->depth[k], &layers[k]);
    for (size_t wave = 0; wave < f->waves; wave++)
        eliminate(f, layers, wave, wave / mesh->ny, wave % mesh->ny);
    free(layers);
    return 0;
}

int flat_create(struct flat **out, const struct mesh *mesh, const struct solid *solid,
                struct error *err) {
    *out = NULL;
    struct flat *f = array_create(1, sizeof *f);
    if (f == NULL)
        return error_memory(err, sizeof *f, "the flat block");
    size_t d = (size_t)mesh->dimension, levels = mesh->layers + 1;
    struct grid grid = {mesh->nx, mesh->ny, (double)mesh->nx, (double)mesh->ny * mesh->across};
    f->mesh = mesh;
    f->d = d;
    f->waves = (mesh->nx / 2 + 1) * mesh->ny;
    f->inverse = array_create(levels * d * d * f->waves, sizeof *f->inverse);
    f->coupling = array_create(levels * d * d * f->waves, sizeof *f->coupling);
    f->field = array_create(levels * d * 2 * f->waves, sizeof *f->field);
    f->plane = array_create(mesh->face, sizeof *f->plane);
    int status = 0;
    if (!f->inverse || !f->coupling || !f->field || !f->plane)
        status = error_memory(err, levels * d * (2 * d + 2) * f->waves * sizeof(double),
                              "the flat block");
    if (status == 0)
        status = transform_create(&f->transform, &grid, mesh->nx / 2, mesh->ny / 2, err);
    if (status == 0)
        status = eliminate_all(f, solid, err);
    if (status != 0)
        flat_destroy(&f);
    *out = f;
    return status;
}

void flat_destroy(struct flat **flat) {
    struct flat *f = *flat;
    if (f == NULL)
        return;
    transform_destroy(&f->transform);
    free(f->inverse);
    free(f->coupling);
    free(f->field);
    free(f->plane);
    free(f);
    *flat = NULL;
}

const double *flat_compliance(const struct flat *f) {
    return inverse_at(f, 0) + (f->d * f->d - 1) * f->waves;
}

/* --- waves in and out --- */

/* A component's plane into the field. Its spectrum s stands for X and Y as -i s. */
static void plane_in(struct flat *f, size_t level, size_t i) {
    double *re = field_at(f, level, i), *im = re + f->waves;
    transform_forward(f->transform, f->plane);
    const double complex *s = transform_spectrum(f->transform);
    bool vertical = i == f->d - 1;
    for (size_t k = 0; k < f->waves; k++) {
        re[k] = vertical ? creal(s[k]) : cimag(s[k]);
        im[k] = vertical ? cimag(s[k]) : -creal(s[k]);
    }
}

static void plane_out(struct flat *f, size_t level, size_t i) {
    const double *re = field_at(f, level, i), *im = re + f->waves;
    double complex *s = transform_spectrum(f->transform);
    bool vertical = i == f->d - 1;
    for (size_t k = 0; k < f->waves; k++)
        s[k] = vertical ? re[k] + im[k] * I : -im[k] + re[k] * I;
    transform_inverse(f->transform, f->plane);
}

/* y -= a x, a one real value a wave, x and y real and imaginary parts. */
WIDE_VECTORS static void subtract(size_t n, const double *a, const double *x, double *y) {
    for (size_t k = 0; k < n; k++) {
        y[k] -= a[k] * x[k];
        y[n + k] -= a[k] * x[n + k];
    }
}

/* x = inverse x at one level. */
WIDE_VECTORS static void pivot_two(size_t n, const double *a, double *x, double *y) {
    for (size_t k = 0; k < n; k++)
        for (size_t part = 0; part < 2; part++) {
            double u = x[part * n + k], v = y[part * n + k];
            x[part * n + k] = a[k] * u + a[n + k] * v;
            y[part * n + k] = a[2 * n + k] * u + a[3 * n + k] * v;
        }
}

WIDE_VECTORS static void pivot_three(size_t n, const double *a, double *x, double *y, double *z) {
    for (size_t k = 0; k < n; k++)
        for (size_t part = 0; part < 2; part++) {
            double u = x[part * n + k], v = y[part * n + k], w = z[part * n + k];
            x[part * n + k] = a[k] * u + a[n + k] * v + a[2 * n + k] * w;
            y[part * n + k] = a[3 * n + k] * u + a[4 * n + k] * v + a[5 * n + k] * w;
            z[part * n + k] = a[6 * n + k] * u + a[7 * n + k] * v + a[8 * n + k] * w;
        }
}

static void pivot_apply(struct flat *f, size_t level) {
    if (f->d == 2)
        pivot_two(f->waves, inverse_at(f, level), field_at(f, level, 0), field_at(f, level, 1));
    else
        pivot_three(f->waves, inverse_at(f, level), field_at(f, level, 0), field_at(f, level, 1),
                    field_at(f, level, 2));
}

void flat_load(struct flat *f, const double *forces) {
    const struct mesh *mesh = f->mesh;
    size_t d = f->d, last = mesh->layers;
    for (size_t level = 0; level <= last; level++)
        for (size_t i = 0; i < d; i++) {
            for (size_t node = 0; node < mesh->face; node++)
                f->plane[node] = forces[(level * mesh->face + node) * d + i];
            plane_in(f, level, i);
        }
    double *far_side = field_at(f, last, d - 1);
    for (size_t k = 1; k < f->waves; k++)
        far_side[k] = far_side[f->waves + k] = 0;
    for (size_t level = last; level > 0; level--) {
        /* Below, the field keeps the displacements under its own load alone. */
        pivot_apply(f, level);
        for (size_t i = 0; i < d; i++)
            for (size_t j = 0; j < d; j++)
                subtract(f->waves, coupling_at(f, level - 1) + (i * d + j) * f->waves,
                         field_at(f, level, j), field_at(f, level - 1, i));
    }
}

/* Z of pivot times forces of the face; flat_displace still needs these. */
void flat_face(struct flat *f, double *vertical) {
    size_t n = f->waves, d = f->d;
    double complex *s = transform_spectrum(f->transform);
    for (size_t k = 0; k < n; k++)
        s[k] = 0;
    for (size_t j = 0; j < d; j++) {
        const double *a = inverse_at(f, 0) + ((d - 1) * d + j) * n, *x = field_at(f, 0, j);
        for (size_t k = 0; k < n; k++)
            s[k] += a[k] * x[k] + a[k] * x[n + k] * I;
    }
    transform_inverse(f->transform, vertical);
}

/* The next level's displacements less pivot times coupling^T times this level's. */
INLINE void descend(size_t d, size_t n, const double *pivot, const double *coupling,
                    const double *above, double *below) {
    for (size_t part = 0; part < 2; part++)
        for (size_t k = 0; k < n; k++) {
            double pull[3] = {0};
            for (size_t j = 0; j < d; j++)
                for (size_t i = 0; i < d; i++)
                    pull[j] += coupling[(i * d + j) * n + k] * above[(2 * i + part) * n + k];
            for (size_t i = 0; i < d; i++)
                for (size_t j = 0; j < d; j++)
                    below[(2 * i + part) * n + k] -= pivot[(i * d + j) * n + k] * pull[j];
        }
}

WIDE_VECTORS static void descend_two(size_t n, const double *pivot, const double *coupling,
                                     const double *above, double *below) {
    descend(2, n, pivot, coupling, above, below);
}

WIDE_VECTORS static void descend_three(size_t n, const double *pivot, const double *coupling,
                                       const double *above, double *below) {
    descend(3, n, pivot, coupling, above, below);
}

void flat_displace(struct flat *f, const double *vertical, double *displacements) {
    const struct mesh *mesh = f->mesh;
    size_t d = f->d, n = f->waves;
    double *re = field_at(f, 0, d - 1);
    transform_forward(f->transform, vertical);
    const double complex *s = transform_spectrum(f->transform);
    for (size_t k = 0; k < n; k++) {
        re[k] += creal(s[k]);
        re[n + k] += cimag(s[k]);
    }
    pivot_apply(f, 0);
    for (size_t level = 0; level < mesh->layers; level++)
        (d == 2 ? descend_two : descend_three)(n, inverse_at(f, level + 1), coupling_at(f, level),
                                               field_at(f, level, 0), field_at(f, level + 1, 0));
    for (size_t level = 0; level <= mesh->layers; level++)
        for (size_t i = 0; i < d; i++) {
            plane_out(f, level, i);
            for (size_t node = 0; node < mesh->face; node++)
                displacements[(level * mesh->face + node) * d + i] = f->plane[node];
        }
}

#include "core/full/linear/preconditioner.h"
#include "core/full/element.h"
#include "core/full/linear/aliasing.h"
#include "core/full/mesh.h"
#include "core/surface/transform.h"
#include "core/vectors.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The stiffness of a layer of equal bricks, and its symbol for each wave. */

/* block[s][t][step]: force on side s by displacements of side t (0 is the upper side). step is the
 * number of nodes by which the second lies further along: -1, 0, 1 in x, fastest, then in y. */
struct layer_stiffness {
    double block[2][2][9][3][3];
};

/* Cosine and sine of a wave's phase over each step. */
struct wave_phases {
    double cosine[9], sine[9];
};

static const double PI = 3.14159265358979323846;

/* Fills the stiffness of a layer of the flat mesh without displacements; its columns are those of
 * its upper level. volumetric may be NULL. */
static void layer_stiffness_make(const struct mesh *mesh, const struct material *material,
                                 size_t layer, struct layer_stiffness *out,
                                 struct volumetric *volumetric) {
    int d = mesh->dimension;
    const struct level *level = &mesh->level[layer];
    double width = (double)level->width;
    double position[8][3], u[8][3] = {{0}},
                           stiffness[ELEMENT_DEGREES_OF_FREEDOM][ELEMENT_DEGREES_OF_FREEDOM];
    struct element_shape shape;
    struct element_volumetric own;
    memset(out, 0, sizeof *out);
    for (int a = 0; a < 1 << d; a++) {
        position[a][0] = (a & 1) * width;
        position[a][1] = (a >> 1 & 1) * width * mesh->across;
        position[a][d - 1] = (a >> (d - 1) & 1) * (level[1].depth - level->depth);
    }
    /* A brick without displacements is never inverted. */
    (void)element_shape_make(d, position, &shape);
    (void)element_evaluate(d, material, &shape, u, NULL, NULL, NULL, stiffness, &own);
    if (volumetric != NULL)
        volumetric_store_layer(volumetric, layer, &own);
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

/* Returns the phases of wave (mx, row) on a level's nodes; mx and row may exceed the level's
 * band. */
static struct wave_phases wave_phases_of(const struct level *level, size_t mx, size_t row) {
    struct wave_phases phases;
    double x = 2 * PI * (double)mx / (double)level->nx;
    double y = 2 * PI * (double)row / (double)level->ny;
    for (int slot = 0; slot < 9; slot++) {
        int along = slot % 3 - 1, across = slot / 3 - 1;
        double phase = x * along + y * across;
        phases.cosine[slot] = cos(phase);
        phases.sine[slot] = sin(phase);
    }
    return phases;
}

/* Returns the amplitude at corners that are means of the nodes beside them, over the amplitude at
 * the nodes. */
static double wave_phases_hanging(int dimension, const struct wave_phases *phases) {
    double along = (1 + phases->cosine[5]) / 2, across = (1 + phases->cosine[7]) / 2;
    return dimension == 2 ? along : along * across;
}

/* Adds factor times the symbol of a block to out. It is real, because sideways displacements are i
 * X and i Y (preconditioner.h). */
static void layer_stiffness_add_symbol(int dimension, double block[9][3][3],
                                       const struct wave_phases *phases, double factor,
                                       double out[3][3]) {
    for (int i = 0; i < dimension; i++)
        for (int j = 0; j < dimension; j++) {
            bool up = i == dimension - 1, right = j == dimension - 1;
            double sum = 0;
            for (int slot = 0; slot < 9; slot++)
                sum += block[slot][i][j] * (up == right ? phases->cosine[slot]
                                            : up        ? -phases->sine[slot]
                                                        : phases->sine[slot]);
            out[i][j] += factor * sum;
        }
}

enum { ZONES_MOST = 32 };
/* Stiffness of a node that does not move, over that of others. */
static const double HELD = 1e8;

/* Arrays by wave hold the waves of a level, innermost, in the layout of transform.h; the levels
 * follow one another. */
struct preconditioner {
    const struct mesh *mesh; /* borrowed */
    size_t d;
    struct preconditioner_drag drag;
    struct transform *transform[ZONES_MOST]; /* by the number of times that columns have doubled */
    size_t *before;  /* [level]: waves of all levels above it; the last entry counts all waves */
    double *inverse; /* [level][i*d + j][wave]: inverse of the level's pivot, into which all levels
                        below have been eliminated */
    double *
        coupling; /* [level][i*d + j][wave]: stiffness between the level (i) and the next one (j) */
    double *field; /* [level][i][2][wave]: real and imaginary parts of forces, displacements */
    double *passed,
        *folded;   /* [i][2][wave]: scratch between levels whose columns differ in width */
    double *plane; /* scratch for one component of one level, as large as the face */
};

static size_t waves_at(const struct preconditioner *preconditioner, size_t level) {
    return level_waves(&preconditioner->mesh->level[level]);
}
static double *inverse_at(const struct preconditioner *preconditioner, size_t level) {
    return preconditioner->inverse +
           preconditioner->before[level] * preconditioner->d * preconditioner->d;
}
static double *coupling_at(const struct preconditioner *preconditioner, size_t level) {
    return preconditioner->coupling +
           preconditioner->before[level] * preconditioner->d * preconditioner->d;
}
static double *field_at(const struct preconditioner *preconditioner, size_t level, size_t i) {
    return preconditioner->field + 2 * (preconditioner->before[level] * preconditioner->d +
                                        i * waves_at(preconditioner, level));
}
static size_t zone_of(const struct level *level) {
    size_t zone = 0;
    while (level->width >> zone > 1)
        zone++;
    return zone;
}
static struct transform *transform_at(const struct preconditioner *preconditioner, size_t level) {
    return preconditioner->transform[zone_of(&preconditioner->mesh->level[level])];
}

/* --- elimination --- */

/* Inverts a symmetric positive definite matrix by Gauss-Jordan elimination without pivoting;
 * overwrites a. */
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

/* Applies the conditions on the far side: Z is 0 for all waves but the mean; X and Y of the mean
 * wave get a stiffness, `mean_stiffness`. */
static void hold_far_side(int d, bool mean, double mean_stiffness, double pivot[3][3]) {
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++) {
            bool held = mean ? i < d - 1 && i == j : i == d - 1 || j == d - 1;
            if (held)
                pivot[i][j] = mean ? pivot[i][j] + mean_stiffness : i == j;
        }
}

/* Adds the stiffness of the lower side of the layer above a level, for all aliases of the wave; the
 * layer has `share` times as many nodes. */
static void add_above(const struct preconditioner *preconditioner, struct layer_stiffness *layer,
                      size_t level, size_t mx, size_t row, double share, double pivot[3][3]) {
    int d = preconditioner->mesh->dimension;
    const struct level *above = &preconditioner->mesh->level[level - 1], *here = above + 1;
    for (size_t y = row; y < above->ny; y += here->ny)
        for (size_t x = mx; x < above->nx; x += here->nx) {
            struct wave_phases phases = wave_phases_of(above, x, y);
            double corners = here->nx == above->nx ? 1 : wave_phases_hanging(d, &phases);
            layer_stiffness_add_symbol(d, layer->block[1][1], &phases, share * corners * corners,
                                       pivot);
        }
}

/* Computes the coupling of a level to the next, and eliminates the latter with its inverse. This is
 * exact where both have the same columns. Where columns widen, the aliases of a wave are treated as
 * independent although the level below couples them; that is accurate because short waves have
 * decayed at such depths. */
static void couple(const struct preconditioner *preconditioner, struct layer_stiffness *layer,
                   size_t level, size_t wave, double share, double pivot[3][3]) {
    int d = preconditioner->mesh->dimension;
    const struct level *here = &preconditioner->mesh->level[level];
    size_t n = waves_at(preconditioner, level), next = waves_at(preconditioner, level + 1),
           below = wave;
    bool mirrored = false, wide = mesh_widens(preconditioner->mesh, level);
    struct wave_phases phases = wave_phases_of(here, wave / here->ny, wave % here->ny);
    double between[3][3] = {{0}};
    if (wide)
        below = aliasing_below(here, wave, &mirrored);
    layer_stiffness_add_symbol(d, layer->block[0][0], &phases, 1, pivot);
    layer_stiffness_add_symbol(d, layer->block[0][1], &phases,
                               wide ? wave_phases_hanging(d, &phases) : 1, between);
    for (int i = 0; level + 1 == preconditioner->mesh->layers && below != 0 && i < d; i++)
        between[i][d - 1] = 0; /* all nodes of the far side move together */
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++) {
            coupling_at(preconditioner, level)[(size_t)(i * d + j) * n + wave] = between[i][j];
            for (int k = 0; k < d; k++)
                for (int l = 0; l < d; l++) {
                    bool turned = mirrored && (k == d - 1) != (l == d - 1);
                    pivot[i][j] -=
                        (turned ? -share : share) * between[i][k] * between[j][l] *
                        inverse_at(preconditioner, level + 1)[(size_t)(k * d + l) * next + below];
                }
        }
}

/* Returns the number of nodes of a level for each node of the next one. */
static double share_of(const struct mesh *mesh, size_t level) {
    return mesh_widens(mesh, level) ? 1 << (mesh->dimension - 1) : 1;
}

static void eliminate(struct preconditioner *preconditioner, struct layer_stiffness *layers,
                      size_t level, size_t wave) {
    const struct mesh *mesh = preconditioner->mesh;
    int d = mesh->dimension;
    size_t last = mesh->layers, n = waves_at(preconditioner, level), rows = mesh->level[level].ny;
    double pivot[3][3] = {{0}}, inverse[3][3];
    if (level < last)
        couple(preconditioner, &layers[level], level, wave, share_of(mesh, level), pivot);
    if (level > 0)
        add_above(preconditioner, &layers[level - 1], level, wave / rows, wave % rows,
                  share_of(mesh, level - 1), pivot);
    for (int i = 0; i < (wave == 0 ? d - 1 : d); i++)
        pivot[i][i] += preconditioner->drag.of;
    if (level == last)
        hold_far_side(d, wave == 0, preconditioner->drag.held ? HELD : 1, pivot);
    bool floats =
        level == 0 && wave == 0; /* the mean height of the face is not determined by forces */
    for (int i = 0; floats && i < d; i++)
        pivot[i][d - 1] = pivot[d - 1][i] = i == d - 1;
    invert(d, pivot, inverse);
    if (floats)
        inverse[d - 1][d - 1] = 0;
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            inverse_at(preconditioner, level)[(size_t)(i * d + j) * n + wave] = inverse[i][j];
}

static int eliminate_all(struct preconditioner *preconditioner, const struct material *material,
                         struct volumetric *volumetric, struct error *err) {
    const struct mesh *mesh = preconditioner->mesh;
    struct layer_stiffness *layers = array_create(mesh->layers, sizeof *layers);
    if (layers == NULL)
        return error_memory(err, mesh->layers * sizeof *layers, "the flat block");
    for (size_t k = 0; k < mesh->layers; k++)
        layer_stiffness_make(mesh, material, k, &layers[k], volumetric);
    for (size_t level = mesh->layers + 1; level-- > 0;)
        for (size_t wave = 0; wave < waves_at(preconditioner, level); wave++)
            eliminate(preconditioner, layers, level, wave);
    free(layers);
    return 0;
}

/* Counts the waves of all levels. */
static size_t all_waves(const struct mesh *mesh) {
    size_t waves = 0;
    for (size_t level = 0; level <= mesh->layers; level++)
        waves += level_waves(&mesh->level[level]);
    return waves;
}

double preconditioner_bytes(const struct mesh *mesh) {
    double d = mesh->dimension, one = (double)level_waves(&mesh->level[0]);
    return sizeof(double) * ((2 * d * d + 2 * d) * (double)all_waves(mesh) + 4 * d * one +
                             (double)mesh->face + 2 * one);
}

static int arrays_create(struct preconditioner *preconditioner, struct error *err) {
    const struct mesh *mesh = preconditioner->mesh;
    size_t d = preconditioner->d, waves = all_waves(mesh), one = level_waves(&mesh->level[0]);
    preconditioner->before = array_create(mesh->layers + 2, sizeof *preconditioner->before);
    preconditioner->inverse = array_create(waves * d * d, sizeof *preconditioner->inverse);
    preconditioner->coupling = array_create(waves * d * d, sizeof *preconditioner->coupling);
    preconditioner->field = array_create(waves * d * 2, sizeof *preconditioner->field);
    preconditioner->passed = array_create(one * d * 2, sizeof *preconditioner->passed);
    preconditioner->folded = array_create(one * d * 2, sizeof *preconditioner->folded);
    preconditioner->plane = array_create(mesh->face, sizeof *preconditioner->plane);
    if (preconditioner->before == NULL || preconditioner->inverse == NULL ||
        preconditioner->coupling == NULL || preconditioner->field == NULL ||
        preconditioner->passed == NULL || preconditioner->folded == NULL ||
        preconditioner->plane == NULL)
        return error_memory(err, (size_t)preconditioner_bytes(mesh), "the flat block");
    for (size_t level = 0; level <= mesh->layers; level++)
        preconditioner->before[level + 1] =
            preconditioner->before[level] + waves_at(preconditioner, level);
    return 0;
}

static int transforms_create(struct preconditioner *preconditioner, struct error *err) {
    const struct mesh *mesh = preconditioner->mesh;
    int status = 0;
    for (size_t k = 0; status == 0 && k <= mesh->layers; k++) {
        const struct level *level = &mesh->level[k];
        struct grid grid = {level->nx, level->ny, (double)level->nx,
                            (double)level->ny * mesh->across};
        struct transform **transform = &preconditioner->transform[zone_of(level)];
        if (*transform == NULL)
            status = transform_create(transform, &grid, level->nx / 2, level->ny / 2, err);
    }
    return status;
}

int preconditioner_create(struct preconditioner **out, const struct mesh *mesh,
                          const struct material *material, struct volumetric *volumetric,
                          struct error *err) {
    *out = NULL;
    struct preconditioner *preconditioner = array_create(1, sizeof *preconditioner);
    if (preconditioner == NULL)
        return error_memory(err, sizeof *preconditioner, "the flat block");
    preconditioner->mesh = mesh;
    preconditioner->d = (size_t)mesh->dimension;
    int status = arrays_create(preconditioner, err);
    if (status == 0)
        status = transforms_create(preconditioner, err);
    if (status == 0)
        status = eliminate_all(preconditioner, material, volumetric, err);
    if (status != 0)
        preconditioner_destroy(&preconditioner);
    *out = preconditioner;
    return status;
}

int preconditioner_set_drag(struct preconditioner *preconditioner, const struct material *material,
                            struct volumetric *volumetric, struct preconditioner_drag drag,
                            struct error *err) {
    preconditioner->drag = drag;
    return eliminate_all(preconditioner, material, volumetric, err);
}

void preconditioner_destroy(struct preconditioner **handle) {
    struct preconditioner *preconditioner = *handle;
    if (preconditioner == NULL)
        return;
    for (size_t zone = 0; zone < ZONES_MOST; zone++)
        transform_destroy(&preconditioner->transform[zone]);
    free(preconditioner->before);
    free(preconditioner->inverse);
    free(preconditioner->coupling);
    free(preconditioner->field);
    free(preconditioner->passed);
    free(preconditioner->folded);
    free(preconditioner->plane);
    free(preconditioner);
    *handle = NULL;
}

const double *preconditioner_compliance(const struct preconditioner *preconditioner) {
    return inverse_at(preconditioner, 0) +
           (preconditioner->d * preconditioner->d - 1) * waves_at(preconditioner, 0);
}

/* --- waves in and out --- */

/* Transforms one component of a level's forces from plane into the field. A spectrum s of a
 * sideways component is stored as -i s. */
static void plane_in(struct preconditioner *preconditioner, size_t level, size_t i) {
    size_t n = waves_at(preconditioner, level);
    double *re = field_at(preconditioner, level, i), *im = re + n;
    transform_forward(transform_at(preconditioner, level), preconditioner->plane);
    const double complex *s = transform_spectrum(transform_at(preconditioner, level));
    bool vertical = i == preconditioner->d - 1;
    for (size_t k = 0; k < n; k++) {
        re[k] = vertical ? creal(s[k]) : cimag(s[k]);
        im[k] = vertical ? cimag(s[k]) : -creal(s[k]);
    }
}

static void plane_out(struct preconditioner *preconditioner, size_t level, size_t i) {
    size_t n = waves_at(preconditioner, level);
    const double *re = field_at(preconditioner, level, i), *im = re + n;
    double complex *s = transform_spectrum(transform_at(preconditioner, level));
    bool vertical = i == preconditioner->d - 1;
    for (size_t k = 0; k < n; k++)
        s[k] = vertical ? re[k] + im[k] * I : -im[k] + re[k] * I;
    transform_inverse(transform_at(preconditioner, level), preconditioner->plane);
}

/* y -= a x, with one real value a for each wave; x and y are real and imaginary parts. */
WIDE_VECTORS static void subtract(size_t n, const double *a, const double *x, double *y) {
    for (size_t k = 0; k < n; k++) {
        y[k] -= a[k] * x[k];
        y[n + k] -= a[k] * x[n + k];
    }
}

/* Multiplies x (and y, z) by the inverse pivot of one level. */
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

static void pivot_apply(struct preconditioner *preconditioner, size_t level, double *field) {
    size_t n = waves_at(preconditioner, level);
    if (preconditioner->d == 2)
        pivot_two(n, inverse_at(preconditioner, level), field, field + 2 * n);
    else
        pivot_three(n, inverse_at(preconditioner, level), field, field + 2 * n, field + 4 * n);
}

void preconditioner_load(struct preconditioner *preconditioner, const double *forces) {
    const struct mesh *mesh = preconditioner->mesh;
    size_t d = preconditioner->d, last = mesh->layers;
    for (size_t level = 0; level <= last; level++)
        for (size_t i = 0; i < d; i++) {
            const double *force = forces + mesh->level[level].first * d + i;
            for (size_t node = 0; node < level_nodes(&mesh->level[level]); node++)
                preconditioner->plane[node] = force[node * d];
            plane_in(preconditioner, level, i);
        }
    double *far_side = field_at(preconditioner, last, d - 1);
    size_t wide = waves_at(preconditioner, last);
    for (size_t k = 1; k < wide; k++)
        far_side[k] = far_side[wide + k] = 0;
    for (size_t level = last; level > 0; level--) {
        /* The field of the level below keeps the displacements under the forces stored there. */
        size_t n = waves_at(preconditioner, level - 1);
        const double *field = field_at(preconditioner, level, 0);
        pivot_apply(preconditioner, level, field_at(preconditioner, level, 0));
        if (mesh_widens(mesh, level - 1)) {
            aliasing_unfold(&mesh->level[level - 1], d, field, preconditioner->passed);
            field = preconditioner->passed;
        }
        for (size_t i = 0; i < d; i++)
            for (size_t j = 0; j < d; j++)
                subtract(n, coupling_at(preconditioner, level - 1) + (i * d + j) * n,
                         field + 2 * j * n, field_at(preconditioner, level - 1, i));
    }
}

/* Only the vertical row of the inverse pivot is needed; the field itself is kept for
 * preconditioner_displace. */
void preconditioner_face(struct preconditioner *preconditioner, double *vertical) {
    size_t n = waves_at(preconditioner, 0), d = preconditioner->d;
    double complex *s = transform_spectrum(preconditioner->transform[0]);
    for (size_t k = 0; k < n; k++)
        s[k] = 0;
    for (size_t j = 0; j < d; j++) {
        const double *a = inverse_at(preconditioner, 0) + ((d - 1) * d + j) * n,
                     *x = field_at(preconditioner, 0, j);
        for (size_t k = 0; k < n; k++)
            s[k] += a[k] * x[k] + a[k] * x[n + k] * I;
    }
    transform_inverse(preconditioner->transform[0], vertical);
}

/* Subtracts pivot times coupling^T times this level's displacements from those of the next level.
 */
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

/* Computes passed = coupling^T times a level's displacements. */
WIDE_VECTORS static void pull(size_t d, size_t n, const double *coupling, const double *above,
                              double *passed) {
    memset(passed, 0, 2 * d * n * sizeof *passed);
    for (size_t j = 0; j < d; j++)
        for (size_t i = 0; i < d; i++)
            for (size_t part = 0; part < 2; part++)
                for (size_t k = 0; k < n; k++)
                    passed[(2 * j + part) * n + k] +=
                        coupling[(i * d + j) * n + k] * above[(2 * i + part) * n + k];
}

/* Computes the next level's displacements where its columns are wider. */
static void descend_wider(struct preconditioner *preconditioner, size_t level) {
    size_t n = 2 * preconditioner->d * waves_at(preconditioner, level + 1);
    double share = share_of(preconditioner->mesh, level),
           *below = field_at(preconditioner, level + 1, 0);
    pull(preconditioner->d, waves_at(preconditioner, level), coupling_at(preconditioner, level),
         field_at(preconditioner, level, 0), preconditioner->passed);
    aliasing_fold(&preconditioner->mesh->level[level], preconditioner->d, preconditioner->passed,
                  preconditioner->folded);
    pivot_apply(preconditioner, level + 1, preconditioner->folded);
    for (size_t k = 0; k < n; k++)
        below[k] -= share * preconditioner->folded[k];
}

/* Adds forces on the face along one axis to those stored. */
static void add_force(struct preconditioner *preconditioner, size_t i, const double *force) {
    size_t n = waves_at(preconditioner, 0);
    double *re = field_at(preconditioner, 0, i);
    bool vertical = i == preconditioner->d - 1;
    transform_forward(preconditioner->transform[0], force);
    const double complex *s = transform_spectrum(preconditioner->transform[0]);
    for (size_t k = 0; k < n; k++) {
        re[k] += vertical ? creal(s[k]) : cimag(s[k]);
        re[n + k] += vertical ? cimag(s[k]) : -creal(s[k]);
    }
}

/* Computes all displacements under the forces stored. */
static void displace(struct preconditioner *preconditioner, double *displacements) {
    const struct mesh *mesh = preconditioner->mesh;
    size_t d = preconditioner->d;
    pivot_apply(preconditioner, 0, field_at(preconditioner, 0, 0));
    for (size_t level = 0; level < mesh->layers; level++)
        if (mesh_widens(mesh, level))
            descend_wider(preconditioner, level);
        else
            (d == 2 ? descend_two : descend_three)(
                waves_at(preconditioner, level), inverse_at(preconditioner, level + 1),
                coupling_at(preconditioner, level), field_at(preconditioner, level, 0),
                field_at(preconditioner, level + 1, 0));
    for (size_t level = 0; level <= mesh->layers; level++)
        for (size_t i = 0; i < d; i++) {
            double *displacement = displacements + mesh->level[level].first * d + i;
            plane_out(preconditioner, level, i);
            for (size_t node = 0; node < level_nodes(&mesh->level[level]); node++)
                displacement[node * d] = preconditioner->plane[node];
        }
}

void preconditioner_displace(struct preconditioner *preconditioner, const double *vertical,
                             double *displacements) {
    add_force(preconditioner, preconditioner->d - 1, vertical);
    displace(preconditioner, displacements);
}

/* --- all directions of the face --- */

void preconditioner_face_all(struct preconditioner *preconditioner, double *face) {
    size_t n = waves_at(preconditioner, 0), d = preconditioner->d;
    double complex *s = transform_spectrum(preconditioner->transform[0]);
    for (size_t i = 0; i < d; i++) {
        for (size_t k = 0; k < n; k++) {
            double re = 0, im = 0;
            for (size_t j = 0; j < d; j++) {
                double a = inverse_at(preconditioner, 0)[(i * d + j) * n + k];
                re += a * field_at(preconditioner, 0, j)[k];
                im += a * field_at(preconditioner, 0, j)[n + k];
            }
            s[k] = i == d - 1 ? re + im * I : -im + re * I;
        }
        transform_inverse(preconditioner->transform[0], face + i * preconditioner->mesh->face);
    }
}

void preconditioner_displace_all(struct preconditioner *preconditioner, const double *forces,
                                 double *displacements) {
    for (size_t i = 0; i < preconditioner->d; i++)
        add_force(preconditioner, i, forces + i * preconditioner->mesh->face);
    displace(preconditioner, displacements);
}

/* Of the mean wave the far side is held by a stiffness of 1 a node (hold_far_side), whose part is
 * taken out. */
void preconditioner_matrices(const struct preconditioner *preconditioner, double *compliance,
                             double *stiffness) {
    const struct mesh *mesh = preconditioner->mesh;
    size_t n = waves_at(preconditioner, 0), d = preconditioner->d;
    double given = preconditioner->drag.held
                       ? 0
                       : (double)mesh->face / (double)level_nodes(&mesh->level[mesh->layers]);
    memcpy(compliance, inverse_at(preconditioner, 0), d * d * n * sizeof *compliance);
    for (size_t i = 0; i + 1 < d; i++)
        compliance[(i * d + i) * n] -= given;
    for (size_t k = 0; k < n; k++) {
        double matrix[3][3], inverse[3][3];
        for (size_t i = 0; i < d; i++)
            for (size_t j = 0; j < d; j++)
                matrix[i][j] = compliance[(i * d + j) * n + k];
        if (k == 0)
            matrix[d - 1][d - 1] = 1;
        invert((int)d, matrix, inverse);
        if (k == 0)
            inverse[d - 1][d - 1] = 0;
        for (size_t i = 0; i < d; i++)
            for (size_t j = 0; j < d; j++)
                stiffness[(i * d + j) * n + k] = inverse[i][j];
    }
}

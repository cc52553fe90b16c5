/* Finite elements on equal columns, wave by wave.
 *
 * A displacement (i X, i Y, Z) exp(i k.r) at the nodes, X, Y and Z real functions of depth, linear
 * in each layer. Sideways the products of shape functions N and their derivatives, averaged over an
 * element, become symbols: in a direction with node distance d, s = sin(k d/2), c = cos(k d/2) and
 * the phase of the element's middle,
 *
 *   <N, N> = 1 - 2 s^2/3   <N', N'> = 4 s^2/d^2   <N, N'> = 2 i s c/d   <N> = c   <N'> = 2 i s/d
 *
 * exactly, as by Gauss quadrature. None is a difference of like numbers, however long the wave.
 *
 * In depth the displacement in a layer of thickness h is v + zeta w: v at its far face, v + w at
 * its near face, 0 <= zeta <= 1. With phi its functions 1 and zeta, twice the energy over area is
 *
 *   the integral of [u phi; u phi']^T [A C; C^T F] [u phi; u phi'] dz
 *
 * from 2 mu e:e + local (div u)^2 + mean (mean div u)^2, local + mean = lambda, the mean over the
 * element, as in B-bar (Hughes 1980; there local = -2 mu/3): however large lambda, it binds one
 * dilatation an element and leaves it free to deform. The split changes the element's stiffness
 * against its hourglass alone, 3 mu + local where it is square, and with it the term in (k dx)^2 of
 * S. That term vanishes for waves along x or y on equal square layers where
 *
 *   3 mu + local = 2 E* / (1 + (mu/(lambda + 2 mu))^2)
 *
 * (found in its numbers for nu from 0 to 0.5, where it leaves less than 1e-6 (k dx)^2). The energy
 * stays positive for a negative mean, as the mean of (div u)^2 exceeds the square of the mean.
 *
 * From the far side up, the stiffness M (3 by 3, over area) that what lies below a layer opposes to
 * v becomes that of what lies below the next, by eliminating w. As w is a difference of
 * displacements, a long wave's small stiffness to X is never a difference of large ones. */
#include "core/contact/layered.h"
#include "core/vectors.h"
#include <math.h>
#include <stdlib.h>

/* Number of waves that are eliminated together, one in each lane of the innermost loops. */
enum { LANES = 32 };
typedef double lane[LANES];

struct layered_material layered_material(double poisson) {
    double mu = (1 - poisson) / 2, ratio = (1 - 2 * poisson) / (2 * (1 - poisson));
    double local = 2 / (1 + ratio * ratio) - 3 * mu;
    /* Limits lambda/mu, with which rounding errors grow; beyond this limit the compliance changes
     * by less than they do. */
    double compressible = fmax(1 - 2 * poisson, 1e-8);
    return (struct layered_material){mu, local, 2 * mu * poisson / compressible - local};
}

/* The symbols of one direction for one wave. */
struct symbols {
    double mass;       /* <N, N> */
    double stiffness;  /* <N', N'> */
    double cross;      /* <N, N'>/i */
    double mean, tilt; /* of N; of N', over i */
};

static struct symbols symbols_of(size_t mode, size_t n, double distance) {
    /* At the Nyquist wave c is 0, not the cosine of a rounded pi/2. */
    double angle = M_PI * (double)mode / (double)n;
    double s = sin(angle), c = 2 * mode == n ? 0 : cos(angle);
    return (struct symbols){.mass = 1 - 2 * s * s / 3,
                            .stiffness = 4 * s * s / (distance * distance),
                            .cross = 2 * s * c / distance,
                            .mean = c,
                            .tilt = 2 * s / distance};
}

/* The waves that are eliminated together. Lanes from count on are undefined and not read. Of
 * symmetric matrices one half is stored; entries left out are 0. */
struct wave_lanes {
    lane axx, axy, ayy, azz; /* A */
    lane bxx, bxy, byy;      /* the part of A that depends on the mean of phi: zeta zeta is h/4 */
    lane cxz, cyz, czx, czy; /* C: row phi, column phi' */
    lane fh, fz;             /* F of X and Y, of Z */
    lane mxx, mxy, myy, mxz, myz, mzz; /* M */
    lane compliance;                   /* Z over pressure at the face */
    size_t mx[LANES], my[LANES];
    size_t count;
};

/* Gives lane l the material of the layers that are eliminated next. */
static void wave_set(struct wave_lanes *w, size_t l, const struct layered_material *material,
                     const struct symbols *x, const struct symbols *y) {
    double mu = material->mu, local = material->local, mean = material->mean;
    double kx = x->stiffness * y->mass, ky = x->mass * y->stiffness, mass = x->mass * y->mass;
    double gx = x->cross * y->mass, gy = x->mass * y->cross;
    /* mean div u = (tx X + ty Y) phi + tz Z phi' */
    double tx = -x->tilt * y->mean, ty = -x->mean * y->tilt, tz = x->mean * y->mean;
    w->bxx[l] = mean * tx * tx;
    w->bxy[l] = mean * tx * ty;
    w->byy[l] = mean * ty * ty;
    w->axx[l] = (2 * mu + local) * kx + mu * ky + w->bxx[l];
    w->axy[l] = (mu + local) * x->cross * y->cross + w->bxy[l];
    w->ayy[l] = (2 * mu + local) * ky + mu * kx + w->byy[l];
    w->azz[l] = mu * (kx + ky);
    w->cxz[l] = -local * gx + mean * tx * tz;
    w->cyz[l] = -local * gy + mean * ty * tz;
    w->czx[l] = mu * gx;
    w->czy[l] = mu * gy;
    w->fh[l] = mu * mass;
    w->fz[l] = (2 * mu + local) * mass + mean * tz * tz;
}

struct layer_row {
    double x, y, z;
};

struct symmetric {
    double xx, xy, yy, xz, yz, zz;
};

/* Factors of H = L D L^T, where L has ones on its diagonal. */
struct cholesky {
    double x, y, z;    /* 1/D */
    double yx, zx, zy; /* L */
};

static inline struct cholesky factorise(struct symmetric h) {
    struct cholesky f;
    f.x = 1 / h.xx;
    f.yx = h.xy * f.x;
    f.zx = h.xz * f.x;
    f.y = 1 / (h.yy - f.yx * h.xy);
    double t = h.yz - f.zx * h.xy;
    f.zy = t * f.y;
    f.z = 1 / (h.zz - f.zx * h.xz - f.zy * t);
    return f;
}

/* Returns L^-1 g. */
static inline struct layer_row forward(struct cholesky f, struct layer_row g) {
    struct layer_row u = {.x = g.x};
    u.y = g.y - f.yx * u.x;
    u.z = g.z - f.zx * u.x - f.zy * u.y;
    return u;
}

static inline double product(struct cholesky f, struct layer_row u, struct layer_row v) {
    return u.x * v.x * f.x + u.y * v.y * f.y + u.z * v.z * f.z;
}

/* Puts M = N - G H^-1 G^T, with the rows of G as given, into lane l. */
static inline void condense(struct wave_lanes *w, size_t l, struct symmetric n, struct symmetric h,
                            struct layer_row gx, struct layer_row gy, struct layer_row gz) {
    struct cholesky f = factorise(h);
    struct layer_row x = forward(f, gx), y = forward(f, gy), z = forward(f, gz);
    w->mxx[l] = n.xx - product(f, x, x);
    w->mxy[l] = n.xy - product(f, x, y);
    w->myy[l] = n.yy - product(f, y, y);
    w->mxz[l] = n.xz - product(f, x, z);
    w->myz[l] = n.yz - product(f, y, z);
    w->mzz[l] = n.zz - product(f, z, z);
}

/* The layer on the far side, where Z = 0 and X, Y are free. Z of w is that of the near face and
 * stays; X and Y of w are eliminated, with a unit pivot in place of Z. */
WIDE_VECTORS static void far_layer(struct wave_lanes *w, double h) {
    double a = h / 2, b = h / 3, c = h / 12;
    for (size_t l = 0; l < LANES; l++) {
        struct symmetric n = {h * w->axx[l], h * w->axy[l], h * w->ayy[l],
                              w->cxz[l],     w->cyz[l],     b * w->azz[l] + w->fz[l] / h};
        double shear = w->fh[l] / h;
        struct symmetric pivot = {.xx = b * w->axx[l] - c * w->bxx[l] + shear,
                                  .xy = b * w->axy[l] - c * w->bxy[l],
                                  .yy = b * w->ayy[l] - c * w->byy[l] + shear,
                                  .zz = 1};
        struct layer_row gx = {-a * w->axx[l], -a * w->axy[l], 0};
        struct layer_row gy = {-a * w->axy[l], -a * w->ayy[l], 0};
        struct layer_row gz = {(w->czx[l] - w->cxz[l]) / 2, (w->czy[l] - w->cyz[l]) / 2, 0};
        condense(w, l, n, pivot, gx, gy, gz);
    }
}

/* Any other layer. Its energy has blocks P for v v, Q for v w, R for w w. v is the near face less
 * w, so that G = N - Q and H = N - Q - Q^T + R, with N = M + P. */
WIDE_VECTORS static void next_layer(struct wave_lanes *w, double h) {
    double a = h / 2, b = h / 3, c = h / 12;
    for (size_t l = 0; l < LANES; l++) {
        struct symmetric m = {w->mxx[l], w->mxy[l], w->myy[l], w->mxz[l], w->myz[l], w->mzz[l]};
        struct symmetric n = {
            m.xx + h * w->axx[l], m.xy + h * w->axy[l], m.yy + h * w->ayy[l], m.xz, m.yz,
            m.zz + h * w->azz[l]};
        double shear = w->fh[l] / h;
        struct symmetric pivot = {
            m.xx + b * w->axx[l] - c * w->bxx[l] + shear, m.xy + b * w->axy[l] - c * w->bxy[l],
            m.yy + b * w->ayy[l] - c * w->byy[l] + shear, m.xz - (w->cxz[l] + w->czx[l]) / 2,
            m.yz - (w->cyz[l] + w->czy[l]) / 2,           m.zz + b * w->azz[l] + w->fz[l] / h};
        double gxy = m.xy + a * w->axy[l];
        struct layer_row gx = {m.xx + a * w->axx[l], gxy, m.xz - w->cxz[l]};
        struct layer_row gy = {gxy, m.yy + a * w->ayy[l], m.yz - w->cyz[l]};
        struct layer_row gz = {m.xz - w->czx[l], m.yz - w->czy[l], m.zz + a * w->azz[l]};
        condense(w, l, n, pivot, gx, gy, gz);
    }
}

/* Computes Z of the face under a unit pressure with X and Y free: (M^-1)_zz. */
WIDE_VECTORS static void face(struct wave_lanes *w) {
    for (size_t l = 0; l < LANES; l++) {
        struct symmetric m = {w->mxx[l], w->mxy[l], w->myy[l], w->mxz[l], w->myz[l], w->mzz[l]};
        w->compliance[l] = factorise(m).z;
    }
}

/* A mesh under elimination. Lengths are in units of dx, so that no unit of the user's can
 * overflow. */
struct layered_mesh {
    const struct grid *grid;
    struct layered_material material; /* of the layers below the coating */
    struct layered_material coating;  /* of the first of them */
    double *length;                   /* filled: as in struct compliance */
    double *thickness;                /* layers, from the face down */
    size_t layers, coated;            /* all; those of the coating, which come first */
    struct symbols *x, *y;            /* nx/2 + 1, ny/2 + 1 */
    bool square;                      /* x and y may be swapped */
    struct wave_lanes waves;
};

/* |mx| and |my| stand for all signs, and on a square grid for both orders. */
static void length_store(const struct layered_mesh *mesh, size_t mx, size_t my, double length) {
    size_t ny = mesh->grid->ny;
    double *column = mesh->length + mx * ny;
    column[my] = length;
    column[my != 0 ? ny - my : 0] = length;
}

/* Eliminates the layers for the waves collected, and stores their compliances. */
static void waves_solve(struct layered_mesh *mesh) {
    struct wave_lanes *w = &mesh->waves;
    size_t layers = mesh->layers;
    far_layer(w, mesh->thickness[layers - 1]);
    for (size_t k = layers - 1; k-- > mesh->coated;)
        next_layer(w, mesh->thickness[k]);
    for (size_t l = 0; mesh->coated > 0 && l < w->count; l++)
        wave_set(w, l, &mesh->coating, &mesh->x[w->mx[l]], &mesh->y[w->my[l]]);
    for (size_t k = mesh->coated; k-- > 0;)
        next_layer(w, mesh->thickness[k]);
    face(w);
    double unit = grid_dx(mesh->grid);
    for (size_t l = 0; l < w->count; l++) {
        length_store(mesh, w->mx[l], w->my[l], unit * w->compliance[l]);
        if (mesh->square)
            length_store(mesh, w->my[l], w->mx[l], unit * w->compliance[l]);
    }
    w->count = 0;
}

static void mesh_solve(struct layered_mesh *mesh) {
    const struct grid *grid = mesh->grid;
    struct wave_lanes *w = &mesh->waves;
    for (size_t mx = 0; mx <= grid->nx / 2; mx++)
        for (size_t my = mx == 0; my <= (mesh->square ? mx : grid->ny / 2); my++) {
            w->mx[w->count] = mx;
            w->my[w->count] = my;
            wave_set(w, w->count++, &mesh->material, &mesh->x[mx], &mesh->y[my]);
            if (w->count == LANES)
                waves_solve(mesh);
        }
    if (w->count != 0)
        waves_solve(mesh);
}

/* Returns the number of layers that fill the coating. */
static size_t coated_layers(const struct layered_mesh *mesh, const struct block *block) {
    double depth = 0, thickness = block->coating.thickness * (1 - 1e-9);
    size_t count = 0;
    while (depth < thickness && count < mesh->layers)
        depth += mesh->thickness[count++];
    return count;
}

/* The same in units of E* of the block below. */
static struct layered_material coating_material(const struct block *block) {
    struct layered_material of = layered_material(block->coating.poisson);
    double stiffness = block_coating_stiffness(block);
    return (struct layered_material){stiffness * of.mu, stiffness * of.local, stiffness * of.mean};
}

/* Layers and symbols; the block's height is checked, so that only its ratio to dx can fail. */
static int mesh_prepare(struct layered_mesh *mesh, const struct block *block, struct error *err) {
    const struct grid *grid = mesh->grid;
    double dx = grid_dx(grid), dy = grid_is_profile(grid) ? dx : grid_dy(grid);
    mesh->layers = block_layers(grid, block, mesh->thickness);
    if (mesh->layers == 0)
        return error_set(err, ERROR_INPUT,
                         "a block of height %g needs more than %d layers that grow by %g; allowed: "
                         "a lower block, a larger growth, fewer points",
                         block->height, LAYERS_MOST, block->layer_growth);
    mesh->coated = coated_layers(mesh, block);
    for (size_t k = 0; k < mesh->layers; k++)
        mesh->thickness[k] /= dx;
    for (size_t mx = 0; mx <= grid->nx / 2; mx++)
        mesh->x[mx] = symbols_of(mx, grid->nx, 1);
    for (size_t my = 0; my <= grid->ny / 2; my++)
        mesh->y[my] = symbols_of(my, grid->ny, dy / dx);
    mesh->square = grid->nx == grid->ny && dx == dy;
    mesh->material = layered_material(block->poisson);
    mesh->coating = coating_material(block);
    return 0;
}

int layered_lengths(const struct grid *grid, const struct block *block, double *length,
                    size_t *layers, struct error *err) {
    size_t symbols = grid->nx / 2 + 1 + grid->ny / 2 + 1;
    struct layered_mesh *mesh = array_create(1, sizeof *mesh);
    double *thickness = array_create(LAYERS_MOST, sizeof *thickness);
    struct symbols *directions = array_create(symbols, sizeof *directions);
    int status = 0;
    if (mesh == NULL || thickness == NULL || directions == NULL) {
        status = error_memory(err, symbols * sizeof *directions, "the mesh of the block");
    } else {
        *mesh = (struct layered_mesh){.grid = grid,
                                      .length = length,
                                      .thickness = thickness,
                                      .x = directions,
                                      .y = directions + grid->nx / 2 + 1};
        status = mesh_prepare(mesh, block, err);
        if (status == 0)
            mesh_solve(mesh);
        *layers = mesh->layers;
    }
    free(directions);
    free(thickness);
    free(mesh);
    return status;
}

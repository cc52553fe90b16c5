#include "core/contact/counted_asperities.h"
#include "core/statistics/summits/summits.h"
#include "core/theory/asperities.h"
#include <gsl/gsl_spline.h>
#include <math.h>
#include <stdlib.h>

/* The shapes of ellipses, tabulated over atanh(rho), over which logarithms are nearly straight for
 * thin ellipses. */
enum { SHAPES = 128 };
static const double THETA_MOST = 8;
/* Second differences of a few grid summits have no two positive curvatures; these count as the
 * thinnest of the others. */
static const double ELONGATION_MOST = 0.99;
/* How near the logarithm of a load is met. */
static const double CLOSE = 1e-9;

struct counted_summit {
    double height; /* in RMS heights */
    /* of the whole surface, for a compression of one RMS height */
    double area[COUNTED_THEORIES], load[COUNTED_THEORIES];
};
struct counted_asperities {
    struct grid grid;
    bool open;
    struct summit_finder *finder; /* owned, as all below */
    struct summit_list summits;
    struct counted_summit *counted; /* by falling height */
    size_t count, capacity;
    gsl_spline *area, *load; /* logarithms over atanh(rho) */
};

static int shapes_tabulate(struct counted_asperities *asperities, struct error *err) {
    double x[SHAPES], area[SHAPES], load[SHAPES];
    asperities->area = gsl_spline_alloc(gsl_interp_cspline, SHAPES);
    asperities->load = gsl_spline_alloc(gsl_interp_cspline, SHAPES);
    if (asperities->area == NULL || asperities->load == NULL)
        return error_memory(err, 2 * SHAPES * sizeof(double), "shapes of asperities");
    for (size_t n = 0; n < SHAPES; n++) {
        const struct asperity_ellipse ellipse =
            asperity_ellipse_at(THETA_MOST * (double)n / (SHAPES - 1));
        x[n] = log((1 + ellipse.elongation) / ellipse.roundness) / 2;
        area[n] = log(ellipse.area);
        load[n] = log(ellipse.load);
    }
    gsl_spline_init(asperities->area, x, area, SHAPES);
    gsl_spline_init(asperities->load, x, load, SHAPES);
    return 0;
}

int counted_asperities_create(struct counted_asperities **out, const struct grid *grid, bool open,
                              struct error *err) {
    struct counted_asperities *asperities = array_create(1, sizeof *asperities);
    if (asperities == NULL)
        return error_memory(err, sizeof *asperities, "asperities");
    asperities->grid = *grid;
    asperities->open = open;
    int status = summit_finder_create(&asperities->finder, grid, SUMMITS_NINE_POINT,
                                      CURVATURE_FINITE_DIFFERENCE, grid->nx / 2, grid->ny / 2, err);
    if (status == 0)
        status = shapes_tabulate(asperities, err);
    if (status != 0)
        counted_asperities_destroy(&asperities);
    *out = asperities;
    return status;
}

void counted_asperities_destroy(struct counted_asperities **asperities) {
    struct counted_asperities *gone = *asperities;
    if (gone == NULL)
        return;
    summit_finder_destroy(&gone->finder);
    summit_list_clear(&gone->summits);
    gsl_spline_free(gone->area);
    gsl_spline_free(gone->load);
    free(gone->counted);
    free(gone);
    *asperities = NULL;
}

double counted_asperities_bytes(const struct grid *grid) {
    /* a summit in nine points at most; lists double as they grow */
    return summit_finder_bytes(grid, SUMMITS_NINE_POINT, CURVATURE_FINITE_DIFFERENCE, grid->nx / 2,
                               grid->ny / 2, false) +
           2 * (double)grid_points(grid) / 9 *
               (double)(sizeof(struct summit) + sizeof(struct counted_summit));
}

/* Leaves out the summits at the border of a surface that does not repeat. */
static void leave_border(const struct grid *grid, struct summit_list *list) {
    double dx = grid_dx(grid), dy = grid_dy(grid);
    size_t kept = 0;
    for (size_t n = 0; n < list->count; n++) {
        const struct summit *summit = &list->summits[n];
        if (summit->x > dx / 2 && summit->x < grid->lx - 1.5 * dx && summit->y > dy / 2 &&
            summit->y < grid->ly - 1.5 * dy)
            list->summits[kept++] = *summit;
    }
    list->count = kept;
}

/* Returns (kappa_1 - kappa_2)/(kappa_1 + kappa_2) of a grid summit by second differences. */
static double elongation_at(const struct grid *grid, const double *z, const struct summit *summit) {
    size_t nx = grid->nx, ny = grid->ny;
    size_t i = (size_t)(summit->x / grid_dx(grid) + 0.5) % nx;
    size_t j = (size_t)(summit->y / grid_dy(grid) + 0.5) % ny;
    size_t left = i > 0 ? i - 1 : nx - 1, right = i + 1 < nx ? i + 1 : 0;
    const double *row = z + j * nx;
    const double *below = z + (j > 0 ? j - 1 : ny - 1) * nx;
    const double *above = z + (j + 1 < ny ? j + 1 : 0) * nx;
    double dx = grid_dx(grid), dy = grid_dy(grid);
    double xx = (row[left] - 2 * row[i] + row[right]) / (dx * dx);
    double yy = (below[i] - 2 * row[i] + above[i]) / (dy * dy);
    double xy = (above[right] - above[left] - below[right] + below[left]) / (4 * dx * dy);
    return hypot((xx - yy) / 2, xy) / (-(xx + yy) / 2);
}

static int fall(const void *a, const void *b) {
    const struct counted_summit *one = a, *other = b;
    return (one->height < other->height) - (one->height > other->height);
}

static int room_make(struct counted_asperities *asperities, size_t count, struct error *err) {
    if (count <= asperities->capacity)
        return 0;
    free(asperities->counted);
    asperities->counted = array_create(count, sizeof *asperities->counted);
    asperities->capacity = asperities->counted != NULL ? count : 0;
    return asperities->counted != NULL
               ? 0
               : error_memory(err, count * sizeof *asperities->counted, "counted summits");
}

int counted_asperities_take(struct counted_asperities *asperities, const double *z,
                            double rms_height, double rms_slope, struct error *err) {
    const struct grid *grid = &asperities->grid;
    const struct summit_list *summits = &asperities->summits;
    asperities->count = 0;
    int status = summits_find(asperities->finder, z, &asperities->summits, err);
    if (asperities->open)
        leave_border(grid, &asperities->summits);
    if (status == 0)
        status = room_make(asperities, summits->count, err);
    if (status != 0)
        return status;
    double mean = 0, most = atanh(ELONGATION_MOST);
    for (size_t n = 0; n < summits->count; n++)
        mean += summits->summits[n].curvature / (double)summits->count;
    double cell = grid->lx * grid->ly, area = M_PI * rms_height / cell;
    double load = 4.0 / 3 * pow(rms_height, 1.5) / (cell * rms_slope);
    for (size_t n = 0; n < summits->count; n++) {
        const struct summit *summit = &summits->summits[n];
        double elongation = elongation_at(grid, z, summit), own = summit->curvature;
        double x = elongation < ELONGATION_MOST ? atanh(elongation) : most;
        asperities->counted[n] = (struct counted_summit){
            .height = summit->height / rms_height,
            .area = {[COUNTED_GW] = area / mean,
                     [COUNTED_BGT] = area / own * exp(gsl_spline_eval(asperities->area, x, NULL))},
            .load = {[COUNTED_GW] = load / sqrt(mean),
                     [COUNTED_BGT] =
                         load / sqrt(own) * exp(gsl_spline_eval(asperities->load, x, NULL))}};
    }
    asperities->count = summits->count;
    if (asperities->count > 1)
        qsort(asperities->counted, asperities->count, sizeof *asperities->counted, fall);
    return 0;
}

/* --- pressing --- */

struct pressing {
    const struct counted_asperities *asperities;
    enum counted_theory theory;
};

static struct asperity_contact contact_at(const void *theory, double separation) {
    const struct pressing *pressing = theory;
    const struct counted_asperities *asperities = pressing->asperities;
    struct asperity_contact sum = {0, 0};
    for (size_t n = 0; n < asperities->count; n++) {
        const struct counted_summit *summit = &asperities->counted[n];
        double over = summit->height - separation;
        if (!(over > 0))
            break;
        sum.area += summit->area[pressing->theory] * over;
        sum.load += summit->load[pressing->theory] * over * sqrt(over);
    }
    return sum;
}

double counted_asperities_area(const struct counted_asperities *asperities,
                               enum counted_theory theory, double load) {
    const struct pressing pressing = {asperities, theory};
    return asperities->count > 0 ? asperity_area_at_load(contact_at, &pressing, load, CLOSE)
                                 : (double)NAN;
}

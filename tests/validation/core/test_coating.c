/* Protects contact of coated half-spaces in free space: a paraboloid on a coating against an
 * axisymmetric solution of the same problem, whose coating follows from the equations of elasticity
 * of both layers; a flat punch against a published closed form and its bounds; and displacements
 * that do not depend on the padding. */
#include "core/contact/coating.h"
#include "core/theory/quadrature.h"
#include "tests/support/check.h"
#include "tests/support/coated_elasticity.h"
#include "tests/support/contact_scene.h"
#include "tests/support/effort.h"
#include <gsl/gsl_sf_bessel.h>
#include <stdio.h>

static struct block coated(double thickness, double modulus) {
    struct block block = DEEP;
    block.coating = (struct coating){thickness, modulus, 0.25};
    return block;
}

/* --- the axisymmetric problem: a paraboloid of radius 1 of curvature, contact of radius 1 --- */

/* Pressures are sums of c_n (1 - r^2)^(n + 1/2), whose transforms are known. */
enum { TERMS = 9, UNKNOWNS = TERMS + 1 };

struct indentation {
    double load, peak, approach; /* over E* of the base */
};

/* Displacement under such a pressure on a half-space of E* = 1 (Weber & Schafheitlin). */
static double half_space(size_t n, double r) {
    double sum = 0, term = 1;
    for (size_t j = 0; j <= n + 1; j++) {
        double a = (double)j;
        sum += term;
        term *= (0.5 + a) * (a - (double)n - 1) / ((1 + a) * (1 + a)) * r * r;
    }
    return tgamma((double)n + 1.5) * sqrt(M_PI) / tgamma((double)n + 2) * sum;
}

/* What the compliance is beyond that of a half-space of the coating, S E* k - 2/r, at the nodes of
 * a quadrature by its weights, and the transforms of the pressures there. Beyond k t of 10 it is
 * nothing. */
enum { NODES = 128 * QUADRATURE_NODES };
struct excess {
    size_t count;
    double k[NODES], value[NODES], transform[TERMS][NODES];
};

static void excess_add(struct excess *out, double k, double weight, const struct block *block) {
    struct block wave = *block;
    wave.coating.thickness *= k;
    out->k[out->count] = k;
    out->value[out->count] =
        weight * (coated_elasticity(&wave) - 2 / block_coating_stiffness(block));
    for (size_t n = 0; n < TERMS; n++)
        out->transform[n][out->count] = pow(2, (double)n + 0.5) * tgamma((double)n + 1.5) *
                                        sqrt(2 / M_PI) * gsl_sf_bessel_jl((int)n + 1, k) /
                                        pow(k, (double)n + 1);
    out->count++;
}

static struct excess *excess_of(const struct block *block) {
    struct excess *out = calloc(1, sizeof *out);
    double node[QUADRATURE_NODES], weight[QUADRATURE_NODES], most = 20 / block->coating.thickness;
    assert_non_null(out);
    for (double low = 0, high = 1e-4; low < most; low = high, high += fmin(high, 2)) {
        quadrature_panel(low, high, node, weight);
        assert_true(out->count + QUADRATURE_NODES <= NODES);
        for (size_t a = 0; a < QUADRATURE_NODES; a++)
            excess_add(out, node[a], weight[a], block);
    }
    return out;
}

/* Fills the displacements at r under each pressure, over E* of the block. */
static void displacements(const struct block *block, const struct excess *excess, double r,
                          double out[TERMS]) {
    for (size_t n = 0; n < TERMS; n++)
        out[n] = half_space(n, r) / block_coating_stiffness(block);
    for (size_t a = 0; a < excess->count; a++) {
        double wave = excess->value[a] * gsl_sf_bessel_J0(excess->k[a] * r);
        for (size_t n = 0; n < TERMS; n++)
            out[n] += wave * excess->transform[n][a];
    }
}

static void solve(double a[UNKNOWNS][UNKNOWNS + 1]) {
    for (size_t c = 0; c < UNKNOWNS; c++) {
        size_t pivot = c;
        for (size_t r = c + 1; r < UNKNOWNS; r++)
            pivot = fabs(a[r][c]) > fabs(a[pivot][c]) ? r : pivot;
        for (size_t j = 0; j <= UNKNOWNS; j++) {
            double t = a[c][j];
            a[c][j] = a[pivot][j];
            a[pivot][j] = t;
        }
        for (size_t r = 0; r < UNKNOWNS; r++) {
            double by = r == c ? 0 : a[r][c] / a[c][c];
            for (size_t j = c; j <= UNKNOWNS; j++)
                a[r][j] -= by * a[c][j];
        }
    }
}

static struct indentation indent(const struct block *block) {
    double a[UNKNOWNS][UNKNOWNS + 1];
    struct indentation out = {0};
    struct excess *excess = excess_of(block);
    for (size_t i = 0; i < UNKNOWNS; i++) {
        double r = sin(M_PI / 2 * ((double)i + 0.5) / UNKNOWNS);
        displacements(block, excess, r, a[i]);
        a[i][TERMS] = -1;
        a[i][UNKNOWNS] = -r * r / 2;
    }
    free(excess);
    solve(a);
    for (size_t n = 0; n < TERMS; n++) {
        double c = a[n][UNKNOWNS] / a[n][n];
        out.load += 2 * M_PI * c / (2 * (double)n + 3);
    }
    /* Under a stiff coating the pressure is highest off the middle. */
    for (double r = 0; r < 1; r += 1.0 / 512) {
        double p = 0;
        for (size_t n = 0; n < TERMS; n++)
            p += a[n][UNKNOWNS] / a[n][n] * pow(1 - r * r, (double)n + 0.5);
        out.peak = fmax(out.peak, p);
    }
    out.approach = a[TERMS][UNKNOWNS] / a[TERMS][TERMS];
    return out;
}

/* The limits are Hertz's (F11.3). */
static void the_axisymmetric_solution_has_its_limits(void **state) {
    (void)state;
    struct block same = coated(0.5, 1), thick = coated(300, 3);
    same.coating.poisson = same.poisson;
    struct indentation hertz = indent(&same), layer = indent(&thick);
    check_relative(hertz.load, 4.0 / 3, 1e-8);
    check_relative(hertz.peak, 2 / M_PI, 1e-6);
    check_relative(hertz.approach, 1, 1e-8);
    check_relative(layer.load, 4.0 / 3 * block_coating_stiffness(&thick), 0.01);
}

/* --- the same by the solver --- */

/* Presses with about so many points across the contact, and compares. */
static double press(const struct block *block, const struct indentation *exact, size_t points) {
    struct error err = {0};
    struct compliance *compliance = NULL;
    struct contact *contact = NULL;
    struct area_workspace *areas = NULL;
    struct contact_state state;
    struct contact_area area;
    size_t nx = points + points / 3;
    double length = 2.0 * (double)nx / (double)points, cell = length * length, top = -INFINITY;
    struct grid grid = {nx, nx, length, length};
    double *z = zeros(nx * nx);
    for (size_t j = 0; j < nx; j++)
        for (size_t i = 0; i < nx; i++) {
            double x = ((double)i + 0.3) * grid_dx(&grid) - length / 2;
            double y = ((double)j + 0.6) * grid_dy(&grid) - length / 2;
            z[j * nx + i] = -(x * x + y * y) / 2;
            top = fmax(top, z[j * nx + i]);
        }
    if (compliance_create_open(&compliance, &grid, block, &err) != 0 ||
        contact_create(&contact, compliance, &CONTACT_DEFAULTS, &err) != 0 ||
        area_workspace_create(&areas, compliance, &err) != 0 ||
        contact_begin(contact, z, &err) != 0 ||
        contact_press(contact, exact->load / cell, &state, &err) != 0)
        fail_msg("%s", err.text);
    contact_area(areas, &state, &area);
    double wrong[3] = {area.edges * cell / M_PI - 1, largest(nx * nx, state.p) / exact->peak - 1,
                       (state.approach - top) / exact->approach - 1};
    printf("t %g, E1/E2 %g, %zu points: area %+.3f %%, peak %+.3f %%, approach %+.4f %%\n",
           block->coating.thickness, block->coating.modulus, points, 100 * wrong[0], 100 * wrong[1],
           100 * wrong[2]);
    area_workspace_destroy(&areas);
    contact_destroy(&contact);
    compliance_destroy(&compliance);
    free(z);
    return fmax(fabs(wrong[0]), fmax(fabs(wrong[1]), fabs(wrong[2])));
}

static void paraboloids_on_coatings(void **state) {
    (void)state;
    static const double THICKNESS[] = {0.1, 0.4, 1.5}, MODULUS[] = {0.2, 2, 4, 10};
    for (size_t t = 0; t < 3; t++)
        for (size_t m = t % case_step(); m < 4; m += case_step()) {
            struct block block = coated(THICKNESS[t], MODULUS[m]);
            struct indentation exact = indent(&block);
            double coarse = press(&block, &exact, 24), fine = press(&block, &exact, 72);
            assert_true(coarse < 0.01 && fine < 0.001);
        }
}

/* --- a flat punch of radius 1 --- */

/* How much of the energy under a flat punch on a half-space lies less than t below the face. */
static double share_above(double t, double nu) {
    return 2 / M_PI * atan(t) +
           ((1 - 2 * nu) * t * log1p(1 / (t * t)) - t / (1 + t * t)) / (2 * M_PI * (1 - nu));
}

/* The energy of the pressure of that punch, (1 - r^2)^(-1/2) of transform sin(k)/k, on a coated
 * half-space over that on the block alone. */
static double punch_energy(const struct block *block) {
    double inverse = 1 / block_coating_stiffness(block), sum = 0;
    double node[QUADRATURE_NODES], weight[QUADRATURE_NODES], most = 20 / block->coating.thickness;
    for (double low = 0, high = 1e-4; low < most; low = high, high += fmin(high, 2)) {
        quadrature_panel(low, high, node, weight);
        for (size_t a = 0; a < QUADRATURE_NODES; a++) {
            double k = node[a], wave = sin(k) / k;
            sum += weight[a] * wave * wave * (k * coating_compliance(k, block) / 2 - inverse);
        }
    }
    return inverse + 2 / M_PI * sum;
}

/* Gao, Chiu & Lee (1992): layers of nearly the same modulus change the compliance of a flat punch
 * by the share of the energy that they hold. */
static void a_slight_coating_weighs_by_its_energy(void **state) {
    (void)state;
    static const double THICKNESS[] = {0.1, 0.3, 1, 3, 10}, POISSON[] = {0, 0.3, 0.45};
    static const double SLIGHT = 1e-3; /* what is of second order is below its square */
    for (size_t p = 0; p < 3; p++)
        for (size_t t = 0; t < 5; t++) {
            struct block stiff = coated(THICKNESS[t], 1 + SLIGHT), soft = stiff;
            soft.coating.modulus = 1 - SLIGHT;
            stiff.poisson = soft.poisson = POISSON[p];
            stiff.coating.poisson = soft.coating.poisson = POISSON[p];
            double change = (punch_energy(&soft) - punch_energy(&stiff)) / (2 * SLIGHT);
            check_relative(change, share_above(THICKNESS[t], POISSON[p]), 3e-6);
        }
}

/* Presses a flat punch with so many points across, and returns its approach over that on the block
 * alone, 1/2 of a force of 1. */
static double press_punch(const struct block *block, size_t points) {
    struct error err = {0};
    struct compliance *compliance = NULL;
    struct contact *contact = NULL;
    struct contact_state state;
    size_t nx = points + points / 4;
    double length = 2.0 * (double)nx / (double)points;
    struct grid grid = {nx, nx, length, length};
    double *z = zeros(nx * nx);
    for (size_t j = 0; j < nx; j++)
        for (size_t i = 0; i < nx; i++) {
            double x = ((double)i + 0.5) * grid_dx(&grid) - length / 2;
            double y = ((double)j + 0.5) * grid_dy(&grid) - length / 2;
            z[j * nx + i] = x * x + y * y <= 1 ? 0 : -10;
        }
    if (compliance_create_open(&compliance, &grid, block, &err) != 0 ||
        contact_create(&contact, compliance, &CONTACT_DEFAULTS, &err) != 0 ||
        contact_begin(contact, z, &err) != 0 ||
        contact_press(contact, 1 / (length * length), &state, &err) != 0)
        fail_msg("%s", err.text);
    contact_destroy(&contact);
    compliance_destroy(&compliance);
    free(z);
    return state.approach * 2;
}

/* Of layers with one Poisson's ratio the stress of the uniform half-space bounds the compliance of
 * a punch from above, 1 + (E2/E1 - 1) I, and its displacement from below, 1/(1 + (E1/E2 - 1) I),
 * with the share I of its energy. A set of nodes makes a punch of another size, by 1 %. */
static void punches_lie_within_energy_bounds(void **state) {
    (void)state;
    static const double THICKNESS[] = {0.3, 1}, MODULUS[] = {0.5, 2, 4, 10};
    struct block bare = DEEP;
    double alone = press_punch(&bare, 40);
    check_relative(alone, 1, 0.02);
    for (size_t t = 0; t < 2; t++)
        for (size_t m = 0; m < 4; m++) {
            struct block block = coated(THICKNESS[t], MODULUS[m]);
            block.coating.poisson = block.poisson;
            double share = share_above(THICKNESS[t], block.poisson);
            double high = 1 + (1 / MODULUS[m] - 1) * share;
            double low = 1 / (1 + (MODULUS[m] - 1) * share);
            double value = press_punch(&block, 40) / alone;
            printf("punch, t %g, E1/E2 %g: compliance %.4f within %.4f and %.4f\n", THICKNESS[t],
                   MODULUS[m], value, low, high);
            assert_true(value > low * 0.99 && value < high * 1.01);
        }
}

/* --- padding --- */

/* Displacement at a point under a unit force at point 0, in free space. */
static double displacement(const struct compliance *compliance, size_t i, size_t j) {
    const struct grid *grid = &compliance->waved;
    double sum = 0;
    for (size_t mx = 0; mx <= grid->nx / 2; mx++)
        for (size_t row = 0; row < grid->ny; row++) {
            double twice = mx == 0 || 2 * mx == grid->nx ? 1 : 2;
            double phase = (double)(mx * i % grid->nx) / (double)grid->nx +
                           (double)(row * j % grid->ny) / (double)grid->ny;
            sum += twice * cos(2 * M_PI * phase) * compliance->length[mx * grid->ny + row];
        }
    return sum / (grid->lx * (grid_is_profile(grid) ? 1 : grid->ly));
}

static struct compliance *open_compliance(struct grid grid, const struct block *block) {
    struct compliance *compliance = NULL;
    struct error err = {0};
    if (compliance_create_open(&compliance, &grid, block, &err) != 0)
        fail_msg("%s", err.text);
    return compliance;
}

/* Returns how much displacements on n points and 8 n differ, over the largest. */
static double padding_error(size_t n, bool profile, const struct block *block) {
    double length = (double)n, wide = 8 * length, most = 0;
    struct grid small = {n, profile ? 1 : n, length, length};
    struct grid large = {8 * n, profile ? 1 : 8 * n, wide, wide};
    struct compliance *one = open_compliance(small, block), *other = open_compliance(large, block);
    /* Displacements of profiles are relative to a point at the side's length. */
    double shift = profile ? displacement(other, n, 0) : 0;
    double unit = fabs(displacement(other, 0, 0));
    for (size_t i = 0; i < n; i += n / 4)
        for (size_t j = 0; j < (profile ? 1 : n); j += n / 2)
            most = fmax(most, fabs(displacement(one, i, j) + shift - displacement(other, i, j)));
    compliance_destroy(&one);
    compliance_destroy(&other);
    return most / unit;
}

/* The waves of a grid end at the shortest, which makes a small error of all kernels. */
static void check_padding(size_t n, bool profile, double thickness, double modulus) {
    struct block block = coated(thickness, modulus);
    double error = padding_error(n, profile, &block), bare = padding_error(n, profile, &DEEP);
    printf("%zu points, t %g, E1/E2 %g: %.1e, uncoated %.1e\n", n, thickness, modulus, error, bare);
    assert_true(error <= 5 * bare + 1e-6);
}

static void padding_does_not_matter(void **state) {
    (void)state;
    static const double THICKNESS[] = {0.2, 4, 300}, MODULUS[] = {0.1, 100};
    for (size_t t = 0; t < 3; t++)
        for (size_t m = 0; m < 2; m++) {
            check_padding(64, true, THICKNESS[t], MODULUS[m]);
            check_padding(8, true, THICKNESS[t], MODULUS[m]);
            check_padding(24, false, THICKNESS[t], MODULUS[m]);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_axisymmetric_solution_has_its_limits),
        cmocka_unit_test(paraboloids_on_coatings),
        cmocka_unit_test(a_slight_coating_weighs_by_its_energy),
        cmocka_unit_test(punches_lie_within_energy_bounds),
        cmocka_unit_test(padding_does_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

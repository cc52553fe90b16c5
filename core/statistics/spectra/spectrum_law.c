#include "core/statistics/spectra/spectrum_law.h"
#include <stdlib.h>
#include <string.h>

enum { STEPS_MOST = 60 };

/* The ring, over the last one, about which the density of a falling law is known best: the mean of
 * ring numbers by the number of modes, in logarithms. */
static const double INFORMED = 0.6;

static double logarithm_of(double wave_number) {
    return log(fmax(wave_number, LAW_FEWEST_WAVES));
}

int law_problem_create(struct law_problem **out, const struct map_spectrum *spectrum, size_t first,
                       size_t last, double floor, struct error *err) {
    const size_t count = last - first + 1, rings = count + 1;
    struct law_problem *problem = array_create(1, sizeof *problem);
    if (problem == NULL)
        return error_memory(err, sizeof *problem, "the fit of a spectrum");
    problem->spectrum = spectrum;
    problem->dimension = grid_is_profile(&spectrum->modes.grid) ? 1 : 2;
    problem->reference = INFORMED * (double)last;
    problem->reference_logarithm = log(problem->reference);
    problem->floor = floor;
    int status = spectrum_leakage_create(&problem->leakage, spectrum, first, last, err);
    if (status == 0) {
        problem->found = array_create(rings, sizeof *problem->found);
        problem->freedom = array_create(rings, sizeof *problem->freedom);
        problem->share = array_create(rings, sizeof *problem->share);
        problem->expected = array_create(rings, sizeof *problem->expected);
        problem->trial = array_create(rings, sizeof *problem->trial);
        problem->slope = array_create(LAW_PARAMETERS * rings, sizeof *problem->slope);
        problem->density = array_create(problem->leakage->nodes, sizeof *problem->density);
        problem->plain = array_create(problem->leakage->nodes, sizeof *problem->plain);
        problem->logarithm = array_create(problem->leakage->nodes, sizeof *problem->logarithm);
        if (problem->found == NULL || problem->freedom == NULL || problem->share == NULL ||
            problem->expected == NULL || problem->trial == NULL || problem->slope == NULL ||
            problem->density == NULL || problem->plain == NULL || problem->logarithm == NULL)
            status = error_memory(err, rings * sizeof *problem->slope, "the fit of a spectrum");
    }
    if (status != 0) {
        law_problem_destroy(&problem);
        return status;
    }
    for (size_t r = 0; r < count; r++)
        problem->found[r] = spectrum->density[first + r] + floor;
    memcpy(problem->freedom, spectrum->freedom + first, count * sizeof *problem->freedom);
    problem->rings = rings;
    problem->found[count] = 1; /* of no weight yet, as its freedom is 0 */
    problem->counted = count;
    for (size_t a = 0; a < problem->leakage->nodes; a++)
        problem->logarithm[a] = logarithm_of(problem->leakage->node[a]);
    problem->plain_of[0] = (double)NAN; /* of no law yet */
    *out = problem;
    return 0;
}

void law_problem_destroy(struct law_problem **problem) {
    struct law_problem *p = *problem;
    if (p == NULL)
        return;
    spectrum_leakage_destroy(&p->leakage);
    free(p->found);
    free(p->freedom);
    free(p->share);
    free(p->expected);
    free(p->trial);
    free(p->slope);
    free(p->density);
    free(p->plain);
    free(p->logarithm);
    free(p);
    *problem = NULL;
}

/* Fills the degrees of freedom of the mean over the rings that were put together. */
static void together_count(struct law_problem *p) {
    const struct map_spectrum *s = p->spectrum;
    const size_t count = p->leakage->count, first = p->leakage->first;
    double variance = 0;
    for (size_t r = 0; r < count; r++)
        for (size_t d = 0; d < RING_REACH && r + d < count; d++)
            variance += (d > 0 ? 2 : 1) * p->share[r] * s->density[first + r] * p->share[r + d] *
                        s->density[first + r + d] * s->covariance[first + r][d];
    const double mean = p->found[count] - p->floor;
    p->freedom[count] = variance > 0 ? 2 * mean * mean / variance : 0;
}

void law_problem_put_together(struct law_problem *problem, double low, double high) {
    const size_t count = problem->leakage->count;
    double modes = 0;
    for (size_t r = 0; r < count; r++) {
        const double ring = (double)(problem->leakage->first + r);
        if (!(ring >= low && ring <= high) || !(problem->freedom[r] > 0))
            continue;
        problem->freedom[r] = 0;
        problem->share[r] = problem->dimension == 1 ? 1 : ring;
        modes += problem->share[r];
    }
    if (!(modes > 0))
        return;
    problem->found[count] = 0;
    for (size_t r = 0; r < count; r++) {
        problem->share[r] /= modes;
        problem->found[count] += problem->share[r] * problem->found[r];
    }
    together_count(problem);
    problem->counted = 0;
    for (size_t r = 0; r <= count; r++)
        problem->counted += problem->freedom[r] > 0 ? 1 : 0;
}

double law_density(const struct law_problem *problem, const double *p, double logarithm) {
    double k = logarithm > p[LAW_ROLLOFF] ? logarithm : p[LAW_ROLLOFF];
    return exp(p[LAW_AMPLITUDE] -
               (problem->dimension + 2 * p[LAW_HURST]) * (k - problem->reference_logarithm));
}

/* Fills the plain densities, unless they are those of a law that differs only in ends, blur and
 * noise: their exponentials take most of the time of a trial. */
static void plain_fill(struct law_problem *problem, const double *p) {
    bool same = true;
    for (size_t a = 0; a < LAW_PLAIN; a++)
        same = same && problem->plain_of[a] == p[a];
    if (same)
        return;
    for (size_t a = 0; a < problem->leakage->nodes; a++)
        problem->plain[a] = law_density(problem, p, problem->logarithm[a]);
    memcpy(problem->plain_of, p, sizeof problem->plain_of);
}

/* The share of a node's width that lies below a wave number. */
static double share_below(double node, double width, double edge) {
    return fmin(fmax((edge - node) / width + 0.5, 0), 1);
}

static void expect(struct law_problem *problem, const double *p, double *expected) {
    const struct spectrum_leakage *leakage = problem->leakage;
    double highest = exp(p[LAW_SHORT]), lowest = exp(p[LAW_LONG]), blur = exp(p[LAW_BLUR]),
           noise = exp(p[LAW_NOISE]);
    plain_fill(problem, p);
    for (size_t a = 0; a < leakage->nodes; a++) {
        double node = leakage->node[a];
        double share = share_below(node, leakage->width, highest) -
                       share_below(node, leakage->width, fmin(lowest, highest));
        if (share > 0 && blur > 0)
            share *= exp(-blur * node * node);
        problem->density[a] = share > 0 ? share * problem->plain[a] : 0;
    }
    spectrum_leakage_apply(leakage, problem->density, expected);
    double *together = &expected[leakage->count];
    *together = problem->freedom[leakage->count] > 0 ? 0 : 1;
    for (size_t r = 0; r < leakage->count; r++) {
        expected[r] += noise + problem->floor;
        *together += problem->share[r] * expected[r];
    }
}

static double deviance(const struct law_problem *problem, const double *expected) {
    const double *freedom = problem->freedom;
    double total = 0;
    for (size_t r = 0; r < problem->rings; r++) {
        double ratio = problem->found[r] / expected[r];
        total += freedom[r] * (ratio - 1 - log(ratio));
    }
    return total;
}

static double clamp(double value, double low, double high) {
    return fmin(fmax(value, low), high);
}

/* Fills slope at p, of which the rings are as expected; a step is taken inwards where p is at its
 * upper bound. */
static void differentiate(struct law_problem *problem, const struct law *law) {
    static const double STEP = 1e-4;
    const size_t count = problem->rings;
    for (size_t a = 0; a < LAW_PARAMETERS; a++) {
        double moved[LAW_PARAMETERS], *slope = problem->slope + a * count;
        if (!law->free[a])
            continue;
        memcpy(moved, law->p, sizeof moved);
        double step = moved[a] + STEP > problem->high[a] ? -STEP : STEP;
        moved[a] += step;
        expect(problem, moved, slope);
    }
    for (size_t a = 0; a < LAW_PARAMETERS; a++)
        if (law->free[a]) {
            double step = law->p[a] + STEP > problem->high[a] ? -STEP : STEP;
            for (size_t r = 0; r < count; r++)
                problem->slope[a * count + r] =
                    (problem->slope[a * count + r] / problem->expected[r] - 1) / step;
        }
}

/* Replaces a matrix by its Cholesky factor; false where it is not positive. */
static bool factorise(law_matrix matrix) {
    for (size_t a = 0; a < LAW_PARAMETERS; a++)
        for (size_t b = 0; b <= a; b++) {
            double sum = matrix[a][b];
            for (size_t c = 0; c < b; c++)
                sum -= matrix[a][c] * matrix[b][c];
            if (a == b && !(sum > 0))
                return false;
            matrix[a][b] = a == b ? sqrt(sum) : sum / matrix[b][b];
        }
    return true;
}

static void solve(law_matrix factor, double *right) {
    for (size_t a = 0; a < LAW_PARAMETERS; a++) {
        for (size_t c = 0; c < a; c++)
            right[a] -= factor[a][c] * right[c];
        right[a] /= factor[a][a];
    }
    for (size_t a = LAW_PARAMETERS; a-- > 0;) {
        for (size_t c = a + 1; c < LAW_PARAMETERS; c++)
            right[a] -= factor[c][a] * right[c];
        right[a] /= factor[a][a];
    }
}

/* Returns how much more likely rings become as a parameter rises. */
static double gradient_of(const struct law_problem *problem, size_t a) {
    const double *freedom = problem->freedom;
    const double *slope = problem->slope + a * problem->rings;
    double total = 0;
    for (size_t r = 0; r < problem->rings; r++)
        total += slope[r] * freedom[r] / 2 * (problem->found[r] / problem->expected[r] - 1);
    return total;
}

/* Fills Fisher's information of the rings on the parameters, 1 on the diagonal for those that are
 * held. A parameter that the rings do not determine, such as a roll-off beyond them, has TINY. */
static void inform(const struct law_problem *problem, const bool *held, law_matrix information) {
    static const double TINY = 1e-9;
    const double *freedom = problem->freedom;
    const size_t count = problem->rings;
    for (size_t a = 0; a < LAW_PARAMETERS; a++)
        for (size_t b = 0; b <= a; b++) {
            const double *one = problem->slope + a * count, *other = problem->slope + b * count;
            double total = a != b ? 0 : held[a] ? 1 : TINY;
            for (size_t r = 0; r < count && !held[a] && !held[b]; r++)
                total += one[r] * other[r] * freedom[r] / 2;
            information[a][b] = information[b][a] = total;
        }
}

/* Tries one damped step from where the slopes are; returns whether it made a better law. What is at
 * a bound and would go beyond is held. */
static bool step(struct law_problem *problem, struct law *law, double damping) {
    law_matrix information;
    double move[LAW_PARAMETERS] = {0};
    bool held[LAW_PARAMETERS];
    struct law next = *law;
    for (size_t a = 0; a < LAW_PARAMETERS; a++) {
        if (law->free[a])
            move[a] = gradient_of(problem, a);
        held[a] = !law->free[a] || (law->p[a] <= problem->low[a] && move[a] < 0) ||
                  (law->p[a] >= problem->high[a] && move[a] > 0);
        if (held[a])
            move[a] = 0;
    }
    inform(problem, held, information);
    for (size_t a = 0; a < LAW_PARAMETERS; a++)
        information[a][a] *= 1 + damping;
    if (!factorise(information))
        return false;
    solve(information, move);
    for (size_t a = 0; a < LAW_PARAMETERS; a++)
        if (!held[a])
            next.p[a] = clamp(law->p[a] + clamp(move[a], -1, 1), problem->low[a], problem->high[a]);
    law_evaluate(problem, &next);
    if (!(next.deviance < law->deviance))
        return false;
    *law = next;
    return true;
}

void law_evaluate(struct law_problem *problem, struct law *law) {
    expect(problem, law->p, problem->trial);
    law->deviance = deviance(problem, problem->trial);
}

void law_maximise(struct law_problem *problem, struct law *law) {
    static const double SETTLED = 1e-4, DAMPING_MOST = 1e6;
    double damping = 1e-3;
    law_evaluate(problem, law);
    for (int steps = 0; steps < STEPS_MOST && damping < DAMPING_MOST; steps++) {
        double before = law->deviance;
        /* The law is the last one that was tried. */
        memcpy(problem->expected, problem->trial, problem->rings * sizeof *problem->expected);
        differentiate(problem, law);
        while (damping < DAMPING_MOST && !step(problem, law, damping))
            damping *= 8;
        if (before - law->deviance < SETTLED)
            return;
        damping = fmax(damping / 20, 1e-6);
    }
}

/* Returns what the relative density of a ring weighs in the gradient along a parameter, by itself
 * or among those that were put together; the floor adds no variance. */
static double gradient_weight(const struct law_problem *p, size_t a, size_t r) {
    const size_t together = p->leakage->count;
    const double *slope = p->slope + a * p->rings;
    const double part = p->share[r] * p->expected[r] / p->expected[together];
    const double weight = slope[r] * p->freedom[r] + part * slope[together] * p->freedom[together];
    return weight / 2 * (1 - p->floor / p->expected[r]);
}

/* Fills the covariance of the gradient: the densities of near rings are correlated. */
static void gradient_covariance(const struct law_problem *problem, const struct law *law,
                                law_matrix out) {
    const struct map_spectrum *s = problem->spectrum;
    const size_t count = problem->leakage->count, first = problem->leakage->first;
    memset(out, 0, sizeof(law_matrix));
    for (size_t r = 0; r < count; r++) {
        double here[LAW_PARAMETERS];
        for (size_t a = 0; a < LAW_PARAMETERS; a++)
            here[a] = law->free[a] ? gradient_weight(problem, a, r) : 0;
        for (size_t d = 0; d < RING_REACH && r + d < count; d++)
            for (size_t a = 0; a < LAW_PARAMETERS; a++) {
                const double there = law->free[a] ? gradient_weight(problem, a, r + d) : 0;
                for (size_t b = 0; b < LAW_PARAMETERS; b++) {
                    const double both = here[b] * there * s->covariance[first + r][d];
                    out[a][b] += both;
                    out[b][a] += d > 0 ? both : 0;
                }
            }
    }
}

bool law_covariance(struct law_problem *problem, const struct law *law, law_matrix likelihood,
                    law_matrix covariance) {
    law_matrix information, middle;
    bool held[LAW_PARAMETERS];
    for (size_t a = 0; a < LAW_PARAMETERS; a++)
        held[a] = !law->free[a];
    expect(problem, law->p, problem->expected);
    differentiate(problem, law);
    inform(problem, held, information);
    if (!factorise(information))
        return false;
    for (size_t a = 0; a < LAW_PARAMETERS; a++) {
        for (size_t b = 0; b < LAW_PARAMETERS; b++)
            likelihood[a][b] = a == b ? 1 : 0;
        solve(information, likelihood[a]);
    }
    gradient_covariance(problem, law, middle);
    for (size_t a = 0; a < LAW_PARAMETERS; a++)
        for (size_t b = 0; b < LAW_PARAMETERS; b++) {
            covariance[a][b] = 0;
            for (size_t c = 0; c < LAW_PARAMETERS; c++)
                for (size_t d = 0; d < LAW_PARAMETERS; d++)
                    covariance[a][b] += likelihood[a][c] * middle[c][d] * likelihood[d][b];
        }
    return true;
}

/* Returns how much less than the rise the deviance is where the parameter is held at a value. */
static double shortfall(struct law_problem *problem, struct law *law, enum law_parameter parameter,
                        double value, double deviance_wanted) {
    law->free[parameter] = false;
    law->p[parameter] = value;
    law_maximise(problem, law);
    return law->deviance - deviance_wanted;
}

double law_bound(struct law_problem *problem, const struct law *best, enum law_parameter parameter,
                 int direction, double rise, double step_first) {
    enum { TRIES = 24, HALVINGS = 12 };
    double limit = direction > 0 ? problem->high[parameter] : problem->low[parameter];
    double inside = best->p[parameter], below = -rise, wanted = best->deviance + rise;
    double outside = inside, above = -1, width = clamp(step_first, 1e-5, 0.5);
    struct law law = *best, at_inside = *best;
    for (int tries = 0; tries < TRIES && above < 0; tries++) {
        outside = direction > 0 ? fmin(inside + width, limit) : fmax(inside - width, limit);
        above = shortfall(problem, &law, parameter, outside, wanted);
        if (above < 0 && outside == limit)
            return (double)NAN;
        if (above < 0) {
            inside = outside;
            below = above;
            at_inside = law;
            width *= 1.6;
        }
    }
    if (above < 0)
        return (double)NAN;
    for (int n = 0; n < HALVINGS && fabs(above) > 0.02 * rise; n++) {
        /* the root of the deviance is about straight */
        double low = sqrt(fmax(below + rise, 0)), high = sqrt(above + rise), at = sqrt(rise);
        double part = n % 3 == 2 ? 0.5 : clamp((at - low) / (high - low), 0.05, 0.95);
        double middle = inside + part * (outside - inside);
        law = at_inside;
        double found = shortfall(problem, &law, parameter, middle, wanted);
        if (found < 0) {
            inside = middle;
            below = found;
            at_inside = law;
            if (-found < 0.02 * rise)
                return middle;
        } else {
            outside = middle;
            above = found;
        }
    }
    return outside;
}

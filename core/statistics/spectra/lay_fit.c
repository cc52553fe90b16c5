#include "core/statistics/spectra/lay_fit.h"
#include "core/statistics/spectra/windowed_psd.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Knots of the density over k': so many an octave, or fewer, with so many waves from one to the
 * next.
 */
enum { KNOTS_AN_OCTAVE = 8, FEWEST_WAVES = 24, OCTAVES_MOST = 32, STEPS_MOST = 40 };
enum { KNOTS_LEAST = 4, KNOTS_MOST = OCTAVES_MOST * KNOTS_AN_OCTAVE };
/* Of the density over the wave number, in logarithms: steeper ones are those of sharp ends, which
 * the window blurs. */
static const double STEEPEST = 6;
/* Of the errors found to those estimated without it, over 384 sub-maps of known lay (F18.29). */
static const double MEASURED = 1.05;
static const double RATIO_MOST = 100;
/* Times the mean density: one of 160 000 waves of random amplitudes has more. */
static const double FAR = 12;

/* The density at knots, each the mean over the waves up to the next ones, which count the less the
 * farther they are: so it changes smoothly with the lay. All are logarithms. */
struct profile {
    size_t knots;
    double knot[KNOTS_MOST];    /* of k', in waves per side */
    double wave[KNOTS_MOST];    /* mean of the waves of a knot */
    double density[KNOTS_MOST]; /* of any unit */
    double slope[KNOTS_MOST];   /* of the density */
    double weight[KNOTS_MOST];  /* of the waves, all together */
};

/* What the waves say of the logarithm of the ratio, and of the angle. */
struct score {
    double gradient[2], information[2][2]; /* of the likelihood of independent waves */
};

struct wave {
    size_t number;    /* among those of the half: see half_of() */
    double u, v;      /* its components along the lay, times the ratio, and across it */
    double square;    /* k'^2 */
    double logarithm; /* of k' */
    double density;   /* of any unit */
};

typedef void wave_visit(const struct wave *wave, void *context);

/* The half of the plane, as an array: columns mx from 0, rows my from -most_y. */
struct half {
    size_t columns;
    long most_y;
};

static struct half half_of(const struct grid *grid) {
    return (struct half){(grid->nx + 1) / 2, ((long)grid->ny - 1) / 2};
}

static size_t half_waves(const struct half *half) {
    return half->columns * (2 * (size_t)half->most_y + 1);
}

static size_t number_of(const struct half *half, size_t mx, long my) {
    return mx * (2 * (size_t)half->most_y + 1) + (size_t)(my + half->most_y);
}

/* Goes over the waves of one half of the plane, each of which stands for its image. */
static void each_wave(const struct map_spectrum *s, const struct lay_frame *frame,
                      wave_visit *visit, void *context) {
    const struct grid *grid = &s->modes.grid;
    const struct half half = half_of(grid);
    for (size_t mx = 0; mx < half.columns; mx++)
        for (long my = mx > 0 ? -half.most_y : 1; my <= half.most_y; my++) {
            double x = (double)mx * (s->side / grid->lx), y = (double)my * (s->side / grid->ly);
            struct wave wave = {.number = number_of(&half, mx, my),
                                .u = frame->along_x * x + frame->along_y * y,
                                .v = frame->across_x * x + frame->across_y * y,
                                .density = modes_power(&s->modes, mx, my)};
            wave.square = wave.u * wave.u + wave.v * wave.v;
            wave.logarithm = log(wave.square) / 2;
            visit(&wave, context);
        }
}

/* Finds the knot before a logarithm of k', and how far it lies towards the next; false outside. */
static bool knot_before(const struct profile *profile, double logarithm, size_t *knot,
                        double *part) {
    size_t low = 0, high = profile->knots - 1;
    if (!(logarithm >= profile->knot[low] && logarithm < profile->knot[high]))
        return false;
    while (high - low > 1) {
        size_t middle = (low + high) / 2;
        if (profile->knot[middle] <= logarithm)
            low = middle;
        else
            high = middle;
    }
    *knot = low;
    *part = (logarithm - profile->knot[low]) / (profile->knot[high] - profile->knot[low]);
    return true;
}

/* Waves counted in even parts of octaves. */
struct wave_counts {
    double low, high; /* logarithms of k' */
    size_t bins;
    double count[KNOTS_MOST];
};

static void wave_count(const struct wave *wave, void *context) {
    struct wave_counts *counts = context;
    if (!(wave->logarithm >= counts->low && wave->logarithm < counts->high))
        return;
    size_t b = (size_t)((wave->logarithm - counts->low) / M_LN2 * KNOTS_AN_OCTAVE);
    counts->count[b < counts->bins ? b : counts->bins - 1]++;
}

/* Chooses the knots from low to high waves per side, by the waves of a lay. */
static void profile_begin(struct profile *profile, const struct map_spectrum *s,
                          const struct lay_frame *frame, double low, double high) {
    struct wave_counts counts = {.low = log(low), .high = log(high)};
    double waves = 0;
    counts.bins = (size_t)((counts.high - counts.low) / M_LN2 * KNOTS_AN_OCTAVE) + 1;
    each_wave(s, frame, wave_count, &counts);
    profile->knots = 1;
    profile->knot[0] = counts.low;
    for (size_t b = 0; b < counts.bins; b++) {
        waves += counts.count[b];
        if (waves < FEWEST_WAVES)
            continue;
        profile->knot[profile->knots++] =
            fmin(counts.low + (double)(b + 1) / KNOTS_AN_OCTAVE * M_LN2, counts.high);
        waves = 0;
    }
}

static void profile_add(const struct wave *wave, void *context) {
    struct profile *profile = context;
    size_t knot;
    double part;
    if (!knot_before(profile, wave->logarithm, &knot, &part))
        return;
    for (size_t n = knot; n < knot + 2; n++) {
        double weight = n == knot ? 1 - part : part;
        profile->weight[n] += weight;
        profile->wave[n] += weight * wave->logarithm;
        profile->density[n] += weight * wave->density;
    }
}

static void profile_measure(struct profile *profile, const struct map_spectrum *s,
                            const struct lay_frame *frame) {
    const size_t knots = profile->knots;
    for (size_t n = 0; n < knots; n++)
        profile->weight[n] = profile->wave[n] = profile->density[n] = 0;
    each_wave(s, frame, profile_add, profile);
    for (size_t n = 0; n < knots; n++) {
        profile->wave[n] /= profile->weight[n];
        profile->density[n] = log(fmax(profile->density[n] / profile->weight[n], 1e-300));
    }
    for (size_t n = 0; n < knots; n++) {
        size_t before = n > 0 ? n - 1 : n, after = n + 1 < knots ? n + 1 : n;
        profile->slope[n] = (profile->density[after] - profile->density[before]) /
                            (profile->wave[after] - profile->wave[before]);
    }
}

/* What waves are asked at a lay. */
struct scoring {
    const struct profile *profile;
    double turn; /* r - 1/r */
    struct score score;
    double (*by)[2]; /* borrowed: of each wave of the half; others than those that count: 0 */
};

/* Adds what a wave says. k' is taken over the root of the ratio, so that ellipses of all ratios
 * have the same area. */
static void score_add(const struct wave *wave, void *context) {
    struct scoring *scoring = context;
    const struct profile *profile = scoring->profile;
    size_t knot;
    double part;
    if (!knot_before(profile, wave->logarithm, &knot, &part))
        return;
    const double at_knot = wave->logarithm - profile->wave[knot];
    const double at_next = wave->logarithm - profile->wave[knot + 1];
    const double expected = /* by the lines through both knots */
        (1 - part) * (profile->density[knot] + profile->slope[knot] * at_knot) +
        part * (profile->density[knot + 1] + profile->slope[knot + 1] * at_next);
    const double slope = (1 - part) * profile->slope[knot] + part * profile->slope[knot + 1];
    const double excess = fmin(wave->density / exp(expected), FAR) - 1;
    const double fall = fmin(fmax(slope, -STEEPEST), STEEPEST);
    /* none enters or leaves all at once */
    const double counts = knot == 0 ? part : knot + 2 == profile->knots ? 1 - part : 1;
    /* of the logarithm of the density by those of the ratio and by the angle */
    const double by[2] = {fall * (wave->u * wave->u - wave->v * wave->v) / (2 * wave->square),
                          fall * scoring->turn * wave->u * wave->v / wave->square};
    for (size_t a = 0; a < 2; a++) {
        scoring->by[wave->number][a] = counts * by[a];
        scoring->score.gradient[a] += counts * excess * by[a];
        for (size_t b = 0; b < 2; b++)
            scoring->score.information[a][b] += counts * by[a] * by[b];
    }
}

/* Returns what is kept of a wave, or of its image in the half; NULL beyond the waves of the points.
 */
static const double *kept_at(const struct half *half, double (*by)[2], long x, long y) {
    const bool image = x < 0 || (x == 0 && y < 0);
    const long mx = image ? -x : x, my = image ? -y : y;
    return mx < (long)half->columns && labs(my) <= half->most_y
               ? by[number_of(half, (size_t)mx, my)]
               : NULL;
}

/* Adds what is kept of a wave and of its neighbours, as far as these are alike. */
static void neighbours_add(const struct half *half, double (*by)[2], long reach, long mx, long my,
                           double sums[2]) {
    for (long x = -reach; x <= reach; x++)
        for (long y = -reach; y <= reach; y++) {
            const double *there = kept_at(half, by, mx + x, my + y);
            const double share = windowed_alike(x) * windowed_alike(y);
            sums[0] += there != NULL ? share * there[0] : 0;
            sums[1] += there != NULL ? share * there[1] : 0;
        }
}

/* Fills the covariance of the gradient. */
static void covariance_fill(const struct map_spectrum *s, double (*by)[2], double out[2][2]) {
    const struct half half = half_of(&s->modes.grid);
    const long reach = s->windowed ? WINDOWED_REACH : 0;
    memset(out, 0, sizeof(double[2][2]));
    for (size_t mx = 0; mx < half.columns; mx++)
        for (long my = mx > 0 ? -half.most_y : 1; my <= half.most_y; my++) {
            const double *here = by[number_of(&half, mx, my)];
            double alike[2] = {0, 0};
            neighbours_add(&half, by, reach, (long)mx, my, alike);
            for (size_t a = 0; a < 2; a++)
                for (size_t b = 0; b < 2; b++)
                    out[a][b] += here[a] * alike[b];
        }
}

/* Fills the errors, H^-1 M H^-1 by the information H and the covariance M (White 1982). */
static void errors_fill(struct lay *lay, const struct map_spectrum *s, const struct score *score,
                        double (*by)[2]) {
    const double(*i)[2] = score->information;
    const double determinant = i[0][0] * i[1][1] - i[0][1] * i[1][0];
    const double inverse[2][2] = {{i[1][1] / determinant, -i[0][1] / determinant},
                                  {-i[1][0] / determinant, i[0][0] / determinant}};
    double covariance[2][2], variance[2] = {0, 0};
    covariance_fill(s, by, covariance);
    for (size_t p = 0; p < 2; p++)
        for (size_t a = 0; a < 2; a++)
            for (size_t b = 0; b < 2; b++)
                variance[p] += inverse[p][a] * covariance[a][b] * inverse[b][p];
    lay->ratio_error = MEASURED * sqrt(variance[0] / s->heights);
    lay->angle_error = MEASURED * sqrt(variance[1] / s->heights);
}

/* Solves for the step; false where the waves do not determine it. */
static bool score_step(const struct score *score, double step[2], double error[2]) {
    const double(*i)[2] = score->information;
    double determinant = i[0][0] * i[1][1] - i[0][1] * i[1][0];
    if (!(determinant > 1e-12 * i[0][0] * i[1][1]))
        return false;
    step[0] = (i[1][1] * score->gradient[0] - i[0][1] * score->gradient[1]) / determinant;
    step[1] = (i[0][0] * score->gradient[1] - i[1][0] * score->gradient[0]) / determinant;
    error[0] = sqrt(i[1][1] / determinant);
    error[1] = sqrt(i[0][0] / determinant);
    return true;
}

static void lay_turn(struct lay *lay) {
    if (lay->ratio < 1) {
        lay->ratio = 1 / lay->ratio;
        lay->angle += M_PI / 2;
    }
    lay->angle = remainder(lay->angle, M_PI);
    lay->angle = lay->angle <= -M_PI / 2 ? M_PI / 2 : lay->angle;
}

/* Goes up the likelihood from the lay, until a step is far shorter than the error; false where none
 * becomes so. */
static bool climb(struct lay *lay, const struct map_spectrum *s, struct profile *profile,
                  double (*by)[2]) {
    static const double LONGEST = 0.3, SETTLED = 0.02; /* of steps; of standard errors */
    static const double NEARLY = 0.5;
    enum { FREE = 8 }; /* so many steps are whole, the next ones halves, then quarters, ... */
    const struct half half = half_of(&s->modes.grid);
    const size_t waves = half_waves(&half);
    for (int steps = 0;; steps++) {
        const struct lay_frame frame = lay_frame_of(lay);
        struct scoring scoring = {
            .profile = profile, .turn = lay->ratio - 1 / lay->ratio, .by = by};
        double step[2], error[2];
        profile_measure(profile, s, &frame);
        memset(by, 0, waves * sizeof *by);
        each_wave(s, &frame, score_add, &scoring);
        if (!score_step(&scoring.score, step, error))
            return false;
        const double moved = fmax(fabs(step[0]) / error[0], fabs(step[1]) / error[1]);
        if (moved < SETTLED || steps == STEPS_MOST) {
            errors_fill(lay, s, &scoring.score, by);
            return moved < NEARLY;
        }
        const double part = ldexp(1, -(steps / FREE));
        lay->ratio *= exp(part * fmin(fmax(step[0], -LONGEST), LONGEST));
        lay->angle += part * fmin(fmax(step[1], -LONGEST), LONGEST);
        lay_turn(lay);
        if (!(lay->ratio < RATIO_MOST))
            return false;
    }
}

/* Finds the wave numbers that count, in waves per side: those whose rings can be trusted, before a
 * sharp end. */
static int range_find(double *low, double *high, const struct map_spectrum *circles,
                      const struct lay *lay, const struct spectrum_fit_request *request,
                      struct error *err) {
    struct map_spectrum *ellipses = NULL;
    struct spectrum_range range;
    int status = map_spectrum_create_along(&ellipses, circles, lay, err);
    if (status == 0)
        status = spectrum_range_find(ellipses, request, &range, err);
    map_spectrum_destroy(&ellipses);
    if (status != 0)
        return status;
    size_t last =
        range.edge > SPECTRUM_BLURRED + range.first ? range.edge - SPECTRUM_BLURRED : range.last;
    *low = (double)range.first - 0.5;
    *high = (double)last + 0.5;
    return 0;
}

/* Refines the lay over the wave numbers that count by it; *found: whether it is one. */
static int refine(struct lay *lay, bool *found, const struct map_spectrum *circles,
                  const struct spectrum_fit_request *request, struct profile *profile,
                  double (*by)[2], struct error *err) {
    double low, high;
    int status = range_find(&low, &high, circles, lay, request, err);
    *found = status == 0 && low > 0 && low < high && log2(high / low) < OCTAVES_MOST - 1;
    if (!*found)
        return status;
    const struct lay_frame frame = lay_frame_of(lay);
    profile_begin(profile, circles, &frame, low, high);
    *found = profile->knots >= KNOTS_LEAST && climb(lay, circles, profile, by);
    return 0;
}

int lay_fit_measure(struct lay *out, const struct lay *start, const struct map_spectrum *circles,
                    const struct spectrum_fit_request *request, struct error *err) {
    enum { ROUNDS = 2 }; /* the first ends with the lay by which the sharp end is seen as one */
    struct lay lay = {.ratio = start->ratio, .angle = start->angle};
    bool found = lay.ratio >= 1 && lay.ratio < RATIO_MOST;
    *out = LAY_NONE;
    lay_turn(&lay);
    const struct half half = half_of(&circles->modes.grid);
    const size_t waves = half_waves(&half);
    struct profile *profile = array_create(1, sizeof *profile);
    double(*by)[2] = array_create(waves, sizeof *by);
    int status =
        profile == NULL || by == NULL
            ? error_memory(err, sizeof *profile + waves * sizeof *by, "the lay of a spectrum")
            : 0;
    for (int round = 0; round < ROUNDS && found && status == 0; round++)
        status = refine(&lay, &found, circles, request, profile, by, err);
    if (status == 0 && found)
        *out = lay;
    free(profile);
    free(by);
    return status;
}

double lay_p_value(const struct lay *lay) {
    double score = log(lay->ratio) / lay->ratio_error; /* chi squared of two degrees of freedom */
    return lay_is_plain(lay) ? 1 : exp(-score * score / 2);
}

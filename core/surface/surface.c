#include "core/surface/surface.h"
#include "core/surface/counter_face.h"
#include "core/surface/grooves/grooves.h"
#include "core/surface/iteration/nongaussian.h"
#include "core/surface/plateau_face.h"
#include "core/surface/surface_options.h"
#include "core/surface/transform.h"
#include "core/surface/translation/translation.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The counter face of a surface, and the sum of both; or the plateau of a stratified face, and the
 * lower of both. */
struct sum_of_faces {
    struct generator *counter; /* owned, as all below */
    struct modes *modes;       /* prescribed */
    struct modes *drawn;       /* of the last run; NULL of a stratified face, as the next */
    struct transform *transform;
    double *z;                         /* of the second face */
    struct stratified_heights heights; /* of a stratified face */
};

struct generator {
    struct modes *modes; /* of the first face, as all below */
    struct transform *transform;
    struct nongaussian *nongaussian; /* NULL: Gaussian heights */
    struct modes *drawn;             /* spectrum of the last draw, where amplitudes are random; else
                                        NULL */
    double *amplitude;  /* sqrt(power), rows of wave numbers: [(my + mode_y)*(mode_x + 1) + mx] */
    size_t *row_length; /* 2 mode_y + 1: 1 + highest mx of the row with power; 0: none */
    uint64_t *words;    /* mode_x + 1, as row_drawn */
    double *row_drawn;  /* amplitudes of a row, where they are random; else NULL */
    double *gaussian;   /* borrowed: where the Gaussian field is kept; NULL: nowhere */
    struct sum_of_faces *sum; /* owned; NULL: there is one face */
    struct grooves grooves;   /* beside the random part; no families: none */
    double rms_height;        /* of the random part, where there are grooves */
};

static void amplitudes_fill(struct generator *g) {
    const struct modes *modes = g->modes;
    size_t columns = modes->mode_x + 1;
    long mode_y = (long)modes->mode_y;
    for (long my = -mode_y; my <= mode_y; my++) {
        size_t row = (size_t)(my + mode_y);
        for (size_t mx = 0; mx < columns; mx++) {
            double power = modes_power(modes, mx, my);
            g->amplitude[row * columns + mx] = sqrt(power);
            if (power > 0)
                g->row_length[row] = mx + 1;
        }
    }
}

static int arrays_create(struct generator *g, bool random, struct error *err) {
    size_t columns = g->modes->mode_x + 1, rows = 2 * g->modes->mode_y + 1;
    g->amplitude = array_create(columns * rows, sizeof *g->amplitude);
    g->row_length = array_create(rows, sizeof *g->row_length);
    g->words = array_create(columns, sizeof *g->words);
    g->row_drawn = random ? array_create(columns, sizeof *g->row_drawn) : NULL;
    if (g->amplitude == NULL || g->row_length == NULL || g->words == NULL ||
        (random && g->row_drawn == NULL))
        return error_memory(err, columns * rows * sizeof *g->amplitude, "amplitudes");
    amplitudes_fill(g);
    return 0;
}

/* Allocates the spectrum of a draw, which is that of the mean until something is drawn. */
static int drawn_create(struct modes **out, const struct modes *modes, struct error *err) {
    size_t count = (modes->mode_x + 1) * (2 * modes->mode_y + 1);
    struct modes *drawn = array_create(1, sizeof *drawn);
    double *power = array_create(count, sizeof *power);
    if (drawn == NULL || power == NULL) {
        free(drawn);
        free(power);
        return error_memory(err, count * sizeof *power, "a drawn spectrum");
    }
    memcpy(power, modes->power, count * sizeof *power);
    *drawn = *modes;
    drawn->power = power;
    *out = drawn;
    return 0;
}

static int face_create(struct generator **out, const struct spectrum *spectrum,
                       const struct grid *grid, const struct surface_options *options,
                       struct error *err) {
    struct generator *g = array_create(1, sizeof *g);
    if (g == NULL)
        return error_memory(err, sizeof *g, "a generator");
    bool random = options->amplitudes == AMPLITUDES_RANDOM;
    bool iterated = surface_is_iterated(options);
    struct spectrum face = *spectrum;
    face.counter = NULL;
    face.plateau = NULL;
    int status = modes_create(&g->modes, &face, grid, err);
    if (status == 0)
        status = transform_create(&g->transform, grid, g->modes->mode_x, g->modes->mode_y, err);
    if (status == 0)
        status = arrays_create(g, random, err);
    if (status == 0 && random)
        status = drawn_create(&g->drawn, g->modes, err);
    if (status == 0 && iterated)
        status = nongaussian_create(&g->nongaussian, random ? g->drawn : g->modes, options, err);
    if (status != 0) {
        generator_destroy(&g);
        return status;
    }
    *out = g;
    return 0;
}

static void face_destroy(struct generator **generator) {
    struct generator *g = *generator;
    if (g == NULL)
        return;
    nongaussian_destroy(&g->nongaussian);
    transform_destroy(&g->transform);
    modes_destroy(&g->modes);
    modes_destroy(&g->drawn);
    free(g->amplitude);
    free(g->row_length);
    free(g->words);
    free(g->row_drawn);
    free(g);
    *generator = NULL;
}

/* Adds the plateau of the spectrum. */
static int stratified_create(struct sum_of_faces *sum, const struct modes *valleys,
                             const struct spectrum *spectrum, const struct grid *grid,
                             struct error *err) {
    struct moments own;
    modes_moments(valleys, &own);
    const struct spectrum plateau = plateau_spectrum(spectrum, own.rms_height);
    sum->heights = stratified_heights_of(own.rms_height, plateau.scale_value,
                                         spectrum->plateau->offset * own.rms_height);
    int status = modes_create(&sum->modes, spectrum, grid, err);
    return status == 0
               ? face_create(&sum->counter, &plateau, grid, &spectrum->plateau->options, err)
               : status;
}

/* Adds the counter face of the spectrum. */
static int counter_create(struct sum_of_faces *sum, const struct spectrum *spectrum,
                          const struct grid *grid, const struct surface_options *options,
                          struct error *err) {
    struct surface_options counter = spectrum->counter->options;
    counter.stop = options->stop;
    counter.stop_context = options->stop_context;
    int status = modes_create(&sum->modes, spectrum, grid, err);
    if (status == 0)
        status = drawn_create(&sum->drawn, sum->modes, err);
    if (status == 0)
        status =
            transform_create(&sum->transform, grid, sum->modes->mode_x, sum->modes->mode_y, err);
    return status == 0
               ? face_create(&sum->counter, &spectrum->counter->spectrum, grid, &counter, err)
               : status;
}

static int sum_create(struct generator *g, const struct spectrum *spectrum, const struct grid *grid,
                      const struct surface_options *options, struct error *err) {
    struct sum_of_faces *sum = array_create(1, sizeof *sum);
    if (sum == NULL)
        return error_memory(err, sizeof *sum, "a second face");
    g->sum = sum;
    int status = spectrum->plateau != NULL ? stratified_create(sum, g->modes, spectrum, grid, err)
                                           : counter_create(sum, spectrum, grid, options, err);
    if (status != 0)
        return status;
    sum->z = array_create(grid_points(grid), sizeof *sum->z);
    return sum->z != NULL ? 0
                          : error_memory(err, grid_points(grid) * sizeof *sum->z, "a second face");
}

static void sum_destroy(struct sum_of_faces **sum) {
    struct sum_of_faces *gone = *sum;
    if (gone == NULL)
        return;
    face_destroy(&gone->counter);
    modes_destroy(&gone->modes);
    modes_destroy(&gone->drawn);
    transform_destroy(&gone->transform);
    free(gone->z);
    free(gone);
    *sum = NULL;
}

static void grooves_take(struct generator *g, const struct grooves *grooves) {
    struct moments moments;
    modes_moments(g->modes, &moments);
    g->grooves = *grooves;
    g->rms_height = moments.rms_height;
}

int generator_create(struct generator **out, const struct spectrum *spectrum,
                     const struct grid *grid, const struct surface_options *options,
                     struct error *err) {
    struct generator *g = NULL;
    int status = face_create(&g, spectrum, grid, options, err);
    if (status == 0 && (spectrum->counter != NULL || spectrum->plateau != NULL))
        status = sum_create(g, spectrum, grid, options, err);
    if (status == 0 && spectrum->grooves != NULL)
        grooves_take(g, spectrum->grooves);
    if (status != 0)
        generator_destroy(&g);
    else
        *out = g;
    return status;
}

void generator_destroy(struct generator **generator) {
    if (*generator != NULL)
        sum_destroy(&(*generator)->sum);
    face_destroy(generator);
}

int generator_set_team(struct generator *generator, struct team *team, struct error *err) {
    struct sum_of_faces *sum = generator->sum;
    int status = transform_set_team(generator->transform, team, err);
    if (status == 0 && sum != NULL)
        status = transform_set_team(sum->counter->transform, team, err);
    return status == 0 && sum != NULL && sum->transform != NULL
               ? transform_set_team(sum->transform, team, err)
               : status;
}

const struct modes *generator_modes(const struct generator *generator) {
    return generator->sum != NULL ? generator->sum->modes : generator->modes;
}

const struct modes *generator_drawn(const struct generator *generator) {
    if (generator->sum != NULL)
        return generator->sum->drawn != NULL ? generator->sum->drawn : generator->sum->modes;
    return generator->drawn != NULL ? generator->drawn : generator->modes;
}

/* Of the tables of a law of translation, which do not grow with the grid. */
static const double TRANSLATION_BYTES = 6e6;

double generator_bytes(const struct grid *grid, size_t mode_x, size_t mode_y,
                       const struct surface_options *options) {
    double points = (double)grid->nx * (double)grid->ny;
    double band = (double)(mode_x + 1) * (double)(2 * mode_y + 1);
    double bytes = sizeof(double) * (points + 2 * band) + transform_bytes(grid, mode_x);
    if (options->amplitudes == AMPLITUDES_RANDOM)
        bytes += sizeof(double) * band;
    if (options->heights.type != HEIGHTS_GAUSSIAN && options->law == LAW_TRANSLATION)
        bytes += TRANSLATION_BYTES;
    if (!surface_is_iterated(options))
        return bytes;
    return bytes + nongaussian_bytes(grid, mode_x, mode_y, options);
}

double generator_sum_bytes(const struct grid *grid, size_t mode_x, size_t mode_y) {
    double band = (double)(mode_x + 1) * (double)(2 * mode_y + 1);
    return sizeof(double) * 2 * band + transform_bytes(grid, mode_x);
}

/* Random words are numbered by wave vectors alone (in units of 2 pi/L). So a wave has the same
 * phase, and the same random factor of its amplitude, on every grid and in every spectrum of the
 * same cell. */
static uint64_t row_first_word(long my) {
    uint64_t zigzag = my >= 0 ? 2 * (uint64_t)my : 2 * (uint64_t)-my - 1;
    return zigzag << 32;
}

/* Returns the row of a wave number my in a column of ny values. */
static size_t column_row(long my, size_t ny) {
    return my >= 0 ? (size_t)my : ny - (size_t)-my;
}

static double uniform(uint64_t word) {
    return (double)(word >> 11) * 0x1p-53;
}

static double complex with_phase(double amplitude, uint64_t word) {
    double phase = 2 * M_PI * uniform(word), sine, cosine;
    sincos(phase, &sine, &cosine);
    return amplitude * cosine + amplitude * sine * I;
}

/* Returns a mode that is its own conjugate, and so real. It has a random sign and the full
 * amplitude, or where amplitudes are random a normal value of that deviation (the real part of a
 * normal complex mode). */
static double own_conjugate_mode(const struct generator *g, double amplitude, uint64_t word) {
    double size =
        g->row_drawn != NULL ? M_SQRT2 * fabs(creal(with_phase(amplitude, word))) : amplitude;
    return word >> 63 != 0 ? -size : size;
}

/* A column that is its own mirror image (mx = 0, and Nyquist of an even nx): the modes of my < 0
 * are conjugates of those drawn at my > 0, and modes at my = 0 and Nyquist are their own. */
static void own_mirror_mode(const struct generator *g, double complex *column, long my,
                            double amplitude, uint64_t word) {
    size_t ny = g->modes->grid.ny;
    if (my == 0 || 2 * (size_t)my == ny) {
        column[column_row(my, ny)] = own_conjugate_mode(g, amplitude, word);
        return;
    }
    double complex mode = with_phase(amplitude, word);
    column[column_row(my, ny)] = mode;
    column[column_row(-my, ny)] = conj(mode);
}

/* Returns the amplitudes of a row of wave numbers. Random ones are drawn from Rayleigh's
 * distribution with the prescribed mean square. */
static const double *row_amplitudes(struct generator *g, struct random_key key, long my) {
    size_t row = (size_t)(my + (long)g->modes->mode_y), length = g->row_length[row];
    const double *amplitude = g->amplitude + row * (g->modes->mode_x + 1);
    if (g->row_drawn == NULL)
        return amplitude;
    random_words(key, STREAM_AMPLITUDES, row_first_word(my), length, g->words);
    for (size_t mx = 0; mx < length; mx++)
        g->row_drawn[mx] = amplitude[mx] > 0 ? -log1p(-uniform(g->words[mx])) : 0;
    for (size_t mx = 0; mx < length; mx++) /* apart from the calls, it is a loop of vectors */
        g->row_drawn[mx] = amplitude[mx] * sqrt(g->row_drawn[mx]);
    return g->row_drawn;
}

/* Draws random phases, with fixed (Wu 2000; F3.1) or random (F3.4) amplitudes. */
static void spectrum_draw(struct generator *g, struct random_key key) {
    const struct modes *modes = g->modes;
    size_t columns = modes->mode_x + 1, ny = modes->grid.ny, nx = modes->grid.nx;
    long mode_y = (long)modes->mode_y;
    double complex *spectrum = transform_spectrum(g->transform);
    memset(spectrum, 0, columns * ny * sizeof *spectrum);
    for (long my = -mode_y; my <= mode_y; my++) {
        size_t length = g->row_length[my + mode_y];
        const double *amplitude = row_amplitudes(g, key, my);
        double complex *at = spectrum + column_row(my, ny);
        random_words(key, STREAM_PHASES, row_first_word(my), length, g->words);
        for (size_t mx = 0; mx < length; mx++) {
            if (amplitude[mx] == 0)
                continue;
            if (mx > 0 && 2 * mx < nx)
                at[mx * ny] = with_phase(amplitude[mx], g->words[mx]);
            else if (my >= 0)
                own_mirror_mode(g, spectrum + mx * ny, my, amplitude[mx], g->words[mx]);
        }
    }
}

/* Computes the powers of a draw; modes without power stay without. */
static void drawn_measure(struct modes *drawn, const struct modes *prescribed,
                          struct transform *transform) {
    size_t rows = 2 * drawn->mode_y + 1, ny = drawn->grid.ny;
    const double complex *spectrum = transform_spectrum(transform);
    for (size_t mx = 0; mx <= drawn->mode_x; mx++)
        for (size_t row = 0; row < rows; row++) {
            double complex mode =
                spectrum[mx * ny + column_row((long)row - (long)drawn->mode_y, ny)];
            bool any = prescribed->power[mx * rows + row] > 0;
            drawn->power[mx * rows + row] =
                any ? creal(mode) * creal(mode) + cimag(mode) * cimag(mode) : 0;
        }
}

void generator_keep_gaussian(struct generator *g, double *gaussian) {
    g->gaussian = gaussian;
}

void generator_aim(struct generator *g, const struct surface_aim *aim) {
    if (g->nongaussian != NULL)
        nongaussian_aim(g->nongaussian, aim);
    if (g->sum != NULL)
        generator_aim(g->sum->counter, aim);
}

void generator_set_stop(struct generator *g, int (*stop)(void *context), void *context) {
    if (g->nongaussian != NULL)
        nongaussian_set_stop(g->nongaussian, stop, context);
    if (g->sum != NULL)
        generator_set_stop(g->sum->counter, stop, context);
}

/* Computes heights from the spectrum, those of a translated surface strip by strip in cache. */
static void heights_fill(struct generator *g, double *z) {
    const struct grid *grid = &g->modes->grid;
    if (g->modes->translation == NULL) {
        transform_inverse(g->transform, z);
        return;
    }
    const struct height_function *function = translation_function(g->modes->translation);
    transform_inverse_columns(g->transform);
    for (size_t j = 0; j < grid->ny; j += TRANSFORM_ROWS) {
        size_t rows = grid->ny - j < TRANSFORM_ROWS ? grid->ny - j : TRANSFORM_ROWS;
        double *strip = z + j * grid->nx;
        transform_inverse_rows(g->transform, j, rows, strip);
        if (g->gaussian != NULL)
            memcpy(g->gaussian + j * grid->nx, strip, rows * grid->nx * sizeof *strip);
        height_function_apply(function, g->modes->height, rows * grid->nx, strip);
    }
}

static int face_run(struct generator *g, struct random_key key, double *z,
                    struct surface_report *report, struct error *err) {
    spectrum_draw(g, key);
    if (g->drawn != NULL)
        drawn_measure(g->drawn, g->modes, g->transform);
    heights_fill(g, z);
    if (g->nongaussian != NULL)
        return nongaussian_run(g->nongaussian, g->transform, key, z, report, err);
    if (report != NULL)
        *report = (struct surface_report){.end = END_DIRECT};
    return 0;
}

/* Makes a stratified face: adds the plateau's heights to those of the valleys in z. */
static int stratified_run(struct sum_of_faces *sum, size_t points, struct random_key key, double *z,
                          struct error *err) {
    const double offset = sum->heights.offset, mean = sum->heights.mean;
    key.sequence ^= UINT64_C(1) << PLATEAU_BIT;
    int status = face_run(sum->counter, key, sum->z, NULL, err);
    for (size_t i = 0; i < points && status == 0; i++)
        z[i] = fmin(z[i], sum->z[i] + offset) - mean;
    return status;
}

/* Returns the report of both faces: iterations of both, and of the rest the larger of each. */
static struct surface_report report_of_both(const struct surface_report *a,
                                            const struct surface_report *b) {
    return (struct surface_report){.iterations = a->iterations + b->iterations,
                                   .end = a->end > b->end ? a->end : b->end,
                                   .eps_h = fmax(a->eps_h, b->eps_h),
                                   .eps_s = fmax(a->eps_s, b->eps_s),
                                   .eps_s0 = fmax(a->eps_s0, b->eps_s0),
                                   .eps_s_amplitude = fmax(a->eps_s_amplitude, b->eps_s_amplitude),
                                   .eps_s0_amplitude =
                                       fmax(a->eps_s0_amplitude, b->eps_s0_amplitude)};
}

int generator_run(struct generator *g, struct random_key key, double *z,
                  struct surface_report *report, struct error *err) {
    struct sum_of_faces *sum = g->sum;
    struct surface_report own = {0}, counter;
    if (sum == NULL) {
        int status = face_run(g, key, z, report, err);
        if (status == 0)
            grooves_add(&g->grooves, &g->modes->grid, key, g->rms_height, z);
        return status;
    }
    int status = face_run(g, key, z, &own, err);
    if (sum->transform == NULL) {
        if (report != NULL)
            *report = own;
        return status == 0 ? stratified_run(sum, grid_points(&g->modes->grid), key, z, err)
                           : status;
    }
    key.sequence ^= UINT64_C(1) << COUNTER_BIT;
    if (status == 0)
        status = face_run(sum->counter, key, sum->z, &counter, err);
    if (status != 0)
        return status;
    for (size_t i = 0; i < grid_points(&g->modes->grid); i++)
        z[i] += sum->z[i];
    transform_forward(sum->transform, z);
    drawn_measure(sum->drawn, sum->modes, sum->transform);
    if (report != NULL)
        *report = report_of_both(&own, &counter);
    return 0;
}

int surface_resample(const struct grid *from, const double *z, const struct grid *to, double *out,
                     size_t mode_x, size_t mode_y, struct error *err) {
    struct transform *coarse = NULL, *fine = NULL;
    int status = transform_create(&coarse, from, mode_x, mode_y, err);
    if (status == 0)
        status = transform_create(&fine, to, mode_x, mode_y, err);
    if (status == 0) {
        transform_forward(coarse, z);
        transform_pad(coarse, fine);
        transform_inverse(fine, out);
    }
    transform_destroy(&coarse);
    transform_destroy(&fine);
    return status;
}

const struct surface_options SURFACE_DEFAULTS = {
    .heights = {.type = HEIGHTS_GAUSSIAN},
    .amplitudes = AMPLITUDES_FIXED,
    .keep = KEEP_SPECTRUM,
    .iteration = ITERATION_REFLECTIONS,
    .draw = DRAW_RANDOM,
    .tolerance = 1e-3,
    .stall_gain = 0.05,
    .stall_iterations = 10,
    .max_iterations = 1000,
    .relaxed_iterations = 40,
    .relaxation = 0.8,
};

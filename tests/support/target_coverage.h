/* Studies that ask for an error, and references to hold them against: plain sampling of long cells
 * by a half-space, which holds as well for exact layers on infinitely high blocks; times the share
 * that fine meshes have over its mesh, on shorter cells; and for the model full less the share that
 * pairs of both models on fine meshes differ by in the limit of these. Areas of some Weibull
 * profiles still change by 1 % from cells of 128 to 512 longest waves: on such cells fine meshes,
 * and means of full, would take hours. Statistical errors of references are independent of those of
 * the studies. */
#ifndef RUGO_TESTS_SUPPORT_TARGET_COVERAGE_H
#define RUGO_TESTS_SUPPORT_TARGET_COVERAGE_H

#include "tests/support/process.h"
#include <math.h>
#include <sqlite3.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { COVERAGE_LOADS = 4, COVERAGE_POINTS = 20 };

/* What is pressed, and how far. */
struct coverage_scene {
    const char *heights; /* members of /surface/heights */
    int dimension;       /* 1: profiles */
    double hurst, wavelength_ratio;
    const char *loads; /* a list in JSON; at most COVERAGE_LOADS */
};

/* What is asked of it. quantity: NULL for the contact area. */
struct coverage_question {
    const struct coverage_scene *scene;
    const char *model, *quantity;
    double error;
};

/* How much a reference takes: of the half-space on long cells, and on the levels of shorter ones,
 * the coarsest of which is that of the long ones; and of it and full. */
struct coverage_effort {
    int realisations, fine, pairs;
    double length_ratio, fine_ratio, pair_ratio; /* longest waves in their cells */
    const char *coarsest, *levels, *pair_levels; /* lists in JSON */
};

/* A curve, by load, or a density at one load, by bin. */
struct coverage_points {
    int count;
    double x[COVERAGE_POINTS], y[COVERAGE_POINTS], standard_error[COVERAGE_POINTS];
    double bound[COVERAGE_POINTS];            /* root of the sum of squares of all bounds */
    double reached, work, plain_work, length; /* of a study that asks; else NaN */
    double cpu_seconds;
};

enum { COVERAGE_TEXT = 1024, COVERAGE_SEED = 1000, COVERAGE_SECONDS = 3600 };
static const double COVERAGE_QUANTILE = 1.96; /* of 95 % */

/* --- results --- */

static inline double coverage_number(sqlite3 *db, const char *sql) {
    sqlite3_stmt *row = NULL;
    double out = NAN;
    if (sqlite3_prepare_v2(db, sql, -1, &row, NULL) == SQLITE_OK &&
        sqlite3_step(row) == SQLITE_ROW && sqlite3_column_type(row, 0) != SQLITE_NULL)
        out = sqlite3_column_double(row, 0);
    sqlite3_finalize(row);
    return out;
}

/* Which curve: of a model, on its finest level. */
struct coverage_choice {
    const char *quantity, *model, *series;
};

static inline sqlite3_stmt *coverage_select_curve(sqlite3 *db, const char *columns,
                                                  const struct coverage_choice *choice) {
    char sql[COVERAGE_TEXT];
    sqlite3_stmt *rows = NULL;
    snprintf(sql, sizeof sql,
             "SELECT %s FROM curve_points p WHERE quantity = ?1 AND model = ?2 AND series = ?3 AND "
             "level IS (SELECT max(level) FROM curve_points) ORDER BY x",
             columns);
    if (sqlite3_prepare_v2(db, sql, -1, &rows, NULL) != SQLITE_OK)
        return NULL;
    sqlite3_bind_text(rows, 1, choice->quantity, -1, SQLITE_STATIC);
    sqlite3_bind_text(rows, 2, choice->model, -1, SQLITE_STATIC);
    sqlite3_bind_text(rows, 3, choice->series, -1, SQLITE_STATIC);
    return rows;
}

#define COVERAGE_ERRORS                                                                            \
    " FROM curve_errors e WHERE e.quantity = p.quantity AND e.model = p.model AND e.series = "     \
    "p.series AND e.level IS p.level AND e.x = p.x"

/* With the bounds of each point. The error of the model is left out where it has a sign: that is
 * the reference's own pairs. */
static inline bool coverage_read_curve(sqlite3 *db, const struct coverage_choice *choice,
                                       struct coverage_points *out) {
    sqlite3_stmt *rows = coverage_select_curve(
        db,
        "y - coalesce((SELECT value" COVERAGE_ERRORS
        " AND e.source = 'discretisation'), 0), standard_error, (SELECT sum(bound * "
        "bound)" COVERAGE_ERRORS " AND (source <> 'model' OR value = 0)), x",
        choice);
    for (out->count = 0; out->count < COVERAGE_POINTS && sqlite3_step(rows) == SQLITE_ROW;
         out->count++) {
        out->y[out->count] = sqlite3_column_double(rows, 0);
        out->standard_error[out->count] = sqlite3_column_double(rows, 1);
        out->bound[out->count] = sqrt(sqlite3_column_double(rows, 2));
        out->x[out->count] = sqlite3_column_double(rows, 3);
    }
    sqlite3_finalize(rows);
    return out->count > 0;
}

/* The limit of the levels over the coarsest of them. The error of the mesh includes the statistical
 * error of a change, times a third or more. */
static inline bool coverage_read_refinement(sqlite3 *db, const struct coverage_choice *choice,
                                            struct coverage_points *out) {
    sqlite3_stmt *rows = coverage_select_curve(
        db,
        "y - coalesce((SELECT value" COVERAGE_ERRORS
        " AND e.source = 'discretisation'), 0), (SELECT e.standard_error" COVERAGE_ERRORS
        " AND e.source = 'discretisation'), (SELECT e.bound" COVERAGE_ERRORS
        " AND e.source = 'discretisation'), (SELECT c.y FROM curve_points c WHERE c.quantity = "
        "p.quantity AND c.model = p.model AND c.series = p.series AND c.x = p.x ORDER BY c.level "
        "LIMIT 1)",
        choice);
    for (out->count = 0; out->count < COVERAGE_POINTS && sqlite3_step(rows) == SQLITE_ROW;
         out->count++) {
        double coarsest = sqlite3_column_double(rows, 3);
        out->y[out->count] = sqlite3_column_double(rows, 0) / coarsest;
        out->standard_error[out->count] = 3 * sqlite3_column_double(rows, 1) / coarsest;
        out->bound[out->count] = sqlite3_column_double(rows, 2) / coarsest;
    }
    sqlite3_finalize(rows);
    return out->count > 0;
}

/* The error of the model as a share of the value on the same cells. */
static inline bool coverage_read_difference(sqlite3 *db, const struct coverage_choice *choice,
                                            struct coverage_points *out) {
    sqlite3_stmt *rows = coverage_select_curve(
        db,
        "y, (SELECT value" COVERAGE_ERRORS
        " AND e.source = 'model'), (SELECT e.standard_error" COVERAGE_ERRORS
        " AND e.source = 'model'), (SELECT e.bound" COVERAGE_ERRORS " AND e.source = 'model')",
        choice);
    bool known = true;
    for (out->count = 0; out->count < COVERAGE_POINTS && sqlite3_step(rows) == SQLITE_ROW;
         out->count++) {
        double y = sqlite3_column_double(rows, 0);
        known = known && sqlite3_column_type(rows, 1) != SQLITE_NULL;
        out->y[out->count] = sqlite3_column_double(rows, 1) / y;
        out->standard_error[out->count] = sqlite3_column_double(rows, 2) / y;
        out->bound[out->count] = sqlite3_column_double(rows, 3) / y;
    }
    sqlite3_finalize(rows);
    return known && out->count > 0;
}

/* --- studies --- */

typedef bool coverage_reading(sqlite3 *db, const struct coverage_choice *choice,
                              struct coverage_points *out);

static inline bool coverage_run_and_read(const char *text, const struct coverage_choice *choice,
                                         coverage_reading *read, struct coverage_points *out) {
    static const char *const FILES[] = {"coverage.db", "coverage.db-wal", "coverage.db-shm"};
    struct process process;
    sqlite3 *db = NULL;
    *out = (struct coverage_points){0};
    for (size_t a = 0; a < sizeof FILES / sizeof *FILES; a++)
        unlink(FILES[a]);
    spit("coverage.json", text);
    process_start(&process, "coverage",
                  (const char *[]){"run", "--db", "coverage.db", "coverage.json", NULL});
    if (process_wait(&process, COVERAGE_SECONDS) != 0)
        return false;
    bool done = sqlite3_open("coverage.db", &db) == SQLITE_OK && read(db, choice, out);
    out->reached =
        coverage_number(db, "SELECT value FROM case_scalars WHERE scalar = 'error_reached'");
    out->work = coverage_number(db, "SELECT value FROM case_scalars WHERE scalar = 'work'");
    out->plain_work =
        coverage_number(db, "SELECT value FROM case_scalars WHERE scalar = 'plain_work'");
    out->length =
        coverage_number(db, "SELECT value FROM case_scalars WHERE scalar = 'length_ratio'");
    out->cpu_seconds = coverage_number(db, "SELECT sum(cpu_seconds) FROM study_progress");
    sqlite3_close(db);
    return done;
}

/* Runs a study and reads a curve of a model on its finest level, less the error of the mesh that
 * levels give with a sign. False where anything fails. */
static inline bool coverage_run(const char *text, const char *quantity, const char *model,
                                const char *series, struct coverage_points *out) {
    return coverage_run_and_read(text, &(struct coverage_choice){quantity, model, series},
                                 coverage_read_curve, out);
}

/* how, surface and contact: members that come first in the document, and last in its tables. */
static inline void coverage_write_study(const struct coverage_scene *scene, int seed,
                                        const char *how, const char *surface, const char *contact,
                                        char text[COVERAGE_TEXT]) {
    snprintf(text, COVERAGE_TEXT,
             "{\"name\":\"coverage\",\"kind\":\"contact\",\"seed\":%d,%s,\"surface\":{"
             "\"dimension\":%d,\"hurst\":%g,\"wavelength_ratio\":%g,\"rms_slope\":0.1,"
             "\"heights\":{%s}%s},\"contact\":{\"pressures\":{\"values\":%s},%s}}",
             seed, how, scene->dimension, scene->hurst, scene->wavelength_ratio, scene->heights,
             surface, scene->loads, contact);
}

static inline const char *coverage_quantity_of(const struct coverage_question *question) {
    return question->quantity != NULL ? question->quantity : "contact_area";
}

/* The study that asks. */
static inline bool coverage_ask(const struct coverage_question *question, int seed,
                                struct coverage_points *out) {
    char how[COVERAGE_TEXT / 4], contact[COVERAGE_TEXT / 4], text[COVERAGE_TEXT];
    const char *quantity = coverage_quantity_of(question);
    snprintf(how, sizeof how, "\"target\":{\"error\":%g,\"quantity\":\"%s\"}", question->error,
             quantity);
    snprintf(contact, sizeof contact, "\"model\":\"%s\"", question->model);
    coverage_write_study(question->scene, seed, how, "", contact, text);
    return coverage_run(text, quantity, question->model, question->quantity != NULL ? "" : "edges",
                        out);
}

/* Of both models, on the same surfaces and on blocks of 1.5 sides. */
static inline bool coverage_run_pairs(const struct coverage_question *question,
                                      const struct coverage_effort *effort,
                                      const struct coverage_choice *choice,
                                      struct coverage_points *out) {
    char how[COVERAGE_TEXT / 4], surface[COVERAGE_TEXT / 4], contact[COVERAGE_TEXT / 4],
        text[COVERAGE_TEXT];
    snprintf(how, sizeof how, "\"realisations\":%d", effort->pairs);
    snprintf(surface, sizeof surface, ",\"length_ratio\":%g", effort->pair_ratio);
    snprintf(contact, sizeof contact,
             "\"model\":[\"halfspace\",\"full\"],\"levels\":%s,\"tolerance\":1e-6,\"stiffness\":"
             "\"omitted\",\"cell_error\":\"none\",\"block_height\":{\"lengths\":1.5}",
             effort->pair_levels);
    coverage_write_study(question->scene, COVERAGE_SEED + 1, how, surface, contact, text);
    return coverage_run_and_read(text, choice, coverage_read_difference, out);
}

/* Of a half-space. */
static inline bool coverage_run_plain(const struct coverage_question *question, int number,
                                      int realisations, double length_ratio, const char *levels,
                                      const struct coverage_choice *choice, coverage_reading *read,
                                      struct coverage_points *out) {
    char how[COVERAGE_TEXT / 4], surface[COVERAGE_TEXT / 4], contact[COVERAGE_TEXT / 4];
    char text[COVERAGE_TEXT];
    snprintf(how, sizeof how, "\"realisations\":%d", realisations);
    snprintf(surface, sizeof surface, ",\"length_ratio\":%g", length_ratio);
    snprintf(contact, sizeof contact,
             "\"model\":\"halfspace\",\"levels\":%s,\"tolerance\":1e-6,\"stiffness\":"
             "\"omitted\",\"cell_error\":\"none\"",
             levels);
    coverage_write_study(question->scene, COVERAGE_SEED + number, how, surface, contact, text);
    return coverage_run_and_read(text, choice, read, out);
}

/* Multiplies by 1 + share, or by share. */
static inline void coverage_multiply(struct coverage_points *out,
                                     const struct coverage_points *share, double one) {
    for (int k = 0; k < out->count; k++) {
        out->standard_error[k] =
            hypot(out->standard_error[k], out->y[k] * share->standard_error[k]);
        out->bound[k] = hypot(out->bound[k], out->y[k] * share->bound[k]);
        out->y[k] *= one + share->y[k];
    }
    out->cpu_seconds += share->cpu_seconds;
}

static inline bool coverage_reference(const struct coverage_question *question,
                                      const struct coverage_effort *effort,
                                      struct coverage_points *out) {
    bool full = strcmp(question->model, "full") == 0;
    const char *area = full ? "edges_stretched" : "edges";
    const struct coverage_choice choice = {coverage_quantity_of(question), "halfspace",
                                           question->quantity != NULL ? "" : area};
    struct coverage_points share;
    if (!coverage_run_plain(question, 0, effort->realisations, effort->length_ratio,
                            effort->coarsest, &choice, coverage_read_curve, out) ||
        !coverage_run_plain(question, 2, effort->fine, effort->fine_ratio, effort->levels, &choice,
                            coverage_read_refinement, &share) ||
        share.count != out->count)
        return false;
    coverage_multiply(out, &share, 0);
    if (!full)
        return true;
    if (!coverage_run_pairs(question, effort, &choice, &share) || share.count != out->count)
        return false;
    for (int k = 0; k < share.count; k++)
        share.y[k] = -share.y[k];
    coverage_multiply(out, &share, 1);
    return true;
}

/* The error that the curve reports of a point: bounds, and the statistical error at 95 %. */
static inline double coverage_told(const struct coverage_points *points, int load) {
    return hypot(points->bound[load], COVERAGE_QUANTILE * points->standard_error[load]);
}

#endif

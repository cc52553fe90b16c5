/* Studies that ask for an error against plain sampling on long cells and fine meshes: how many
 * points are within the error asked for. */
#ifndef RUGO_TESTS_SUPPORT_TARGET_COVERAGE_H
#define RUGO_TESTS_SUPPORT_TARGET_COVERAGE_H

#include "tests/support/process.h"
#include <math.h>
#include <sqlite3.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { COVERAGE_LOADS = 2 };

/* What is asked, and of what. */
struct coverage_question {
    const char *heights; /* members of /surface/heights */
    const char *model;
    double hurst, error;
    int seed;
};

struct coverage_points {
    double y[COVERAGE_LOADS], error[COVERAGE_LOADS]; /* error: the standard one */
    double reached, work, plain_work;                /* of a target; else NaN */
};

static inline double coverage_number(sqlite3 *db, const char *sql) {
    sqlite3_stmt *row = NULL;
    double number = NAN;
    if (sqlite3_prepare_v2(db, sql, -1, &row, NULL) == SQLITE_OK &&
        sqlite3_step(row) == SQLITE_ROW && sqlite3_column_type(row, 0) != SQLITE_NULL)
        number = sqlite3_column_double(row, 0);
    sqlite3_finalize(row);
    return number;
}

/* Runs a study, and reads the area by edges of its last model on its finest level, less what the
 * levels tell of the mesh. False where anything fails. */
static inline int coverage_run(const char *text, struct coverage_points *out) {
    sqlite3 *db = NULL;
    char sql[512];
    *out = (struct coverage_points){.reached = NAN};
    unlink("coverage.db");
    spit("coverage.json", text);
    if (run_rugo("coverage",
                 (const char *[]){"run", "--db", "coverage.db", "coverage.json", NULL}) != 0 ||
        sqlite3_open("coverage.db", &db) != SQLITE_OK)
        return 0;
    for (int k = 0; k < COVERAGE_LOADS; k++) {
        snprintf(sql, sizeof sql,
                 "SELECT p.y - coalesce((SELECT value FROM curve_errors e WHERE e.source = "
                 "'discretisation' AND e.quantity = p.quantity AND e.series = p.series AND e.level "
                 "IS p.level AND e.x = p.x), 0) FROM curve_points p WHERE quantity = "
                 "'contact_area' AND series = 'edges' ORDER BY level DESC, x LIMIT 1 OFFSET %d",
                 k);
        out->y[k] = coverage_number(db, sql);
        snprintf(sql, sizeof sql,
                 "SELECT standard_error FROM curve_points WHERE quantity = 'contact_area' AND "
                 "series = 'edges' ORDER BY level DESC, x LIMIT 1 OFFSET %d",
                 k);
        out->error[k] = coverage_number(db, sql);
    }
    out->reached =
        coverage_number(db, "SELECT value FROM case_scalars WHERE name = 'error_reached'");
    out->work = coverage_number(db, "SELECT value FROM case_scalars WHERE name = 'work'");
    out->plain_work =
        coverage_number(db, "SELECT value FROM case_scalars WHERE name = 'plain_work'");
    sqlite3_close(db);
    return 1;
}

/* realisations: of the reference; 0: the study that asks. */
static inline int coverage_ask(const struct coverage_question *question, int realisations,
                               struct coverage_points *out) {
    char how[160], text[1024];
    if (realisations > 0)
        snprintf(how, sizeof how, "\"realisations\":%d", realisations);
    else
        snprintf(how, sizeof how, "\"target\":{\"error\":%g}", question->error);
    snprintf(text, sizeof text,
             "{\"name\":\"coverage\",\"kind\":\"contact\",\"seed\":%d,%s,\"surface\":{"
             "\"dimension\":1,\"hurst\":%g,\"wavelength_ratio\":2,\"rms_slope\":0.1,\"heights\":{%s"
             "}%s},\"contact\":{\"model\":\"%s\",\"pressures\":{\"to\":0.2,\"steps\":2}%s}}",
             realisations > 0 ? 1000 + question->seed : question->seed, how, question->hurst,
             question->heights, realisations > 0 ? ",\"length_ratio\":128" : "",
             realisations > 0 ? "halfspace" : question->model,
             realisations > 0 ? ",\"levels\":[8,16,32],\"tolerance\":1e-6" : "");
    return coverage_run(text, out);
}

#endif

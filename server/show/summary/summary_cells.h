/* Cells that the tables of summary.h share. */
#ifndef RUGO_SERVER_SHOW_SUMMARY_SUMMARY_CELLS_H
#define RUGO_SERVER_SHOW_SUMMARY_SUMMARY_CELLS_H

#include "schema/result/total.h"
#include "schema/result/work_time.h"
#include "server/show/table/shown_cases.h"
#include "server/show/table/text_table.h"

/* These add a heading for each swept parameter, and the values of case c. */
void varied_headings(struct text_table *table, const struct shown_cases *shown);
void varied_cells(struct text_table *table, const struct shown_cases *shown, size_t c);
/* Writes "0.25772 +- 0.00022" with as many digits as the error has sense for. */
void measured_text(double value, double error, char *out, size_t size);
void measured_cell(struct text_table *table, double value, double error);
/* Writes " (2 of 3)" where a mean is not over all realisations; "" otherwise. */
const char *partial_text(double realisations, double valueless, char *out, size_t size);
/* Adds a share of one in percent, with two digits; "-" for NaN. */
void percent_cell(struct text_table *table, double share);
/* Adds half the width of a total interval in percent of its value; ">3.4" where it leaves a source
 * out. */
void total_cell(struct text_table *table, double value, const struct total *total);
/* The same of a size that is at hand: half a width over the value. */
void total_share_cell(struct text_table *table, double share, bool partial);
/* The line below a table with columns "total %". */
void print_total_legend(FILE *file);
/* Returns what `words` calls a source of error; its own name where that is NULL. */
const char *source_word(const char *const *words, size_t source);
/* Errors below this share of a value have no column of their own. */
#define ERROR_SHOWN 1e-4
/* The same of the solver, which studies let follow their other errors. */
#define SOLVER_SHOWN 5e-3
/* Writes a number of realisations, with two digits of a part. */
void realisations_text(double realisations, char *out, size_t size);
/* Returns the one of a source. */
double error_shown(size_t source);
/* "Errors not known: cell." and "Errors below 0.01 %: block." in lines of their own; nothing where
 * there are none. */
void print_unknown(const bool unknown[UNKNOWN_SOURCES], const char *const *words, FILE *file);
/* What is printed beside each other, by name, and the sources that are not known of each. */
struct unknown_of {
    const char *name;
    bool unknown[UNKNOWN_SOURCES];
};
/* "Errors not known: cell, mesh of full.": names follow where not all of them lack the source. */
void print_unknown_of(size_t count, const struct unknown_of *list, const char *const *words,
                      FILE *file);
void print_small(const bool small[ERROR_SOURCES], const char *const *words, FILE *file);
/* The line below a table with columns "law %". */
void print_law_legend(FILE *file);
/* The line on errors by the patch, where a case has them. */
void print_patch_legend(const struct shown_cases *shown, FILE *file);
/* Lines on surfaces that do not reach the heights or the spectrum that were asked for: where eps_h
 * or eps_s of a case is above HEIGHTS_OFF. */
void print_heights(const struct shown_cases *shown, FILE *file);
#define HEIGHTS_OFF 0.02
/* "layered", or "full (hencky)" where the model has several kinematics; "-" without one. */
const char *model_text(const char *model, const char *kinematics, char *out, size_t size);
/* Returns whether a series is a bracket of another one, and no estimate: nodes_lower, nodes_upper.
 */
bool is_bracket(const char *series);
/* Writes "2 h 5 min", "12 s", or "-" for NaN. */
void duration_text(double seconds, char *out, size_t size);
void duration_cell(struct text_table *table, double seconds);
/* "15 s of CPU time in 2 min 21 s", or what is known of it. */
void work_time_text(const struct work_time *time, char *out, size_t size);
/* A line where the clock stands for the processor time of some jobs. */
void print_without_cpu(const struct work_time *time, FILE *file);
/* Prints a line where errors of cases go together; random is as in study_result. */
void print_random(const char *random, size_t cases, FILE *file);
/* The report of a case, or NULL where the report, which may be NULL, has none. */
const struct case_report *report_of(const struct study_report *report,
                                    const struct case_result *one);

#endif

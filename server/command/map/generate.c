/* rugo generate STUDY.json: surfaces of a study, or a block meshed on one and pressed, to look at
 * or to use elsewhere. */
#include "core/file/file.h"
#include "core/map/height_map_file.h"
#include "jobs/kind.h"
#include "jobs/surface/realisation_map.h"
#include "jobs/surface/surface_case.h"
#include "server/command/command.h"
#include "server/command/map/generate_steps.h"
#include "server/command/map/mesh_file.h"
#include "server/command/output_file.h"
#include "server/show/map/map_report.h"
#include "server/show/plot/plot_map.h"
#include <stdlib.h>
#include <string.h>

struct generate_options {
    const char *output;     /* NULL: standard output */
    const char **overrides; /* of --set */
    int64_t case_number;
    const char *realisations; /* "3" or "0..19" */
    const char *format;
    const char *picture; /* NULL: none */
    struct step_words steps;
    double trace; /* y of the row that the picture has below; 0: none */
};
#define AT(member) offsetof(struct generate_options, member)
static const struct option_row OPTIONS[] = {
    {"case", 0, OPTION_INDEX, 0, 0, AT(case_number), "K", "0", "of this case"},
    {"realisation", 0, OPTION_TEXT, 0, 0, AT(realisations), "R|FIRST..LAST", "0",
     "this realisation, or all from one to another, each into a file of its own in -o DIR/"},
    {"format", 0, OPTION_TEXT, 0, 0, AT(format), "npy|csv|xyz", NULL,
     "of the height map (that of the file's name, or npy)"},
    {"output", 'o', OPTION_TEXT, 0, 0, AT(output), "FILE|DIR/", NULL,
     "write the height map there; into a folder as realisation-R.npy"},
    {"picture", 0, OPTION_TEXT, 0, 0, AT(picture), "FILE.svg|FILE.png", NULL,
     "draw the surface there: its summits marked, or a pixel a point"},
    {"trace", 0, OPTION_NUMBER, 0, 0, AT(trace), "Y", NULL,
     "with the row at y/lambda_s drawn below the picture; Ly for that at y = 0"},
    STEP_OPTION_ROWS(struct generate_options, steps),
    {"set", 0, OPTION_LIST, 0, 0, AT(overrides), "PATH=VALUE", NULL, SET_HELP},
    {0}};

/* The options ask for this. */
struct generate_order {
    const struct generate_options *options;
    const char *study, *output; /* output NULL: standard output */
    uint64_t first, last;       /* realisations */
    enum height_map_format format;
};

static bool is_folder(const char *path) {
    return path != NULL && path[0] != '\0' && path[strlen(path) - 1] == '/';
}

/* A mesh or a picture takes the place of a surface on standard output. */
static bool writes_surface(const struct generate_order *order) {
    return (!step_words_ask(&order->options->steps) && order->options->picture == NULL) ||
           order->output != NULL;
}

/* A name without an ending is npy; a folder has none. */
static bool has_ending(const char *path) {
    const char *slash = strrchr(path, '/');
    return strchr(slash != NULL ? slash + 1 : path, '.') != NULL;
}

/* Chooses the format asked for, or that of the output's name, or npy; returns 0 or EXIT_USAGE. */
static int choose_format(struct generate_order *order) {
    const char *name = order->options->format;
    order->format = HEIGHT_MAP_FORMATS;
    if (name != NULL) {
        for (order->format = HEIGHT_MAP_NPY; order->format < HEIGHT_MAP_FORMATS &&
                                             strcmp(name, HEIGHT_MAP_NAMES[order->format]) != 0;)
            order->format++;
        if (order->format == HEIGHT_MAP_FORMATS)
            return usage_error("generate", "--format %.40s is not npy, csv or xyz", name);
    } else if (order->output != NULL)
        order->format = height_map_format_of(order->output);
    if (name != NULL && !writes_surface(order))
        return usage_error("generate",
                           "--format %.40s is of the height map, which is written to "
                           "-o FILE beside a picture or a mesh",
                           name);
    if (order->format == HEIGHT_MAP_FORMATS && order->output != NULL && has_ending(order->output))
        return usage_error(
            "generate",
            "-o %.200s: allowed are files that end in .npy, .csv or .xyz, or --format; "
            "--picture FILE.svg or FILE.png draws the surface",
            order->output);
    if (order->format == HEIGHT_MAP_FORMATS)
        order->format = HEIGHT_MAP_NPY;
    if (writes_surface(order) && order->output == NULL && order->format == HEIGHT_MAP_NPY &&
        isatty(STDOUT_FILENO) != 0)
        return usage_error("generate", "npy is not for a terminal: give -o FILE or --format");
    return 0;
}

/* Reads a whole number from 0 of up to 15 digits; *text goes behind it. */
static bool read_index(const char **text, uint64_t *out) {
    size_t digits = strspn(*text, "0123456789");
    if (digits == 0 || digits > 15)
        return false;
    *out = strtoull(*text, NULL, 10);
    *text += digits;
    return true;
}

static int read_realisations(struct generate_order *order) {
    const char *given = order->options->realisations, *at = given;
    bool good = read_index(&at, &order->first);
    order->last = order->first;
    if (good && strncmp(at, "..", 2) == 0) {
        at += 2;
        good = read_index(&at, &order->last) && order->last >= order->first;
    }
    if (!good || *at != '\0')
        return usage_error("generate",
                           "--realisation %.40s: neither a whole number from 0 nor a range such "
                           "as 0..19",
                           given);
    if (order->first == order->last)
        return 0;
    if (!is_folder(order->output))
        return usage_error("generate", "several realisations need a folder: -o DIR/");
    if (step_words_ask(&order->options->steps) || order->options->picture != NULL)
        return usage_error("generate",
                           "--picture, --mesh, --steps and --nodes are of one realisation");
    return 0;
}

static int read_order(struct generate_order *order, const struct generate_options *options,
                      const char *study) {
    *order = (struct generate_order){.options = options, .study = study, .output = options->output};
    if (order->output != NULL && strcmp(order->output, "-") == 0)
        order->output = NULL;
    if (options->trace > 0 && (options->picture == NULL || output_file_is_png(options->picture)))
        return usage_error("generate", "--trace belongs to --picture FILE.svg");
    int status = step_words_check(&options->steps);
    if (status == 0)
        status = read_realisations(order);
    return status == 0 ? choose_format(order) : status;
}

static int write_output(const struct generate_order *order, uint64_t realisation,
                        const struct grid *grid, const double *z, struct error *err) {
    if (order->output == NULL)
        return height_map_write(stdout, order->format, grid, z, err);
    if (!is_folder(order->output))
        return height_map_save(order->output, order->format, grid, z, err);
    size_t size = strlen(order->output) + 64; /* "realisation-", 15 digits, and an ending */
    char *path = array_create(size, 1);
    if (path == NULL)
        return error_memory(err, size, "a path");
    snprintf(path, size, "%srealisation-%llu.%s", order->output, (unsigned long long)realisation,
             HEIGHT_MAP_NAMES[order->format]);
    int status = height_map_save(path, order->format, grid, z, err);
    free(path);
    return status;
}

static int write_picture(const struct generate_order *order, const struct study *study,
                         const struct grid *grid, const double *z, struct error *err) {
    char subject[80];
    snprintf(subject, sizeof subject, "case %lld, realisation %llu",
             (long long)order->options->case_number, (unsigned long long)order->first);
    const struct map_picture picture = {.name = study->name,
                                        .subject = subject,
                                        .x_label = "x/lambda_s",
                                        .y_label = "y/lambda_s",
                                        .z_label = "height z",
                                        .grid = grid,
                                        .z = z,
                                        .trace = order->options->trace};
    return output_file_picture(order->options->picture, &picture, err);
}

static const char *end_name(enum surface_end end) {
    static const char *const names[] = {"direct", "converged", "stalled", "schedule"};
    return names[end];
}

/* Beside the surface on standard output, the characterisation goes to standard error. */
static int characterise(const struct generate_order *order, const struct surface_case *surface,
                        const struct surface_report *report, const double *z, struct error *err) {
    bool beside = writes_surface(order) && order->output == NULL;
    FILE *file = beside ? stderr : stdout;
    const struct surface_band band = surface_case_own_band(surface);
    const struct measured_map map = {&surface->grid, z, BOUNDARY_PERIODIC};
    struct map_parameters parameters;
    struct named_values values = {0};
    int status = map_parameters_measure(&parameters, &map, band.x, band.y, NULL, MAP_WHOLE, err);
    if (status != 0)
        return status;
    map_report_parameters(&values, &parameters);
    named_values_print(file, &values);
    if (report->end != END_DIRECT)
        fprintf(file,
                "generation\n  %-18s %zu\n  %-18s %s\n  %-18s %.4g\n  %-18s %.4g\n  %-18s %.4g\n",
                "iterations", report->iterations, "end", end_name(report->end), "eps_h",
                report->eps_h, "eps_s", report->eps_s, "eps_s0", report->eps_s0);
    if (fflush(file) != 0 || ferror(file) != 0)
        return error_set(err, ERROR_SYSTEM, "cannot write the characterisation");
    return 0;
}

/* Makes one realisation, and writes what is asked of it. */
static int generate_one(const struct generate_order *order, const struct study *study,
                        const struct surface_case *surface, uint64_t realisation,
                        struct error *err) {
    struct surface_report report = {0};
    const size_t case_number = (size_t)order->options->case_number;
    const struct random_key key = {study->seed, study_sequence(study->random, case_number),
                                   realisation};
    double *z = NULL;
    int status = realisation_surface(surface, key, &z, &report, err);
    if (status == 0 && step_words_ask(&order->options->steps))
        status = generate_steps(&order->options->steps, study, case_number, key, z, err);
    if (status == 0 && order->options->picture != NULL)
        status = write_picture(order, study, &surface->grid, z, err);
    if (status == 0 && writes_surface(order))
        status = write_output(order, realisation, &surface->grid, z, err);
    if (status == 0 && order->first < order->last)
        printf("realisation %llu\n", (unsigned long long)realisation);
    if (status == 0)
        status = characterise(order, surface, &report, z, err);
    free(z);
    return status;
}

static int make_output(const struct generate_order *order, struct error *err) {
    return is_folder(order->output) ? folder_make(order->output, err) : 0;
}

static int generate(const struct generate_order *order, const struct study *study,
                    struct error *err) {
    struct surface_case surface;
    const uint64_t case_number = (uint64_t)order->options->case_number;
    if (case_number >= study->case_count)
        return error_set(err, ERROR_INPUT, "there is no case %lld: the study has %zu",
                         (long long)order->options->case_number, study->case_count);
    int status = surface_case_read(&surface, study->cases[case_number].parameters, NULL, err);
    if (status != 0)
        return status;
    status = make_output(order, err);
    for (uint64_t r = order->first; r <= order->last && status == 0; r++)
        status = generate_one(order, study, &surface, r, err);
    surface_case_clear(&surface);
    return status;
}

/* A name that says another kind of file than it would hold is refused before anything is made. */
static int check_files(const struct generate_options *options, struct error *err) {
    int status = mesh_file_check(options->steps.mesh, options->steps.nodes, err);
    return status == 0 && options->picture != NULL ? output_file_check_drawn(options->picture, err)
                                                   : status;
}

static int run(const void *values, const char *const *arguments) {
    struct generate_order order;
    struct fault_list faults = {0};
    struct study *study = NULL;
    struct error err = {0};
    const struct generate_options *options = values;
    if (read_order(&order, options, arguments[0]) != 0)
        return EXIT_USAGE;
    int status = check_files(options, &err);
    if (status == 0)
        status = study_file_read(&study, order.study, options->overrides, &faults, &err);
    if (status == 0)
        status = generate(&order, study, &err);
    int result = command_end("generate", status, order.study, &faults, &err);
    study_destroy(&study);
    fault_list_clear(&faults);
    return result;
}

const struct command COMMAND_GENERATE = {
    .name = "generate",
    .arguments = "STUDY.json",
    .summary = "one surface of a study, and its characterisation",
    .least = 1,
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct generate_options),
    .run = run,
};

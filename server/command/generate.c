/* rugo generate STUDY.json: one surface of a study, or a block meshed on it, to look at or to use
 * elsewhere. */
#include "core/map/height_map.h"
#include "jobs/surface_case.h"
#include "server/command/command.h"
#include "server/command/meshed_case.h"
#include "server/command/options.h"
#include "server/show/characterisation.h"
#include "worker/kinds.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char NAME[] = "generate";

struct options {
    const char *study, *output; /* output NULL: standard output */
    const char **overrides;     /* owned, NULL-terminated; its strings are of argv */
    int64_t case_number, realisation;
    enum height_map_format format;
    const char *mesh; /* NULL: the surface alone */
    double pressure;  /* p/(E* h') on the mesh; 0: not pressed */
};

/* A mesh takes the place of a surface on standard output. */
static bool writes_surface(const struct options *options) {
    return options->mesh == NULL || options->output != NULL;
}

static bool read_pressure(struct options *options, const char *text) {
    if (text == NULL)
        return true;
    char *stop;
    options->pressure = strtod(text, &stop);
    if (options->mesh == NULL)
        return usage_error(NAME, "--pressure belongs to --mesh FILE");
    if (stop == text || *stop != '\0' || !(options->pressure > 0 && isfinite(options->pressure)))
        return usage_error(NAME, "--pressure %.40s is no number above 0", text);
    return true;
}

/* The format asked for, or that of the output's name, or npy. */
static bool choose_format(struct options *options, const char *name) {
    if (options->output != NULL && strcmp(options->output, "-") == 0)
        options->output = NULL;
    options->format = HEIGHT_MAP_FORMATS;
    if (name != NULL) {
        for (options->format = HEIGHT_MAP_NPY;
             options->format < HEIGHT_MAP_FORMATS &&
             strcmp(name, HEIGHT_MAP_NAMES[options->format]) != 0;)
            options->format++;
        if (options->format == HEIGHT_MAP_FORMATS)
            return usage_error(NAME, "--format %.40s is not npy, csv or xyz", name);
    } else if (options->output != NULL)
        options->format = height_map_format_of(options->output);
    if (options->format == HEIGHT_MAP_FORMATS)
        options->format = HEIGHT_MAP_NPY;
    if (!writes_surface(options))
        return true;
    if (options->output == NULL && options->format == HEIGHT_MAP_NPY && isatty(STDOUT_FILENO))
        return usage_error(NAME, "npy is not for a terminal: give -o FILE or --format");
    return true;
}

static bool read_options(int argc, char **argv, struct options *out) {
    const char *format = NULL, *pressure = NULL;
    const struct option_row rows[] = {{"case", OPTION_INDEX, &out->case_number},
                                      {"realisation", OPTION_INDEX, &out->realisation},
                                      {"format", OPTION_TEXT, &format},
                                      {"o", OPTION_TEXT, &out->output},
                                      {"output", OPTION_TEXT, &out->output},
                                      {"mesh", OPTION_TEXT, &out->mesh},
                                      {"pressure", OPTION_TEXT, &pressure},
                                      {"set", OPTION_LIST, out->overrides},
                                      {NULL, OPTION_FLAG, NULL}};
    return options_parse(argc, argv, rows, 1, 1, &out->study) && read_pressure(out, pressure) &&
           choose_format(out, format);
}

static int write_output(const struct options *options, const struct grid *grid, const double *z,
                        struct error *err) {
    if (options->output == NULL)
        return height_map_write(stdout, options->format, grid, z, err);
    FILE *file = fopen(options->output, "wb");
    if (file == NULL)
        return error_set(err, ERROR_SYSTEM, "cannot open %s: %s", options->output, strerror(errno));
    int status = height_map_write(file, options->format, grid, z, err);
    if (fclose(file) != 0 && status == 0)
        status =
            error_set(err, ERROR_SYSTEM, "cannot write %s: %s", options->output, strerror(errno));
    return status;
}

static const char *end_name(enum surface_end end) {
    static const char *const names[] = {"direct", "converged", "stalled", "schedule"};
    return names[end];
}

/* Beside the surface on standard output, the characterisation goes to standard error. */
static int characterise(const struct options *options, const struct surface_case *surface,
                        const struct surface_report *report, const double *z, struct error *err) {
    bool beside = writes_surface(options) && options->output == NULL;
    FILE *file = beside ? stderr : stdout;
    size_t mode_x = surface_case_band(surface);
    size_t mode_y = surface->dimension == 1 ? 0 : mode_x;
    if (!surface_case_exact(surface)) {
        mode_x = surface->grid.nx / 2;
        mode_y = surface->grid.ny / 2;
    }
    struct characterisation values;
    int status = characterise_heights(&values, &surface->grid, z, mode_x, mode_y, err);
    if (status != 0)
        return status;
    characterisation_print(file, &values);
    if (report->end != END_DIRECT)
        fprintf(file,
                "generation\n  %-18s %zu\n  %-18s %s\n  %-18s %.4g\n  %-18s %.4g\n  %-18s %.4g\n",
                "iterations", report->iterations, "end", end_name(report->end), "eps_h",
                report->eps_h, "eps_s", report->eps_s, "eps_s0", report->eps_s0);
    if (fflush(file) != 0 || ferror(file))
        return error_set(err, ERROR_SYSTEM, "cannot write the characterisation");
    return 0;
}

static int write_mesh(const struct options *options, const struct study *study, const double *z,
                      struct error *err) {
    if (strcmp(study->kind->name, "contact") != 0)
        return error_set(err, ERROR_INPUT, "--mesh needs a study of kind contact, and this is %s",
                         study->kind->name);
    return meshed_case_write(options->mesh, study->cases[options->case_number].parameters, z,
                             options->pressure, err);
}

static int generate(const struct options *options, const struct study *study, struct error *err) {
    struct surface_case surface;
    struct surface_report report = {0};
    struct generator *generator = NULL;
    const struct random_key key = {study->seed, (uint64_t)options->case_number,
                                   (uint64_t)options->realisation};
    if (key.case_number >= study->case_count)
        return error_set(err, ERROR_INPUT, "there is no case %lld: the study has %zu",
                         (long long)options->case_number, study->case_count);
    int status = surface_case_read(&surface, study->cases[key.case_number].parameters, NULL, err);
    if (status != 0)
        return status;
    double *z = array_create(grid_points(&surface.grid), sizeof *z);
    if (z == NULL)
        status = error_memory(err, grid_points(&surface.grid) * sizeof *z, "a surface");
    if (status == 0)
        status =
            generator_create(&generator, &surface.spectrum, &surface.grid, &surface.options, err);
    if (status == 0)
        status = generator_run(generator, key, z, &report, err);
    generator_destroy(&generator);
    if (status == 0 && options->mesh != NULL)
        status = write_mesh(options, study, z, err);
    if (status == 0 && writes_surface(options))
        status = write_output(options, &surface.grid, z, err);
    if (status == 0)
        status = characterise(options, &surface, &report, z, err);
    free(z);
    surface_case_clear(&surface);
    return status;
}

int command_generate(int argc, char **argv) {
    struct options options = {.overrides = array_create((size_t)argc + 1, sizeof(char *))};
    struct fault_list faults = {0};
    struct study *study = NULL;
    struct error err = {0};
    int status = 0, ended = EXIT_DONE;
    if (options.overrides == NULL)
        status = error_memory(&err, ((size_t)argc + 1) * sizeof(char *), "options");
    else if (!read_options(argc, argv, &options)) {
        free(options.overrides);
        return EXIT_USAGE;
    }
    if (status == 0)
        status = study_file_read(&study, options.study, options.overrides, &faults, &err);
    if (status == 0)
        status = generate(&options, study, &err);
    if (status != 0)
        ended = faults.count > 0 ? command_fail_faults(options.study, &faults)
                                 : command_fail(NAME, &err);
    free(options.overrides);
    study_destroy(&study);
    fault_list_clear(&faults);
    return ended;
}

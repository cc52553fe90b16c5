/* Growth of computations: CPU time and memory over the number of points, with exponents fitted to
 * both, beside limits of the same run. The limit of time is the number of transforms of a task
 * times one transform of FFTW of this size, or the bytes that it must read at the speed of a copy
 * of as many. That of memory is what the task cannot do without. A measurement has a process of its
 * own, whose peak of resident memory counts; a smaller task runs there before, so that code and
 * libraries are in memory. Tables are those of the page jobs/studies/GROWTH.md. RUGO_SIDE=n: the
 * most points a side of surfaces, 2048 by default. */
#include "core/contact/area.h"
#include "core/full/full.h"
#include "core/map/height_map_file.h"
#include "core/statistics/surface_pass.h"
#include "core/surface/surface.h"
#include "tests/support/growth.h"
#include "tests/support/timing.h"
#include <fftw3.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { REPEATS = 9, BINS = 240, TASKS_MOST = 8, COUNT_OF_POINTS = 1 << 18 };
static const double LOAD = 0.1;           /* p/(E* h') */
static const double REPEATED_MS = 500;    /* what takes longer runs once */
static const double PLANNING_SECONDS = 3; /* of FFTW, most */

/* Squares of `side` by `side` points, or profiles: `waves` longest waves, `points` a shortest. */
struct size {
    int dimension;
    size_t side;
    double points, waves;
};

/* What a task works on; all is owned. */
struct scene {
    struct size size;
    struct grid grid;
    double slope, *z;
    struct generator *generator;
    struct summit_finder *finder;
    struct summit_list summits, pits;
    struct compliance *compliance;
    struct contact *contact;
    struct area_workspace *areas;
    struct full *full;
    /* of the last run: iterations, transforms, and arrays read, each of so many doubles */
    double steps, transforms, readings, doubles;
};

struct measure {
    double ms, bytes, steps;
    double count; /* of transforms or readings */
    double limit_ms, limit_bytes;
};

struct task {
    const char *name;
    int (*prepare)(struct scene *scene, struct error *err); /* heights, too; not timed */
    int (*run)(struct scene *scene, struct error *err);     /* NULL: `rugo press` in its stead */
    const char *limit;    /* such as "transforms"; how many stands before it */
    double bytes_a_point; /* the limit of memory; 0: the doubles of a reading */
    size_t warm;          /* side of what runs before */
    size_t side_most;     /* larger ones take too long; 0: none does */
};

/* --- tasks --- */

static struct grid grid_of(const struct size *size) {
    double cell = (double)size->side / size->points;
    return (struct grid){size->side, size->dimension == 2 ? size->side : 1, cell, cell};
}

static int generator_make(struct scene *scene, enum heights_type heights, struct error *err) {
    double cell = scene->grid.lx;
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = 0.8,
                                      .wavelength_long = cell / scene->size.waves,
                                      .wavelength_rolloff = cell / scene->size.waves,
                                      .wavelength_short = 1,
                                      .scale = SCALE_RMS_SLOPE,
                                      .scale_value = 0.1};
    struct surface_options options = SURFACE_DEFAULTS;
    options.heights = (struct heights){.type = heights, .shape = 1};
    scene->slope = spectrum.scale_value;
    scene->z = array_create(grid_points(&scene->grid), sizeof *scene->z);
    if (scene->z == NULL)
        return error_memory(err, grid_points(&scene->grid) * sizeof *scene->z, "heights");
    return generator_create(&scene->generator, &spectrum, &scene->grid, &options, err);
}

/* From now on the peak of memory is that of what follows, where the system can forget another. */
static void forget_peak(void) {
    FILE *file = fopen("/proc/self/clear_refs", "w");
    if (file != NULL) {
        fputs("5", file);
        fclose(file);
    }
}

/* Makes Gaussian heights and leaves nothing else. */
static int heights_make(struct scene *scene, struct error *err) {
    int status = generator_make(scene, HEIGHTS_GAUSSIAN, err);
    if (status == 0)
        status = generator_run(scene->generator, (struct random_key){1, 0, 0}, scene->z, NULL, err);
    generator_destroy(&scene->generator);
    forget_peak();
    return status;
}

static int prepare_gaussian(struct scene *scene, struct error *err) {
    return generator_make(scene, HEIGHTS_GAUSSIAN, err);
}

static int prepare_weibull(struct scene *scene, struct error *err) {
    return generator_make(scene, HEIGHTS_WEIBULL_MIN, err);
}

static int generate(struct scene *scene, struct error *err) {
    struct surface_report report = {0};
    int status =
        generator_run(scene->generator, (struct random_key){1, 0, 0}, scene->z, &report, err);
    scene->steps = (double)report.iterations;
    scene->transforms = 1 + 2 * scene->steps; /* each iteration there and back */
    return status;
}

static int prepare_statistics(struct scene *scene, struct error *err) {
    int status = heights_make(scene, err);
    if (status == 0)
        status = summit_finder_create(&scene->finder, &scene->grid, SUMMITS_NINE_POINT,
                                      CURVATURE_FINITE_DIFFERENCE, scene->grid.nx / 2,
                                      scene->grid.ny / 2, err);
    return status;
}

/* Histogram, powers of heights, summits and pits. */
static int run_statistics(struct scene *scene, struct error *err) {
    const struct bins bins = {-4, 8, BINS};
    uint64_t counts[BINS + 2] = {0};
    struct height_sums sums;
    const struct surface_pass pass = {.finder = scene->finder,
                                      .bins = &bins,
                                      .scale = 1,
                                      .counts = counts,
                                      .sums = &sums,
                                      .summits = &scene->summits,
                                      .pits = &scene->pits};
    scene->readings = 1;
    scene->doubles = (double)grid_points(&scene->grid);
    return surface_pass_run(&pass, &scene->grid, scene->z, err);
}

static struct block block_of(const struct scene *scene, enum block_model model) {
    return (struct block){.model = model,
                          .poisson = 0.3,
                          .height = model == MODEL_LAYERED ? 1.5 * scene->grid.lx : INFINITY,
                          .layer_growth = 1.1,
                          .weighting = GAP_STANDARD};
}

static int prepare_contact(struct scene *scene, enum block_model model, bool open,
                           struct error *err) {
    const struct block block = block_of(scene, model);
    int status = heights_make(scene, err);
    if (status == 0)
        status = open ? compliance_create_open(&scene->compliance, &scene->grid, &block, err)
                      : compliance_create(&scene->compliance, &scene->grid, &block, err);
    if (status == 0)
        status = area_workspace_create(&scene->areas, scene->compliance, err);
    if (status == 0)
        status = contact_create(&scene->contact, scene->compliance, &CONTACT_DEFAULTS, err);
    return status;
}

static int prepare_halfspace(struct scene *scene, struct error *err) {
    return prepare_contact(scene, MODEL_HALFSPACE, false, err);
}

static int prepare_open(struct scene *scene, struct error *err) {
    return prepare_contact(scene, MODEL_HALFSPACE, true, err);
}

static int prepare_layered(struct scene *scene, struct error *err) {
    return prepare_contact(scene, MODEL_LAYERED, false, err);
}

static int run_contact(struct scene *scene, struct error *err) {
    struct contact_state state = {0};
    struct contact_area area;
    int status = contact_begin(scene->contact, scene->z, err);
    if (status == 0)
        status = contact_press(scene->contact, LOAD * scene->slope, &state, err);
    if (status == 0)
        contact_area(scene->areas, &state, &area);
    scene->steps = (double)state.iterations;
    scene->transforms = state.work / (double)grid_points(&scene->grid);
    return status;
}

/* The surface of height h with the greatest slope 0.1, h cos(x) cos(y). */
static int double_sine_make(struct scene *scene, struct error *err) {
    static const double TURN = 2 * 3.14159265358979323846;
    size_t nx = scene->grid.nx;
    scene->slope = 0.1;
    scene->z = array_create(nx * nx, sizeof *scene->z);
    if (scene->z == NULL)
        return error_memory(err, nx * nx * sizeof *scene->z, "heights");
    for (size_t n = 0; n < nx * nx; n++) {
        size_t i = n % nx, j = n / nx;
        scene->z[n] = scene->slope * scene->grid.lx / TURN * cos(TURN * (double)i / (double)nx) *
                      cos(TURN * (double)j / (double)nx);
    }
    return 0;
}

/* Profiles are rough, surfaces a double sine. */
static int prepare_full(struct scene *scene, struct error *err) {
    const struct block block = block_of(scene, MODEL_LAYERED);
    int status =
        scene->size.dimension == 1 ? heights_make(scene, err) : double_sine_make(scene, err);
    if (status == 0)
        status = full_create(&scene->full, &scene->grid, &block, &FULL_DEFAULTS, err);
    return status;
}

/* Each iteration of Newton's method writes the tangent, each of the linear equations reads it. */
static int run_full(struct scene *scene, struct error *err) {
    struct contact_state state = {0};
    struct full_report report = {0};
    int status = full_begin(scene->full, scene->z, err);
    if (status == 0)
        status = full_press(scene->full, LOAD * scene->slope, &state, &report, err);
    scene->steps = (double)report.newton;
    scene->readings = (double)(report.newton + report.linear);
    scene->doubles = tangent_bytes(full_mesh(scene->full), false) / sizeof(double);
    return status;
}

static void scene_clear(struct scene *scene) {
    full_destroy(&scene->full);
    area_workspace_destroy(&scene->areas);
    contact_destroy(&scene->contact);
    compliance_destroy(&scene->compliance);
    summit_finder_destroy(&scene->finder);
    summit_list_clear(&scene->summits);
    summit_list_clear(&scene->pits);
    generator_destroy(&scene->generator);
    free(scene->z);
    *scene = (struct scene){0};
}

/* --- limits --- */

/* Half of the time of a transform there and back, FFTW's best; 0 where memory is short. */
static double transform_ms(const struct grid *grid) {
    size_t points = grid_points(grid), repeats = 1 + COUNT_OF_POINTS / points;
    int ny = (int)grid->ny, nx = (int)grid->nx;
    double *z = fftw_alloc_real(points), times[REPEATS] = {0};
    fftw_complex *wave = fftw_alloc_complex(grid->ny * (grid->nx / 2 + 1));
    if (z != NULL && wave != NULL) {
        fftw_set_timelimit(PLANNING_SECONDS);
        fftw_plan there = ny == 1 ? fftw_plan_dft_r2c_1d(nx, z, wave, FFTW_MEASURE)
                                  : fftw_plan_dft_r2c_2d(ny, nx, z, wave, FFTW_MEASURE);
        fftw_plan back = ny == 1 ? fftw_plan_dft_c2r_1d(nx, wave, z, FFTW_MEASURE)
                                 : fftw_plan_dft_c2r_2d(ny, nx, wave, z, FFTW_MEASURE);
        memset(z, 0, points * sizeof *z);
        for (size_t r = 0; r < REPEATS; r++) {
            double start = cpu_ms();
            for (size_t n = 0; n < repeats; n++) {
                fftw_execute(there);
                fftw_execute(back);
            }
            times[r] = (cpu_ms() - start) / (2 * (double)repeats);
        }
        fftw_destroy_plan(there);
        fftw_destroy_plan(back);
    }
    fftw_free(z);
    fftw_free(wave);
    return median(times, REPEATS);
}

/* The time to read so many doubles: half of that to copy them; 0 where memory is short. */
static double reading_ms(double doubles) {
    size_t count = (size_t)doubles, repeats = 1 + COUNT_OF_POINTS / count;
    double *from = array_create(count, sizeof *from), *to = array_create(count, sizeof *to);
    double times[REPEATS] = {0};
    volatile double seen = 0;
    for (size_t r = 0; from != NULL && to != NULL && r < REPEATS; r++) {
        double start = cpu_ms();
        for (size_t n = 0; n < repeats; n++) {
            from[n % count] = (double)n;
            memcpy(to, from, count * sizeof *to);
            seen = to[n % count];
        }
        times[r] = (cpu_ms() - start) / (2 * (double)repeats);
    }
    (void)seen;
    free(from);
    free(to);
    return median(times, REPEATS);
}

/* --- a measurement, in a process of its own --- */

struct job {
    const struct task *task;
    struct size size;
};

/* The small size that runs before, of 4 points a shortest wave. */
static struct size warm_size(const struct job *job) {
    return (struct size){job->size.dimension, job->task->warm, 4, job->size.waves};
}

/* Returns VmRSS or VmHWM of this process in bytes; NAN where the system does not say. */
static double resident(const char *which) {
    char line[128];
    double kilobytes = NAN;
    FILE *file = fopen("/proc/self/status", "r");
    while (file != NULL && fgets(line, sizeof line, file) != NULL)
        if (strncmp(line, which, strlen(which)) == 0)
            kilobytes = strtod(line + strlen(which) + 1, NULL);
    if (file != NULL)
        fclose(file);
    return 1024 * kilobytes;
}

static int scene_run(struct scene *scene, const struct task *task, const struct size *size,
                     struct error *err) {
    *scene = (struct scene){.size = *size, .grid = grid_of(size)};
    int status = task->prepare(scene, err);
    return status != 0 ? status : task->run(scene, err);
}

/* The median of repeats, where they are short. The first one touches all memory. */
static int time_runs(const struct task *task, struct scene *scene, double *ms, struct error *err) {
    double times[REPEATS + 1] = {0};
    size_t count = 0;
    int status = 0;
    do {
        double start = cpu_ms();
        status = task->run(scene, err);
        times[count++] = cpu_ms() - start;
    } while (status == 0 && count <= REPEATS && times[0] <= REPEATED_MS);
    *ms = count == 1 ? times[0] : median(times + 1, count - 1);
    return status;
}

static int measure_task(const struct job *job, struct measure *out, struct error *err) {
    const struct task *task = job->task;
    const struct size warm = warm_size(job);
    struct scene scene;
    int status = scene_run(&scene, task, &warm, err);
    scene_clear(&scene);
    double before = resident("VmRSS");
    scene = (struct scene){.size = job->size, .grid = grid_of(&job->size)};
    if (status == 0)
        status = task->prepare(&scene, err);
    if (status == 0)
        status = time_runs(task, &scene, &out->ms, err);
    out->bytes = resident("VmHWM") - before;
    out->steps = scene.steps;
    double points = (double)grid_points(&scene.grid), doubles = scene.doubles;
    out->limit_bytes =
        task->bytes_a_point > 0 ? task->bytes_a_point * points : doubles * sizeof(double);
    out->count = scene.readings > 0 ? scene.readings : scene.transforms;
    double readings = scene.readings;
    struct grid grid = scene.grid;
    scene_clear(&scene);
    if (status == 0)
        out->limit_ms = out->count * (readings > 0 ? reading_ms(doubles) : transform_ms(&grid));
    return status;
}

static int write_map(const struct job *job, struct measure *out, struct error *err) {
    struct scene scene = {.size = job->size, .grid = grid_of(&job->size)};
    (void)out;
    int status = heights_make(&scene, err);
    FILE *file = status == 0 ? fopen("map.npy", "w") : NULL;
    if (status == 0)
        status = file != NULL ? height_map_write(file, HEIGHT_MAP_NPY, &scene.grid, scene.z, err)
                              : error_set(err, ERROR_SYSTEM, "map.npy cannot be written");
    if (file != NULL)
        fclose(file);
    scene_clear(&scene);
    return status;
}

static int run_apart(int (*work)(const struct job *, struct measure *, struct error *),
                     const struct job *job, struct measure *out, struct error *err) {
    struct {
        struct measure measure;
        struct error err;
        int status;
    } *shared =
        mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED)
        return error_memory(err, sizeof *shared, "a measurement");
    shared->measure = *out;
    shared->status = error_set(&shared->err, ERROR_SYSTEM, "the process of its own was killed");
    fflush(NULL);
    pid_t child = fork();
    if (child == 0) {
        shared->status = work(job, &shared->measure, &shared->err);
        _exit(0);
    }
    if (child > 0)
        waitpid(child, NULL, 0);
    *out = shared->measure;
    int status = shared->status;
    if (status != 0)
        error_set(err, status, "%zu points a side: %s", job->size.side, shared->err.text);
    munmap(shared, sizeof *shared);
    return status;
}

/* --- the command --- */

static int number_after(const char *text, const char *name, double *out, struct error *err) {
    const char *at = strstr(text, name);
    if (at == NULL)
        return error_set(err, ERROR_INPUT, "`rugo press` prints no %s", name);
    *out = strtod(at + strlen(name), NULL);
    return 0;
}

/* The CPU time and the peak that `rugo press` prints. */
static int press_map(const struct job *job, double *ms, double *bytes, struct error *err) {
    static const char COMMAND[] =
        "\"${RUGO:-build/rugo}\" press map.npy --boundary open --loads 0.1 --format json";
    struct measure none = {0};
    char text[1 << 16];
    int status = run_apart(write_map, job, &none, err);
    FILE *pipe = status == 0 ? popen(COMMAND, "r") : NULL;
    if (status == 0 && pipe == NULL)
        status = error_set(err, ERROR_SYSTEM, "no shell runs %s", COMMAND);
    if (status != 0)
        return status;
    text[fread(text, 1, sizeof text - 1, pipe)] = '\0';
    if (pclose(pipe) != 0)
        status = error_set(err, ERROR_SYSTEM, "%s failed", COMMAND);
    if (status == 0)
        status = number_after(text, "\"cpu_seconds\":", ms, err);
    if (status == 0)
        status = number_after(text, "\"peak_bytes\":", bytes, err);
    *ms *= 1e3;
    return status;
}

/* Its transforms, iterations and their limit are those of the same map and load: in *out. */
static int measure_press(const struct job *job, struct measure *out, struct error *err) {
    const struct job warm = {job->task, warm_size(job)};
    double warm_ms = 0, warm_bytes = 0;
    int status = press_map(&warm, &warm_ms, &warm_bytes, err);
    if (status == 0)
        status = press_map(job, &out->ms, &out->bytes, err);
    out->bytes -= warm_bytes;
    return status;
}

/* --- tables --- */

struct group {
    const char *name; /* of what and its unit */
    const struct task *tasks;
    size_t count, sizes;
    struct size size[TASKS_MOST][GROWTH_SIZES_MOST];
    struct measure found[TASKS_MOST][GROWTH_SIZES_MOST];
};

static int group_measure(struct group *group, struct error *err) {
    int status = 0;
    for (size_t t = 0; t < group->count; t++)
        for (size_t s = 0; status == 0 && s < group->sizes; s++) {
            const struct job job = {&group->tasks[t], group->size[t][s]};
            struct measure *out = &group->found[t][s];
            if (job.task->side_most > 0 && job.size.side > job.task->side_most)
                continue;
            if (job.task->run == NULL) { /* after the same by the library */
                *out = group->found[t - 1][s];
                status = measure_press(&job, out, err);
            } else
                status = run_apart(measure_task, &job, out, err);
        }
    return status;
}

/* Returns the number of sizes that were measured, which are the first. */
static size_t measured(const struct group *group, size_t t) {
    size_t count = group->sizes;
    while (count > 1 && !(group->found[t][count - 1].ms > 0))
        count--;
    return count;
}

static void print_time(const struct group *group, size_t t, const double *points) {
    const struct task *task = &group->tasks[t];
    const size_t count = measured(group, t);
    const struct measure *found = group->found[t], *last = &found[count - 1];
    double ms[GROWTH_SIZES_MOST];
    char text[GROWTH_TEXT_SIZE];
    for (size_t s = 0; s < group->sizes; s++)
        ms[s] = found[s].ms;
    growth_print_row(task->name, points, ms, group->sizes);
    printf(" %.0f %s, %s |", last->count, task->limit, growth_text(text, last->limit_ms));
    for (size_t s = 0; s < count; s++)
        printf("%s%.*f", s > 0 ? "; " : " ", found[s].ms < 10 * found[s].limit_ms,
               found[s].ms / found[s].limit_ms);
    printf(" |");
    for (size_t s = 0; last->steps > 0 && s < count; s++)
        printf("%s%.0f", s > 0 ? "; " : " ", found[s].steps);
    printf(" |\n");
}

static void print_memory(const struct group *group, size_t t, const double *points) {
    const struct task *task = &group->tasks[t];
    const size_t count = measured(group, t);
    const struct measure *found = group->found[t], *last = &found[count - 1];
    double megabytes[GROWTH_SIZES_MOST];
    char text[GROWTH_TEXT_SIZE];
    for (size_t s = 0; s < group->sizes; s++)
        megabytes[s] = 1e-6 * found[s].bytes;
    growth_print_row(task->name, points, megabytes, group->sizes);
    if (task->bytes_a_point > 0)
        printf(" %.0f B a point", task->bytes_a_point);
    else
        printf(" the tangent");
    printf(", %s |", growth_text(text, 1e-6 * last->limit_bytes));
    for (size_t s = 0; s < count; s++)
        printf("%s%.1f", s > 0 ? "; " : " ", found[s].bytes / found[s].limit_bytes);
    printf(" |\n");
}

static int bench(struct group *group, struct error *err) {
    double points[GROWTH_SIZES_MOST];
    char heading[64];
    int status = group_measure(group, err);
    if (status != 0)
        return error_context(err, "%s", group->name);
    for (size_t s = 0; s < group->sizes; s++) {
        const struct grid grid = grid_of(&group->size[0][s]);
        points[s] = (double)grid_points(&grid);
    }
    snprintf(heading, sizeof heading, "%s, ms", group->name);
    growth_print_head(heading, points, group->sizes,
                      " limit at the last, ms | times the limit | iterations |");
    for (size_t t = 0; t < group->count; t++)
        print_time(group, t, points);
    snprintf(heading, sizeof heading, "%s, MB", group->name);
    growth_print_head(heading, points, group->sizes, " limit at the last, MB | times the limit |");
    for (size_t t = 0; t < group->count; t++)
        print_memory(group, t, points);
    fflush(stdout);
    return 0;
}

static const struct task SURFACES[] = {
    {"Gaussian heights", prepare_gaussian, generate, "transform", 8, 64, 0},
    {"Weibull heights", prepare_weibull, generate, "transforms", 16, 64, 0},
    {"statistics", prepare_statistics, run_statistics, "reading of heights", 8, 64, 0},
    {"half-space", prepare_halfspace, run_contact, "transforms", 48, 64, 0},
    {"layered", prepare_layered, run_contact, "transforms", 52, 64, 0},
    {"half-space in free space", prepare_open, run_contact, "transforms", 72, 64, 0},
    {"`rugo press`", NULL, NULL, "transforms", 72, 64, 0}};
static const struct task PROFILES[] = {
    {"Gaussian heights", prepare_gaussian, generate, "transform", 8, 256, 0},
    {"Weibull heights", prepare_weibull, generate, "transforms", 16, 256, 0},
    {"statistics", prepare_statistics, run_statistics, "reading of heights", 8, 256, 0},
    {"half-space", prepare_halfspace, run_contact, "transforms", 48, 256, 0},
    {"layered", prepare_layered, run_contact, "transforms", 52, 256, 0},
    {"half-space in free space", prepare_open, run_contact, "transforms", 72, 256, 1 << 18}};
static const struct task FULL[] = {
    {"profiles", prepare_full, run_full, "readings of the tangent", 0, 32, 0},
    {"surfaces", prepare_full, run_full, "readings of the tangent", 0, 4, 0}};
#define COUNT(tasks) (sizeof(tasks) / sizeof *(tasks))

static void group_add(struct group *group, size_t task, struct size size) {
    group->size[task][group->sizes] = size;
}

/* Four times the points from one size to the next. */
static void groups_fill(struct group *surfaces, struct group *profiles, struct group *full,
                        size_t side_most) {
    for (size_t side = 128; side <= side_most && surfaces->sizes < GROWTH_SIZES_MOST; side *= 2) {
        for (size_t t = 0; t < surfaces->count; t++)
            group_add(surfaces, t, (struct size){2, side, 8, 8});
        surfaces->sizes++;
    }
    for (size_t side = 1 << 10; side <= 1 << 20; side *= 4) {
        for (size_t t = 0; t < profiles->count; t++)
            group_add(profiles, t, (struct size){1, side, 8, 8});
        profiles->sizes++;
    }
    for (size_t side = 8; side <= 64; side *= 2) {
        group_add(full, 0, (struct size){1, side * side, 8, 4});
        group_add(full, 1, (struct size){2, side, 8, 4});
        full->sizes++;
    }
}

/* Arguments name the groups to measure; without any it is all of them. */
static bool is_asked(const struct group *group, int argc, char **argv) {
    bool asked = argc == 1;
    for (int a = 1; a < argc; a++)
        asked |= strcmp(argv[a], group->name) == 0;
    return asked;
}

int main(int argc, char **argv) {
    static struct group groups[] = {{.name = "surfaces", .tasks = SURFACES, COUNT(SURFACES)},
                                    {.name = "profiles", .tasks = PROFILES, COUNT(PROFILES)},
                                    {.name = "full", .tasks = FULL, COUNT(FULL)}};
    struct error err = {0};
    const char *text = getenv("RUGO_SIDE");
    size_t most = text != NULL ? strtoul(text, NULL, 10) : 2048;
    int status = 0;
    if (most < 256)
        status = error_set(&err, ERROR_INPUT, "RUGO_SIDE = %s; allowed: 256 or more", text);
    groups_fill(&groups[0], &groups[1], &groups[2], most);
    for (size_t g = 0; g < COUNT(groups) && status == 0; g++)
        if (is_asked(&groups[g], argc, argv))
            status = bench(&groups[g], &err);
    if (status != 0)
        fprintf(stderr, "bench_computation_growth: %s\n", err.text);
    return status != 0;
}

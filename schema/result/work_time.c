#include "schema/result/work_time.h"
#include "schema/json/field.h"
#include <math.h>

static void print_member(FILE *file, const char *key, double number) {
    fprintf(file, "\"%s\":", key);
    json_print_number(file, number);
}

void work_time_print(FILE *file, const struct work_time *time) {
    print_member(file, "seconds", time->seconds);
    fputc(',', file);
    print_member(file, "cpu_seconds", time->cpu_seconds);
    fputc(',', file);
    print_member(file, "jobs_without_cpu", (double)time->jobs_without_cpu);
}

void work_time_read(const cJSON *object, uint64_t jobs, struct work_time *out) {
    double without = field_number(object, "jobs_without_cpu");
    *out = (struct work_time){.seconds = field_number(object, "seconds"),
                              .cpu_seconds = field_number(object, "cpu_seconds")};
    if (without >= 0 && without <= 0x1p53)
        out->jobs_without_cpu = (uint64_t)without;
    if (!isnan(out->cpu_seconds))
        return;
    out->cpu_seconds = out->seconds;
    out->jobs_without_cpu = jobs > 0 ? jobs : 1;
}

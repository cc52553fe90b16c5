/* Two workers against one, processes of one thread over HTTP, on a small study of 960 surfaces:
 * wall time from their start to the end of the study, in turn, medians. */
#include "tests/support/process.h"
#include "tests/support/queue_load.h"
#include <math.h>
#include <signal.h>
#include <unistd.h>

enum { TURNS = 3, WORKERS_MOST = 2 };

static const char STUDY[] =
    "{\"name\":\"workers\",\"kind\":\"statistics\",\"seed\":1,\"realisations\":120,\"surface\":{"
    "\"hurst\":[0.1,0.2,0.3,0.4,0.5,0.6,0.7,0.8],\"wavelength_ratio\":8,\"length_ratio\":8,"
    "\"points_per_wavelength\":8},"
    "\"statistics\":{\"bins\":{\"height\":[-4,5,60],\"curvature\":[-12,0,40]}}}";

/* Seconds of `workers` processes on a study of their own. */
static double time_study(int workers) {
    char database[32], url[64];
    struct process server, worker[WORKERS_MOST];
    snprintf(database, sizeof database, "workers%d.db", workers);
    unlink(database);
    const unsigned port = serve_start(&server, (const char *[]){"--db", database, NULL});
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    if (http_exchange(port, "POST", "/v1/studies", "Content-Type: application/json\r\n", STUDY,
                      NULL) != 201)
        return NAN;
    double start = seconds();
    for (int w = 0; w < workers; w++) {
        char name[16];
        snprintf(name, sizeof name, "work%d", w);
        process_start(&worker[w], name,
                      (const char *[]){"work", "--server", url, "--workers", "1", "--drain", NULL});
    }
    for (int w = 0; w < workers; w++)
        if (process_wait(&worker[w], 60) != 0)
            return NAN;
    double elapsed = seconds() - start;
    process_kill(&server, SIGTERM);
    return elapsed;
}

int main(void) {
    double one[TURNS], two[TURNS];
    for (int t = 0; t < TURNS; t++) {
        one[t] = time_study(1);
        two[t] = time_study(2);
    }
    qsort(one, TURNS, sizeof *one, by_value);
    qsort(two, TURNS, sizeof *two, by_value);
    double a = one[TURNS / 2], b = two[TURNS / 2];
    printf("960 surfaces of 512 x 512 on %ld processors: one worker %.2f s (%.2f to %.2f), two "
           "%.2f s (%.2f to %.2f): %.2f times the throughput\n",
           sysconf(_SC_NPROCESSORS_ONLN), a, one[0], one[TURNS - 1], b, two[0], two[TURNS - 1],
           a / b);
    return a > 0 && b > 0 ? 0 : 1;
}

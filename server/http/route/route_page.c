/* The page, the description and the ready studies, all linked into the executable. */
#include "server/http/route/route.h"
#include <string.h>

/* Files of server/web: the name that a request has, the type, and what its symbols are named by. */
#define ASSETS(ASSET)                                                                              \
    ASSET("index.html", "text/html; charset=utf-8", server_web_index_html)                         \
    ASSET("style.css", "text/css; charset=utf-8", server_web_style_css)                            \
    ASSET("app.js", "text/javascript; charset=utf-8", server_web_app_js)                           \
    ASSET("chart.js", "text/javascript; charset=utf-8", server_web_chart_js)                       \
    ASSET("curves.js", "text/javascript; charset=utf-8", server_web_curves_js)                     \
    ASSET("elements.js", "text/javascript; charset=utf-8", server_web_elements_js)                 \
    ASSET("new.js", "text/javascript; charset=utf-8", server_web_new_js)                           \
    ASSET("picture.js", "text/javascript; charset=utf-8", server_web_picture_js)                   \
    ASSET("jobs.js", "text/javascript; charset=utf-8", server_web_jobs_js)                         \
    ASSET("realisation.js", "text/javascript; charset=utf-8", server_web_realisation_js)           \
    ASSET("session.js", "text/javascript; charset=utf-8", server_web_session_js)                   \
    ASSET("studies.js", "text/javascript; charset=utf-8", server_web_studies_js)                   \
    ASSET("study.js", "text/javascript; charset=utf-8", server_web_study_js)                       \
    ASSET("surface.js", "text/javascript; charset=utf-8", server_web_surface_js)                   \
    ASSET("sweep.js", "text/javascript; charset=utf-8", server_web_sweep_js)                       \
    ASSET("table.js", "text/javascript; charset=utf-8", server_web_table_js)                       \
    ASSET("workers.js", "text/javascript; charset=utf-8", server_web_workers_js)                   \
    ASSET("uplot.js", "text/javascript; charset=utf-8", server_web_vendor_uplot_js)                \
    ASSET("uplot.css", "text/css; charset=utf-8", server_web_vendor_uplot_css)                     \
    ASSET("rugo.py", "text/x-python; charset=utf-8", server_python_rugo_client_py)                 \
    ASSET("openapi.yaml", "application/yaml", server_http_openapi_yaml)                            \
    ASSET("templates.json", "application/json", templates_json)

#define DECLARE(name, type, symbol)                                                                \
    extern const char _binary_##symbol##_start[], _binary_##symbol##_end[];
ASSETS(DECLARE)

static const struct asset {
    const char *name, *type, *start, *end;
} TABLE[] = {
#define ROW(name, type, symbol) {name, type, _binary_##symbol##_start, _binary_##symbol##_end},
    ASSETS(ROW)};

void handle_asset(struct exchange *exchange, const char *id) {
    for (size_t a = 0; a < sizeof TABLE / sizeof *TABLE; a++)
        if (strcmp(TABLE[a].name, id) == 0) {
            answer_static(exchange, TABLE[a].type, TABLE[a].start,
                          (size_t)(TABLE[a].end - TABLE[a].start));
            return;
        }
    answer_problem(exchange, 404, "the page has no such file", NULL);
}

void handle_page(struct exchange *exchange, const char *id) {
    (void)id;
    handle_asset(exchange, "index.html");
}

void handle_openapi(struct exchange *exchange, const char *id) {
    (void)id;
    handle_asset(exchange, "openapi.yaml");
}

void handle_client(struct exchange *exchange, const char *id) {
    (void)id;
    handle_asset(exchange, "rugo.py");
}

void handle_templates(struct exchange *exchange, const char *id) {
    (void)id;
    handle_asset(exchange, "templates.json");
}

/* Handlers of the routes; route.c has the table. id is the segment that stands for * in the
 * pattern; of a study it is the whole id, whatever the path names it by. */
#ifndef RUGO_SERVER_HTTP_ROUTE_ROUTE_H
#define RUGO_SERVER_HTTP_ROUTE_ROUTE_H

#include "server/http/exchange.h"

#define FORM_MEDIA "multipart/form-data" /* of several files */
enum {
    SEGMENT_SIZE = 801, /* a study's name has up to 200 characters, of up to 4 bytes */
    QUERY_NAMES_MOST = 32
};
typedef void route_handler(struct exchange *exchange, const char *id);

struct route {
    const char *method, *pattern; /* * stands for one segment */
    unsigned roles;               /* any of these; ROLE_NONE: open to all */
    route_handler *handler;
    const char *queries[QUERY_NAMES_MOST]; /* below /v1, what a query may hold */
};
/* Returns a row of the table; NULL behind the last. */
const struct route *route_at(size_t at);

route_handler handle_study_create, handle_study_list, handle_study, handle_document,
    handle_study_cancel, handle_study_retry, handle_study_extend, handle_curves, handle_report,
    handle_plot, handle_table, handle_events;
route_handler handle_claim, handle_report_many, handle_heartbeat, handle_complete, handle_fail,
    handle_release;
route_handler handle_health, handle_metrics, handle_snapshot, handle_openapi, handle_schema,
    handle_page, handle_asset, handle_client, handle_templates, handle_contents, handle_map,
    handle_nodes, handle_check, handle_workers, handle_characterise;

/* Checks who asks for what and answers. Called once before the body comes (body_known
 * false): may refuse; and once with it. */
void route_refuse_early(struct exchange *exchange);
void route_answer(struct exchange *exchange);

/* A peer wants to send a file: sets how large it may be, and counts it; false after an answer that
 * there are enough of them, or that none are taken. Who entered leaves. */
bool characterise_enter(struct exchange *exchange);
void characterise_leave(struct exchange *exchange);

/* Returns whether there is a body; false after a 400. */
bool check_body(struct exchange *exchange);
/* Returns the body as JSON; answers 400 itself and returns NULL where it is none. */
cJSON *body_json(struct exchange *exchange);

/* Returns whether the query holds nothing but these names (the rest NULL), each once and with a
 * value; false after a 422. */
bool query_check(struct exchange *exchange, const char *const names[QUERY_NAMES_MOST]);
/* Answers 422 with one fault, that of ?name. */
__attribute__((format(printf, 3, 4))) void query_refuse(struct exchange *exchange, const char *name,
                                                        const char *format, ...);
/* One of `count` words of the query, all of which `words` has with | between: *out is its number,
 * left alone where it is not there. False after a 422. */
bool query_choice(struct exchange *exchange, const char *name, const char *const *choices,
                  int count, const char *words, int *out);
/* A switch of the query, true or left out; false after a 422, which says what it is for. */
bool query_true(struct exchange *exchange, const char *name, const char *purpose);
/* A whole number of the query: left alone where it is not there. False after a 422. */
bool query_number(struct exchange *exchange, const char *name, int64_t least, int64_t most,
                  int64_t *value);

/* Reads ?difference=A,B; the quantity is left alone. Not asked without it; ERROR_INPUT after a 422.
 */
struct comparison;
int query_difference(struct exchange *exchange, struct comparison *out, bool *asked);
/* Answers 422 to a message of a worker that cannot be read, with what is wrong, and the pointer
 * where the error begins with one (field.h). */
void refuse_message(struct exchange *exchange, const struct error *err);
/* Forgets the jobs of a claim whose answer arrived; gives them back where it did not. */
void claim_settle(struct exchange *exchange, bool arrived);

#endif

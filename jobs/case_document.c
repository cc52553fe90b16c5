#include "jobs/case_document.h"
#include "jobs/value.h"

int case_document(uint64_t realisations, cJSON *scalars, cJSON *curves, const struct notes *notes,
                  cJSON **out, struct error *err) {
    cJSON *document = cJSON_CreateObject();
    bool put = value_put(document, "realisations", value_number((double)realisations));
    put = value_put(document, "scalars", scalars) && put; /* each takes its item in any case */
    put = value_put(document, "curves", curves) && put;
    if (put && notes != NULL && notes->count > 0)
        put = value_put(document, "notes", notes_json(notes));
    if (!put) {
        cJSON_Delete(document);
        return error_memory(err, sizeof(cJSON), "curves");
    }
    *out = document;
    return 0;
}

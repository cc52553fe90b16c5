/* Files that a peer sends as a form of the media type multipart/form-data (RFC 7578), as browsers
 * and curl -F do. */
#ifndef RUGO_SERVER_HTTP_ROUTE_SENT_FORM_H
#define RUGO_SERVER_HTTP_ROUTE_SENT_FORM_H

#include "core/statistics/spectra/joint_fit.h"
#include "server/http/exchange.h"

enum { SENT_NAME_MOST = 300 };

/* Initialise with {0}. */
struct sent_form {
    size_t count;
    char *names[JOINT_PATCHES_MOST]; /* owned; no two alike */
    size_t sizes[JOINT_PATCHES_MOST];
};
/* Whether the body is a form, by its media type. */
bool sent_form_is(const struct exchange *exchange);
/* Takes the form in the body apart, by libmicrohttpd. The body is then the bytes of its files, one
 * behind the other, with the field "study" behind them, if it has one. ERROR_INPUT says which part
 * is at fault. The form is to be cleared, then too. */
int sent_form_take(struct sent_form *out, struct exchange *exchange, struct error *err);
void sent_form_clear(struct sent_form *form);

#endif

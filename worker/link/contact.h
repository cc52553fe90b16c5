/* Whether the other side of a client is a server of Rugo at all. Private to worker/link/. */
#ifndef RUGO_WORKER_LINK_CONTACT_H
#define RUGO_WORKER_LINK_CONTACT_H

#include "core/error.h"
#include <curl/curl.h>
#include <stdbool.h>

/* What is known of the server by its answers so far. {0} at first. */
struct contact {
    bool known;  /* it has once answered as Rugo does */
    bool probed; /* whether it speaks the other scheme was asked, which is done once */
    bool marked; /* its answers have VERSION_HEADER, which older programs do not send */
};

/* Judges the answer that `curl` has just got from the server at `url`, which has no slash at its
 * end. Where the answer has no mark, asks, without a token, for what an older server has.
 * ERROR_INPUT at first, where it is no server of Rugo: waiting would not help. ERROR_SYSTEM later,
 * and where a gateway says that its server is away: it may come back. */
int contact_judge(struct contact *contact, CURL *curl, const char *url, struct error *err);

/* Returns what is wrong with a server that has never answered and did not answer in HTTP either,
 * by the code of the failure: a text such as "; it speaks TLS", or "" where it may be away. */
const char *contact_fault(struct contact *contact, CURL *curl, const char *url, CURLcode code);

#endif

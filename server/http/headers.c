#include "server/http/headers.h"
#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include <strings.h>

struct headers {
    unsigned lengths, hosts, encodings, keys;
    bool unknown_encoding;
    const char *fault; /* the first one found; NULL: none */
};

/* Returns whether a name is a token (RFC 9110, 5.6.2): no space before the colon, for one. */
static bool is_token(const char *name) {
    static const char OTHERS[] = "!#$%&'*+-.^_`|~";
    const char *c = name;
    for (; *c != '\0'; c++)
        if (!((*c >= '0' && *c <= '9') || (*c >= 'A' && *c <= 'Z') || (*c >= 'a' && *c <= 'z') ||
              strchr(OTHERS, *c) != NULL))
            return false;
    return c != name;
}

/* Returns whether a value has no control characters but tabs: a bare CR, say, ends a line to some.
 */
static bool is_plain(const char *value) {
    for (const unsigned char *c = (const unsigned char *)value; *c != '\0'; c++)
        if ((*c < ' ' && *c != '\t') || *c == 0x7f)
            return false;
    return true;
}

/* The library leaves a line where it was read, with the value behind the name, a colon and blanks.
 * Where a folded line follows it copies the name elsewhere, and appends that line to it. */
static bool is_folded(const char *name, const char *value) {
    uintptr_t end = (uintptr_t)name + strlen(name) + 1, begin = (uintptr_t)value;
    if (begin < end)
        return true;
    enum { BLANKS_MOST = 1024 };
    return begin - end > BLANKS_MOST;
}

/* value may be NULL. */
static const char *line_fault(const char *name, const char *value) {
    if (!is_token(name))
        return "the name of a header is no token; there is no space before its colon";
    if (value != NULL && !is_plain(value))
        return "a control character in a header, such as a CR without LF";
    if (value != NULL && is_folded(name, value))
        return "a header on more than one line";
    return NULL;
}

static enum MHD_Result see_header(void *context, enum MHD_ValueKind kind, const char *name,
                                  const char *value) {
    struct headers *headers = context;
    (void)kind;
    headers->lengths += strcasecmp(name, "Content-Length") == 0;
    headers->keys += strcasecmp(name, "Idempotency-Key") == 0;
    headers->hosts += strcasecmp(name, "Host") == 0;
    if (strcasecmp(name, "Transfer-Encoding") == 0) {
        headers->encodings++;
        /* The library knows no other. */
        headers->unknown_encoding |= value == NULL || strcasecmp(value, "chunked") != 0;
    }
    if (headers->fault == NULL)
        headers->fault = line_fault(name, value);
    return MHD_YES;
}

const char *headers_fault(struct MHD_Connection *connection) {
    struct headers headers = {0};
    MHD_get_connection_values(connection, MHD_HEADER_KIND, see_header, &headers);
    if (headers.fault != NULL)
        return headers.fault;
    if (headers.lengths > 1)
        return "more than one Content-Length";
    if (headers.lengths != 0 && headers.encodings != 0)
        return "Content-Length beside Transfer-Encoding";
    if (headers.hosts > 1)
        return "more than one Host";
    if (headers.keys > 1)
        return "more than one Idempotency-Key";
    if (headers.encodings > 1 || headers.unknown_encoding)
        return "a Transfer-Encoding other than chunked";
    return NULL;
}

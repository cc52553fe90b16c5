#include "worker/link/contact.h"
#include "worker/link/header_names.h"
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum {
    HEAD_SIZE = 256,
    PAGE_MS = 10000, /* for a page of an older server */
    SCHEME_MS = 2000 /* for any answer: the caller may have to ask its request again */
};

/* The beginning of an answer. */
struct head {
    char text[HEAD_SIZE];
    size_t size;
};

/* Keeps the beginning, as a CURLOPT_WRITEFUNCTION, and ends the exchange behind it. */
static size_t keep_head(char *bytes, size_t unit, size_t count, void *context) {
    struct head *head = context;
    size_t size = unit * count, room = HEAD_SIZE - 1 - head->size;
    size_t kept = size < room ? size : room;
    memcpy(head->text + head->size, bytes, kept);
    head->size += kept;
    head->text[head->size] = '\0';
    return head->size < HEAD_SIZE - 1 ? size : 0;
}

/* Asks for a page without a token, over a connection of its own. Returns the status of HTTP, 0
 * where there is none; verify is false where nothing is believed. */
static long probe(CURL *curl, const char *url, bool verify, struct head *head) {
    long limit_ms = verify ? PAGE_MS : SCHEME_MS;
    CURL *own = curl_easy_duphandle(curl);
    long status = 0;
    *head = (struct head){.size = 0};
    if (own == NULL)
        return 0;
    bool good = curl_easy_setopt(own, CURLOPT_URL, url) == CURLE_OK &&
                curl_easy_setopt(own, CURLOPT_HTTPHEADER, NULL) == CURLE_OK &&
                curl_easy_setopt(own, CURLOPT_ERRORBUFFER, NULL) == CURLE_OK &&
                curl_easy_setopt(own, CURLOPT_NOPROGRESS, 1L) == CURLE_OK &&
                curl_easy_setopt(own, CURLOPT_TIMEOUT_MS, limit_ms) == CURLE_OK &&
                curl_easy_setopt(own, CURLOPT_CUSTOMREQUEST, NULL) == CURLE_OK &&
                curl_easy_setopt(own, CURLOPT_HTTPGET, 1L) == CURLE_OK &&
                curl_easy_setopt(own, CURLOPT_WRITEFUNCTION, keep_head) == CURLE_OK &&
                curl_easy_setopt(own, CURLOPT_WRITEDATA, head) == CURLE_OK &&
                (verify || (curl_easy_setopt(own, CURLOPT_PINNEDPUBLICKEY, NULL) == CURLE_OK &&
                            curl_easy_setopt(own, CURLOPT_SSL_VERIFYPEER, 0L) == CURLE_OK &&
                            curl_easy_setopt(own, CURLOPT_SSL_VERIFYHOST, 0L) == CURLE_OK));
    if (good) {
        (void)curl_easy_perform(own); /* which keep_head may have ended */
        curl_easy_getinfo(own, CURLINFO_RESPONSE_CODE, &status);
    }
    curl_easy_cleanup(own);
    return status;
}

/* A server without the mark is known by its description of the interface. */
static bool is_older(CURL *curl, const char *url) {
    struct head head;
    char page[512];
    int length = snprintf(page, sizeof page, "%s/v1/openapi.yaml", url);
    return length > 0 && (size_t)length < sizeof page && probe(curl, page, true, &head) == 200 &&
           strncmp(head.text, "openapi:", 8) == 0 && strstr(head.text, "title: Rugo") != NULL;
}

static bool has_mark(CURL *curl) {
    struct curl_header *header = NULL;
    return curl_easy_header(curl, VERSION_HEADER, 0, CURLH_HEADER, -1, &header) == CURLHE_OK;
}

int contact_judge(struct contact *contact, CURL *curl, const char *url, struct error *err) {
    long status = 0;
    if (has_mark(curl)) {
        *contact = (struct contact){.known = true, .marked = true};
        return 0;
    }
    if (contact->known && !contact->marked)
        return 0;
    curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &status);
    bool away = contact->known || status == 502 || status == 503 || status == 504;
    if (is_older(curl, url)) {
        *contact = (struct contact){.known = true};
        return 0;
    }
    if (away)
        return error_set(err, ERROR_SYSTEM, "%s: status %ld, and not from rugo serve", url, status);
    return error_set(err, ERROR_INPUT,
                     "%s is no server of Rugo: its answer, of status %ld, is not one of rugo serve",
                     url, status);
}

const char *contact_fault(struct contact *contact, CURL *curl, const char *url, CURLcode code) {
    struct head head;
    char other[512];
    bool tls = strncasecmp(url, "https:", 6) == 0;
    if (contact->known)
        return "";
    if (code == CURLE_UNSUPPORTED_PROTOCOL || code == CURLE_WEIRD_SERVER_REPLY)
        return "; it does not speak HTTP";
    bool unclear = tls ? code == CURLE_SSL_CONNECT_ERROR
                       : code == CURLE_GOT_NOTHING || code == CURLE_RECV_ERROR;
    const char *host = strstr(url, "://");
    if (!unclear || host == NULL || contact->probed)
        return "";
    contact->probed = true;
    snprintf(other, sizeof other, "%s%.480s/healthz", tls ? "http" : "https", host);
    if (probe(curl, other, false, &head) == 0)
        return "";
    return tls ? "; it speaks no TLS: use http://" : "; it speaks TLS: use https://";
}

#include "worker/client_internal.h"
#include <arpa/inet.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

/* By address, or by the one name that stands for it: "127.example.org" is somebody's. */
static bool is_loopback(const char *host) {
    struct in_addr address;
    return strcasecmp(host, "localhost") == 0 || strcmp(host, "[::1]") == 0 ||
           (inet_pton(AF_INET, host, &address) == 1 && ntohl(address.s_addr) >> 24 == 127);
}

int client_url_read(const char *url, struct client_url *out, struct error *err) {
    char *scheme = NULL, *host = NULL, *path = NULL, *user = NULL, *query = NULL;
    CURLU *parts = curl_url();
    if (parts == NULL)
        return error_memory(err, 1, "a URL");
    bool good = curl_url_set(parts, CURLUPART_URL, url, 0) == CURLUE_OK &&
                curl_url_get(parts, CURLUPART_SCHEME, &scheme, 0) == CURLUE_OK &&
                curl_url_get(parts, CURLUPART_HOST, &host, 0) == CURLUE_OK &&
                curl_url_get(parts, CURLUPART_PATH, &path, 0) == CURLUE_OK &&
                curl_url_get(parts, CURLUPART_USER, &user, 0) == CURLUE_NO_USER &&
                curl_url_get(parts, CURLUPART_QUERY, &query, 0) == CURLUE_NO_QUERY &&
                (strcmp(scheme, "http") == 0 || strcmp(scheme, "https") == 0) &&
                strcmp(path, "/") == 0;
    out->tls = good && strcmp(scheme, "https") == 0;
    out->loopback = good && is_loopback(host);
    curl_free(scheme);
    curl_free(host);
    curl_free(path);
    curl_free(user);
    curl_free(query);
    curl_url_cleanup(parts);
    return good ? 0
                : error_set(err, ERROR_INPUT,
                            "the server's URL must be http(s)://HOST:PORT, without user or path");
}

/* --- fingerprints --- */

enum { DIGEST_BYTES = 32, PIN_SIZE = 64 };

static bool read_digest(const char *fingerprint, unsigned char digest[DIGEST_BYTES]) {
    static const char HEAD[] = "sha256:";
    const char *digits = fingerprint + sizeof HEAD - 1;
    if (strncmp(fingerprint, HEAD, sizeof HEAD - 1) != 0 ||
        strlen(digits) != 2 * (size_t)DIGEST_BYTES)
        return false;
    if (strspn(digits, "0123456789abcdefABCDEF") != 2 * (size_t)DIGEST_BYTES)
        return false;
    for (size_t i = 0; i < DIGEST_BYTES; i++) {
        const char pair[3] = {digits[2 * i], digits[2 * i + 1], '\0'};
        digest[i] = (unsigned char)strtoul(pair, NULL, 16);
    }
    return true;
}

/* Writes a digest as curl reads pins: sha256// and base64 (RFC 4648, 4). */
static void write_pin(const unsigned char digest[DIGEST_BYTES], char pin[PIN_SIZE]) {
    static const char LETTERS[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    size_t used = (size_t)snprintf(pin, PIN_SIZE, "sha256//");
    for (size_t i = 0; i < DIGEST_BYTES; i += 3) {
        bool last = i + 2 >= DIGEST_BYTES; /* 32 bytes: two are left */
        unsigned bits =
            (unsigned)digest[i] << 16 | (unsigned)digest[i + 1] << 8 | (last ? 0U : digest[i + 2]);
        for (int c = 0; c < 4; c++)
            pin[used++] = c == 3 && last ? '=' : LETTERS[bits >> (18 - 6 * c) & 63];
    }
    pin[used] = '\0';
}

static int pin_key(CURL *curl, const char *fingerprint, struct error *err) {
    unsigned char digest[DIGEST_BYTES];
    char pin[PIN_SIZE];
    if (!read_digest(fingerprint, digest))
        return error_set(err, ERROR_INPUT,
                         "the fingerprint %.80s is not sha256: and 64 hexadecimal digits, as rugo "
                         "serve prints it",
                         fingerprint);
    write_pin(digest, pin);
    /* The key is known: name and authority add nothing to it. */
    bool good = curl_easy_setopt(curl, CURLOPT_PINNEDPUBLICKEY, pin) == CURLE_OK &&
                curl_easy_setopt(curl, CURLOPT_SSL_VERIFYPEER, 0L) == CURLE_OK &&
                curl_easy_setopt(curl, CURLOPT_SSL_VERIFYHOST, 0L) == CURLE_OK;
    return good ? 0 : error_set(err, ERROR_SYSTEM, "libcurl cannot pin a server's key");
}

static int name_authorities(CURL *curl, const char *file, struct error *err) {
    if (access(file, R_OK) != 0)
        return error_set(err, ERROR_INPUT, "%s: %s", file, strerror(errno));
    bool good = curl_easy_setopt(curl, CURLOPT_CAINFO, file) == CURLE_OK &&
                curl_easy_setopt(curl, CURLOPT_CAPATH, NULL) == CURLE_OK;
    return good ? 0 : error_set(err, ERROR_SYSTEM, "libcurl takes no file of authorities");
}

int client_trust_set(CURL *curl, const struct client_trust *trust, const struct client_url *url,
                     struct error *err) {
    if (trust->ca_file != NULL && trust->fingerprint != NULL)
        return error_set(err, ERROR_INPUT,
                         "authorities and a fingerprint exclude each other: the key is known, or "
                         "somebody vouches for it");
    if (!url->tls)
        return trust->fingerprint == NULL
                   ? 0
                   : error_set(err, ERROR_INPUT, "a fingerprint goes with https://");
    bool good =
        curl_easy_setopt(curl, CURLOPT_SSLVERSION, (long)CURL_SSLVERSION_TLSv1_2) == CURLE_OK &&
        (!trust->own || (curl_easy_setopt(curl, CURLOPT_SSL_VERIFYPEER, 0L) == CURLE_OK &&
                         curl_easy_setopt(curl, CURLOPT_SSL_VERIFYHOST, 0L) == CURLE_OK));
    if (!good)
        return error_set(err, ERROR_SYSTEM, "libcurl has no TLS");
    if (trust->fingerprint != NULL)
        return pin_key(curl, trust->fingerprint, err);
    return trust->ca_file != NULL ? name_authorities(curl, trust->ca_file, err) : 0;
}

const char *client_trust_hint(CURLcode code) {
    switch (code) {
    case CURLE_PEER_FAILED_VERIFICATION:
        return "; --ca-file names who vouches for it, --fingerprint its key";
    case CURLE_SSL_PINNEDPUBKEYNOTMATCH:
        return "; its key is not that of --fingerprint: nothing was sent";
    case CURLE_SSL_CACERT_BADFILE:
        return "; the file of authorities cannot be used";
    default:
        return "";
    }
}

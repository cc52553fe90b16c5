#include "server/http/guard/certificate.h"
#include "server/command/service/secret_file.h"
#include "worker/log.h"
#include <gnutls/x509.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { CHAIN_MOST = 16 };

struct certificate_identity {
    gnutls_pcert_st chain[CHAIN_MOST]; /* the server's own first */
    unsigned length;
    gnutls_x509_crt_t own; /* the first of the chain, which has its names */
    gnutls_privkey_t key;
    char fingerprint[FINGERPRINT_SIZE];
    time_t begins, ends;
    unsigned users; /* sessions, and the certificate itself while this is its present one */
};

struct certificate {
    const char *certificate_file, *key_file; /* borrowed */
    pthread_mutex_t mutex;                   /* guards present, and users of every identity */
    struct certificate_identity *present;
};

static void identity_destroy(struct certificate_identity *identity) {
    if (identity == NULL)
        return;
    for (unsigned i = 0; i < identity->length; i++)
        gnutls_pcert_deinit(&identity->chain[i]);
    gnutls_x509_crt_deinit(identity->own);
    gnutls_privkey_deinit(identity->key);
    free(identity);
}

/* --- files --- */

static int refuse(const char *file, const char *what, int code, struct error *err) {
    return error_set(err, code == GNUTLS_E_MEMORY_ERROR ? ERROR_MEMORY : ERROR_INPUT,
                     "%s holds no %s in PEM (%s)", file, what, gnutls_strerror(code));
}

/* What is wanted of the first certificate of a chain. */
static int describe(struct certificate_identity *identity, gnutls_x509_crt_t first) {
    unsigned char digest[DIGEST_SIZE];
    size_t size = sizeof digest;
    int code = gnutls_x509_crt_get_key_id(first, GNUTLS_KEYID_USE_SHA256, digest, &size);
    if (code != 0)
        return code;
    digest_print(digest, identity->fingerprint);
    identity->begins = gnutls_x509_crt_get_activation_time(first);
    identity->ends = gnutls_x509_crt_get_expiration_time(first);
    return 0;
}

/* A certificate is no secret: anybody may read its file. */
static int read_chain(struct certificate_identity *identity, const char *file, struct error *err) {
    gnutls_x509_crt_t *chain = NULL;
    char *text = NULL;
    size_t size = 0;
    unsigned count = 0;
    int status = whole_file_read(file, SECRET_BYTES_MOST, &text, &size, err);
    if (status != 0)
        return status;
    const gnutls_datum_t datum = {(unsigned char *)text, (unsigned)size};
    int code = gnutls_x509_crt_list_import2(&chain, &count, &datum, GNUTLS_X509_FMT_PEM,
                                            GNUTLS_X509_CRT_LIST_FAIL_IF_UNSORTED);
    free(text);
    if (code < 0)
        return refuse(file, "certificate, each followed by the one that vouches for it,", code,
                      err);
    code = count <= CHAIN_MOST ? describe(identity, chain[0]) : GNUTLS_E_SHORT_MEMORY_BUFFER;
    for (unsigned i = 0; code == 0 && i < count; i++) {
        code = gnutls_pcert_import_x509(&identity->chain[i], chain[i], 0);
        identity->length += code == 0;
    }
    identity->own = chain[0];
    for (unsigned i = 1; i < count; i++)
        gnutls_x509_crt_deinit(chain[i]);
    gnutls_free(chain);
    return code == 0 ? 0 : refuse(file, "usable certificate", code, err);
}

/* Writes the fingerprint of a key's public half. */
static int key_fingerprint(gnutls_privkey_t key, char text[FINGERPRINT_SIZE]) {
    unsigned char digest[DIGEST_SIZE];
    size_t size = sizeof digest;
    gnutls_pubkey_t public = NULL;
    int code = gnutls_pubkey_init(&public);
    if (code != 0)
        return code;
    code = gnutls_pubkey_import_privkey(public, key, 0, 0);
    if (code == 0)
        code = gnutls_pubkey_get_key_id(public, GNUTLS_KEYID_USE_SHA256, digest, &size);
    if (code == 0)
        digest_print(digest, text);
    gnutls_pubkey_deinit(public);
    return code;
}

static int read_key(struct certificate_identity *identity, const char *file, const char *chain_file,
                    struct error *err) {
    char *text = NULL, fingerprint[FINGERPRINT_SIZE];
    size_t size = 0;
    int status = secret_file_read(file, false, &text, &size, err);
    if (status != 0)
        return status;
    const gnutls_datum_t datum = {(unsigned char *)text, (unsigned)size};
    int code = gnutls_privkey_init(&identity->key);
    if (code == 0)
        code = gnutls_privkey_import_x509_raw(identity->key, &datum, GNUTLS_X509_FMT_PEM, NULL, 0);
    if (code == 0)
        code = key_fingerprint(identity->key, fingerprint);
    explicit_bzero(text, size);
    free(text);
    if (code != 0)
        return refuse(file, "private key without a password", code, err);
    if (strcmp(fingerprint, identity->fingerprint) == 0)
        return 0;
    return error_set(err, ERROR_INPUT, "%s holds another key than that of the certificate in %s",
                     file, chain_file);
}

static int identity_create(struct certificate_identity **out, const struct certificate *files,
                           struct error *err) {
    struct certificate_identity *identity = calloc(1, sizeof *identity);
    if (identity == NULL)
        return error_memory(err, sizeof *identity, "a certificate");
    identity->users = 1;
    int status = read_chain(identity, files->certificate_file, err);
    if (status == 0)
        status = read_key(identity, files->key_file, files->certificate_file, err);
    if (status != 0)
        identity_destroy(identity);
    else
        *out = identity;
    return status;
}

static void warn_of_time(const struct certificate_identity *identity, const char *file) {
    enum { SOON = 14 * 86400 };
    time_t now = time(NULL);
    if (now < identity->begins)
        log_line(LEVEL_WARNING, NULL, "%s: the certificate is not valid yet", file);
    else if (now > identity->ends)
        log_line(LEVEL_WARNING, NULL, "%s: the certificate has expired", file);
    else if (identity->ends - now < SOON)
        log_line(LEVEL_WARNING, NULL, "%s: the certificate expires in %lld days", file,
                 (long long)(identity->ends - now) / 86400);
}

/* --- the certificate --- */

int certificate_open(struct certificate **out, const char *certificate_file, const char *key_file,
                     struct error *err) {
    struct certificate *certificate = calloc(1, sizeof *certificate);
    if (certificate == NULL)
        return error_memory(err, sizeof *certificate, "a certificate");
    certificate->certificate_file = certificate_file;
    certificate->key_file = key_file;
    pthread_mutex_init(&certificate->mutex, NULL);
    int status = certificate_reload(certificate, err);
    if (status != 0)
        certificate_close(&certificate);
    else
        *out = certificate;
    return status;
}

void certificate_close(struct certificate **certificate) {
    struct certificate *gone = *certificate;
    if (gone == NULL)
        return;
    certificate_give_back(gone, gone->present);
    pthread_mutex_destroy(&gone->mutex);
    free(gone);
    *certificate = NULL;
}

int certificate_reload(struct certificate *certificate, struct error *err) {
    struct certificate_identity *fresh = NULL;
    int status = identity_create(&fresh, certificate, err);
    if (status != 0)
        return status;
    warn_of_time(fresh, certificate->certificate_file);
    pthread_mutex_lock(&certificate->mutex);
    struct certificate_identity *old = certificate->present;
    certificate->present = fresh;
    pthread_mutex_unlock(&certificate->mutex);
    certificate_give_back(certificate, old);
    return 0;
}

void certificate_fingerprint(struct certificate *certificate, char text[FINGERPRINT_SIZE]) {
    pthread_mutex_lock(&certificate->mutex);
    memcpy(text, certificate->present->fingerprint, FINGERPRINT_SIZE);
    pthread_mutex_unlock(&certificate->mutex);
}

bool certificate_names(struct certificate *certificate, const char *name) {
    pthread_mutex_lock(&certificate->mutex);
    bool named = gnutls_x509_crt_check_hostname(certificate->present->own, name) != 0;
    pthread_mutex_unlock(&certificate->mutex);
    return named;
}

int certificate_file_fingerprint(const char *file, char text[FINGERPRINT_SIZE], struct error *err) {
    struct certificate_identity *identity = calloc(1, sizeof *identity);
    if (identity == NULL)
        return error_memory(err, sizeof *identity, "a certificate");
    int status = read_chain(identity, file, err);
    if (status == 0)
        memcpy(text, identity->fingerprint, FINGERPRINT_SIZE);
    identity_destroy(identity);
    return status;
}

/* --- sessions --- */

struct certificate_identity *certificate_lend(struct certificate *certificate,
                                              gnutls_session_t session) {
    pthread_mutex_lock(&certificate->mutex);
    struct certificate_identity *identity = certificate->present;
    identity->users++;
    pthread_mutex_unlock(&certificate->mutex);
    gnutls_session_set_ptr(session, identity);
    return identity;
}

void certificate_give_back(struct certificate *certificate, struct certificate_identity *identity) {
    if (identity == NULL)
        return;
    pthread_mutex_lock(&certificate->mutex);
    bool last = --identity->users == 0;
    pthread_mutex_unlock(&certificate->mutex);
    if (last)
        identity_destroy(identity);
}

int certificate_retrieve(gnutls_session_t session, const struct gnutls_cert_retr_st *info,
                         gnutls_pcert_st **certs, unsigned *certs_length,
                         gnutls_ocsp_data_st **ocsp, unsigned *ocsp_length, gnutls_privkey_t *key,
                         unsigned *flags) {
    struct certificate_identity *identity = gnutls_session_get_ptr(session);
    (void)info;
    if (identity == NULL)
        return -1;
    *certs = identity->chain;
    *certs_length = identity->length;
    *key = identity->key;
    *ocsp = NULL;
    *ocsp_length = 0;
    *flags = 0; /* they stay ours */
    return 0;
}

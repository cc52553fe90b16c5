#include "server/http/guard/self_signed.h"
#include "server/command/service/secret_file.h"
#include <arpa/inet.h>
#include <errno.h>
#include <gnutls/crypto.h>
#include <gnutls/x509.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum {
    SERIAL_BYTES = 16,
    HOST_MOST = 253,      /* characters of a name in the DNS (RFC 1035, 2.3.4, without its root) */
    CLOCKS_APART_S = 3600 /* that a client's clock may be behind */
};

static const char *const LOOPBACK[] = {"localhost", "127.0.0.1", "::1", NULL};

static bool is_name(const char *host) {
    size_t length = strlen(host);
    return length > 0 && length <= HOST_MOST &&
           strspn(host, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-_") ==
               length;
}

static int add_host(gnutls_x509_crt_t certificate, const char *host) {
    unsigned char address[sizeof(struct in6_addr)];
    if (inet_pton(AF_INET, host, address) == 1)
        return gnutls_x509_crt_set_subject_alt_name(certificate, GNUTLS_SAN_IPADDRESS, address,
                                                    sizeof(struct in_addr), GNUTLS_FSAN_APPEND);
    if (inet_pton(AF_INET6, host, address) == 1)
        return gnutls_x509_crt_set_subject_alt_name(certificate, GNUTLS_SAN_IPADDRESS, address,
                                                    sizeof(struct in6_addr), GNUTLS_FSAN_APPEND);
    return gnutls_x509_crt_set_subject_alt_name(certificate, GNUTLS_SAN_DNSNAME, host,
                                                (unsigned)strlen(host), GNUTLS_FSAN_APPEND);
}

static int set_times(gnutls_x509_crt_t certificate, unsigned days) {
    time_t now = time(NULL);
    int code = gnutls_x509_crt_set_activation_time(certificate, now - CLOCKS_APART_S);
    return code != 0 ? code
                     : gnutls_x509_crt_set_expiration_time(certificate, now + 86400 * (time_t)days);
}

/* The serial number is random and positive (RFC 5280, 4.1.2.2). */
static int set_serial(gnutls_x509_crt_t certificate) {
    unsigned char serial[SERIAL_BYTES];
    int code = gnutls_rnd(GNUTLS_RND_NONCE, serial, sizeof serial);
    serial[0] = (unsigned char)((serial[0] & 0x3f) | 0x40);
    return code != 0 ? code : gnutls_x509_crt_set_serial(certificate, serial, sizeof serial);
}

static int set_use(gnutls_x509_crt_t certificate) {
    int code = gnutls_x509_crt_set_basic_constraints(certificate, 0, -1);
    if (code == 0)
        code = gnutls_x509_crt_set_key_usage(certificate, GNUTLS_KEY_DIGITAL_SIGNATURE);
    return code != 0
               ? code
               : gnutls_x509_crt_set_key_purpose_oid(certificate, GNUTLS_KP_TLS_WWW_SERVER, 0);
}

static int set_key(gnutls_x509_crt_t certificate, gnutls_x509_privkey_t key) {
    unsigned char id[20];
    size_t size = sizeof id;
    int code = gnutls_x509_crt_set_key(certificate, key);
    if (code == 0)
        code = gnutls_x509_crt_get_key_id(certificate, 0, id, &size);
    return code != 0 ? code : gnutls_x509_crt_set_subject_key_id(certificate, id, size);
}

static int fill(gnutls_x509_crt_t certificate, gnutls_x509_privkey_t key, const char *const *hosts,
                unsigned days) {
    static const char SUBJECT[] = "rugo serve";
    int code = gnutls_x509_crt_set_version(certificate, 3);
    if (code == 0)
        code = gnutls_x509_crt_set_dn_by_oid(certificate, GNUTLS_OID_X520_COMMON_NAME, 0, SUBJECT,
                                             sizeof SUBJECT - 1);
    if (code == 0)
        code = set_times(certificate, days);
    if (code == 0)
        code = set_serial(certificate);
    if (code == 0)
        code = set_use(certificate);
    if (code == 0)
        code = set_key(certificate, key);
    for (const char *const *host = LOOPBACK; code == 0 && *host != NULL; host++)
        code = add_host(certificate, *host);
    for (const char *const *host = hosts; code == 0 && host != NULL && *host != NULL; host++)
        code = add_host(certificate, *host);
    return code != 0 ? code
                     : gnutls_x509_crt_sign2(certificate, certificate, key, GNUTLS_DIG_SHA256, 0);
}

/* Both as PEM, to be released by gnutls_free. */
static int make(const char *const *hosts, unsigned days, gnutls_datum_t *certificate_text,
                gnutls_datum_t *key_text) {
    gnutls_x509_privkey_t key = NULL;
    gnutls_x509_crt_t certificate = NULL;
    int code = gnutls_x509_privkey_init(&key);
    if (code == 0)
        code = gnutls_x509_crt_init(&certificate);
    if (code == 0)
        code = gnutls_x509_privkey_generate(key, GNUTLS_PK_ECDSA,
                                            GNUTLS_CURVE_TO_BITS(GNUTLS_ECC_CURVE_SECP256R1), 0);
    if (code == 0)
        code = fill(certificate, key, hosts, days);
    if (code == 0)
        code = gnutls_x509_crt_export2(certificate, GNUTLS_X509_FMT_PEM, certificate_text);
    if (code == 0)
        code = gnutls_x509_privkey_export2_pkcs8(key, GNUTLS_X509_FMT_PEM, NULL, GNUTLS_PKCS_PLAIN,
                                                 key_text);
    gnutls_x509_crt_deinit(certificate);
    gnutls_x509_privkey_deinit(key);
    return code;
}

static int write_both(const char *folder, const gnutls_datum_t *certificate,
                      const gnutls_datum_t *key, char fingerprint[FINGERPRINT_SIZE],
                      struct error *err) {
    char certificate_file[PATH_MAX], key_file[PATH_MAX];
    if ((size_t)snprintf(certificate_file, PATH_MAX, "%s/" CERTIFICATE_FILE, folder) >= PATH_MAX)
        return error_set(err, ERROR_INPUT, "the name of the folder is longer than %d bytes",
                         PATH_MAX);
    snprintf(key_file, PATH_MAX, "%s/" KEY_FILE, folder);
    if (mkdir(folder, 0755) != 0 && errno != EEXIST)
        return error_set(err, ERROR_SYSTEM, "%s: %s", folder, strerror(errno));
    int status = secret_file_write(key_file, (const char *)key->data, key->size, err);
    if (status != 0)
        return status;
    status = secret_file_write(certificate_file, (const char *)certificate->data, certificate->size,
                               err);
    if (status == 0) {
        (void)chmod(certificate_file, 0644); /* for all, since every client is shown it */
        status = certificate_file_fingerprint(certificate_file, fingerprint, err);
    }
    if (status != 0)
        unlink(key_file);
    return status;
}

int self_signed_make(const char *folder, const char *const *hosts, unsigned days,
                     char fingerprint[FINGERPRINT_SIZE], struct error *err) {
    gnutls_datum_t certificate = {0}, key = {0};
    for (const char *const *host = hosts; host != NULL && *host != NULL; host++) {
        unsigned char address[sizeof(struct in6_addr)];
        if (!is_name(*host) && inet_pton(AF_INET6, *host, address) != 1)
            return error_set(err, ERROR_INPUT, "\"%.80s\" is no name or address of a machine",
                             *host);
    }
    int code = make(hosts, days, &certificate, &key);
    int status = code == 0 ? write_both(folder, &certificate, &key, fingerprint, err)
                           : error_set(err, ERROR_SYSTEM, "no certificate can be made: %s",
                                       gnutls_strerror(code));
    if (key.data != NULL)
        explicit_bzero(key.data, key.size);
    gnutls_free(key.data);
    gnutls_free(certificate.data);
    return status;
}

/* Protects: over TLS a client talks to the server it means and to no other, by authority or by
 * fingerprint; the certificate is replaced under open connections; and what is wrong with the files
 * of one is reported. */
#include "server/http/guard/self_signed.h"
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include <gnutls/gnutls.h>
#include <gnutls/x509.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

struct tls_server {
    struct process process;
    unsigned port;
    char url[64], fingerprint[FINGERPRINT_SIZE];
};

static void start(struct tls_server *server, const char *certificate, const char *key,
                  const char *database) {
    const char *const arguments[] = {"serve",  "--listen",   "127.0.0.1:0", "--db",
                                     database, "--tls-cert", certificate,   "--tls-key",
                                     key,      "--workers",  "1",           NULL};
    process_start(&server->process, "serve", arguments);
    wait_for_text(server->process.out, "fingerprint sha256:");
    wait_for_text(server->process.err, "listening on https");
    char *text = slurp(server->process.out);
    assert_int_equal(sscanf(text, "listening on https://127.0.0.1:%u\nfingerprint %71s",
                            &server->port, server->fingerprint),
                     2);
    free(text);
    snprintf(server->url, sizeof server->url, "https://localhost:%u", server->port);
}

static void stop(struct tls_server *server) {
    process_kill(&server->process, SIGTERM);
    assert_int_equal(process_wait(&server->process, 15), 0);
}

/* Makes dir/certificate.pem and dir/key.pem; the fingerprint. */
static void make(const char *folder, unsigned days, char fingerprint[FINGERPRINT_SIZE]) {
    struct error err = {0};
    assert_int_equal(self_signed_make(folder, NULL, days, fingerprint, &err), 0);
}

static int status_with(const struct tls_server *server, const char *option, const char *value) {
    return run_rugo("client",
                    (const char *[]){"status", "--server", server->url, option, value, NULL});
}

/* --- a certificate that an authority vouches for --- */

static void write_pem(const char *path, gnutls_x509_crt_t certificate) {
    gnutls_datum_t text = {0};
    assert_int_equal(gnutls_x509_crt_export2(certificate, GNUTLS_X509_FMT_PEM, &text), 0);
    spit(path, (const char *)text.data);
    gnutls_free(text.data);
}

static gnutls_x509_privkey_t new_key(void) {
    gnutls_x509_privkey_t key;
    assert_int_equal(gnutls_x509_privkey_init(&key), 0);
    assert_int_equal(gnutls_x509_privkey_generate(
                         key, GNUTLS_PK_ECDSA, GNUTLS_CURVE_TO_BITS(GNUTLS_ECC_CURVE_SECP256R1), 0),
                     0);
    return key;
}

/* host NULL: of an authority. */
static gnutls_x509_crt_t new_certificate(gnutls_x509_privkey_t key, const char *host,
                                         unsigned char serial) {
    gnutls_x509_crt_t certificate;
    const char *name = host != NULL ? host : "authority of the test";
    assert_int_equal(gnutls_x509_crt_init(&certificate), 0);
    gnutls_x509_crt_set_version(certificate, 3);
    gnutls_x509_crt_set_key(certificate, key);
    gnutls_x509_crt_set_serial(certificate, &serial, 1);
    gnutls_x509_crt_set_dn_by_oid(certificate, GNUTLS_OID_X520_COMMON_NAME, 0, name,
                                  (unsigned)strlen(name));
    gnutls_x509_crt_set_activation_time(certificate, time(NULL) - 60);
    gnutls_x509_crt_set_expiration_time(certificate, time(NULL) + 86400);
    gnutls_x509_crt_set_basic_constraints(certificate, host == NULL, -1);
    gnutls_x509_crt_set_key_usage(certificate, host == NULL ? GNUTLS_KEY_KEY_CERT_SIGN
                                                            : GNUTLS_KEY_DIGITAL_SIGNATURE);
    if (host != NULL)
        gnutls_x509_crt_set_subject_alt_name(certificate, GNUTLS_SAN_DNSNAME, host,
                                             (unsigned)strlen(host), GNUTLS_FSAN_APPEND);
    return certificate;
}

/* Writes authority.pem, HOST.pem and HOST.key. */
static void make_by_authority(const char *const *hosts) {
    gnutls_x509_privkey_t authority_key = new_key();
    gnutls_x509_crt_t authority = new_certificate(authority_key, NULL, 1);
    assert_int_equal(
        gnutls_x509_crt_sign2(authority, authority, authority_key, GNUTLS_DIG_SHA256, 0), 0);
    write_pem("authority.pem", authority);
    for (unsigned char h = 0; hosts[h] != NULL; h++) {
        char path[64];
        gnutls_datum_t text = {0};
        gnutls_x509_privkey_t key = new_key();
        gnutls_x509_crt_t certificate = new_certificate(key, hosts[h], (unsigned char)(2 + h));
        assert_int_equal(
            gnutls_x509_crt_sign2(certificate, authority, authority_key, GNUTLS_DIG_SHA256, 0), 0);
        snprintf(path, sizeof path, "%s.pem", hosts[h]);
        write_pem(path, certificate);
        assert_int_equal(gnutls_x509_privkey_export2(key, GNUTLS_X509_FMT_PEM, &text), 0);
        snprintf(path, sizeof path, "%s.key", hosts[h]);
        spit_secret(path, (const char *)text.data);
        gnutls_free(text.data);
        gnutls_x509_crt_deinit(certificate);
        gnutls_x509_privkey_deinit(key);
    }
    gnutls_x509_crt_deinit(authority);
    gnutls_x509_privkey_deinit(authority_key);
}

static void an_authority_vouches_for_names(void **state) {
    (void)state;
    make_by_authority((const char *[]){"localhost", "elsewhere.invalid", NULL});
    struct tls_server here = {0}, elsewhere = {0};
    start(&here, "localhost.pem", "localhost.key", "here.db");
    assert_int_equal(status_with(&here, "--ca-file", "authority.pem"), 0);
    assert_int_equal(status_with(&here, "--format", "json"), 2); /* the system does not know it */
    assert_true(contains("client.err", "--fingerprint"));
    assert_int_equal(status_with(&here, "--ca-file", "absent.pem"), 2);
    assert_true(contains("client.err", "absent.pem"));
    stop(&here);
    start(&elsewhere, "elsewhere.invalid.pem", "elsewhere.invalid.key", "elsewhere.db");
    assert_int_equal(status_with(&elsewhere, "--ca-file", "authority.pem"), 2);
    assert_int_equal(status_with(&elsewhere, "--fingerprint", elsewhere.fingerprint), 0);
    stop(&elsewhere);
}

/* --- a pinned key --- */

static void a_study_runs_by_fingerprint_alone(void **state) {
    (void)state;
    struct tls_server server = {0};
    char fingerprint[FINGERPRINT_SIZE];
    make("pinned", 10, fingerprint);
    start(&server, "pinned/certificate.pem", "pinned/key.pem", "pinned.db");
    assert_string_equal(server.fingerprint, fingerprint);
    assert_true(contains(server.process.err, fingerprint));
    assert_int_equal(
        run_rugo("show", (const char *[]){"certificate", "show", "pinned/certificate.pem", NULL}),
        0);
    assert_true(contains("show.out", fingerprint));
    spit("one.json", ONE_CASE);
    /* its own workers compute it */
    assert_int_equal(
        run_rugo("client", (const char *[]){"submit", "one.json", "--server", server.url,
                                            "--fingerprint", fingerprint, NULL}),
        0);
    assert_int_equal(run_rugo("client", (const char *[]){"wait", "one", "--server", server.url,
                                                         "--fingerprint", fingerprint, NULL}),
                     0);
    assert_int_equal(status_with(&server, "--ca-file", "pinned/certificate.pem"), 0);

    char wrong[FINGERPRINT_SIZE];
    memcpy(wrong, fingerprint, sizeof wrong);
    wrong[70] = wrong[70] == '0' ? '1' : '0';
    assert_int_equal(status_with(&server, "--fingerprint", wrong), 2);
    assert_true(contains("client.err", "nothing was sent"));
    assert_int_equal(status_with(&server, "--fingerprint", "sha256:12"), 2);
    assert_true(contains("client.err", "64 hexadecimal digits"));
    /* a worker that is shown another key ends, for waiting does not help */
    assert_int_equal(run_rugo("client", (const char *[]){"work", "--server", server.url,
                                                         "--fingerprint", wrong, NULL}),
                     2);
    stop(&server);
}

/* --- replaced while it runs --- */

struct tls_client {
    int socket;
    gnutls_session_t session;
    gnutls_certificate_credentials_t credentials;
};

/* Opens a session that checks nothing; with "NORMAL" priorities unless others are given. 0, or what
 * GnuTLS says. */
static int tls_open(struct tls_client *client, unsigned port, const char *priorities) {
    client->socket = http_connect(port);
    assert_int_equal(gnutls_init(&client->session, GNUTLS_CLIENT), 0);
    assert_int_equal(gnutls_certificate_allocate_credentials(&client->credentials), 0);
    assert_int_equal(gnutls_priority_set_direct(client->session, priorities, NULL), 0);
    gnutls_credentials_set(client->session, GNUTLS_CRD_CERTIFICATE, client->credentials);
    gnutls_transport_set_int(client->session, client->socket);
    int code;
    while ((code = gnutls_handshake(client->session)) < 0 && !gnutls_error_is_fatal(code))
        ;
    return code;
}

static void tls_close(struct tls_client *client) {
    gnutls_deinit(client->session);
    gnutls_certificate_free_credentials(client->credentials);
    close(client->socket);
}

/* The digest of the key that the server showed. */
static void tls_fingerprint(const struct tls_client *client, char text[FINGERPRINT_SIZE]) {
    unsigned count = 0;
    const gnutls_datum_t *chain = gnutls_certificate_get_peers(client->session, &count);
    gnutls_x509_crt_t certificate;
    unsigned char digest[32];
    size_t size = sizeof digest;
    assert_true(count > 0);
    gnutls_x509_crt_init(&certificate);
    assert_int_equal(gnutls_x509_crt_import(certificate, chain, GNUTLS_X509_FMT_DER), 0);
    assert_int_equal(
        gnutls_x509_crt_get_key_id(certificate, GNUTLS_KEYID_USE_SHA256, digest, &size), 0);
    gnutls_x509_crt_deinit(certificate);
    size_t used = (size_t)snprintf(text, FINGERPRINT_SIZE, "sha256:");
    for (size_t i = 0; i < sizeof digest; i++)
        used += (size_t)snprintf(text + used, FINGERPRINT_SIZE - used, "%02x", digest[i]);
}

static void replace_files(const char *from, const char *to) {
    char command[256];
    snprintf(command, sizeof command, "cp %s/key.pem %s/key.pem && cp %s/certificate.pem %s/", from,
             to, from, to);
    assert_int_equal(system(command), 0);
}

static int tls_ask_as(struct tls_client *client, const char *host) {
    char request[256], answer[4096] = "";
    size_t used = 0;
    int status = 0;
    int length =
        snprintf(request, sizeof request, "GET /healthz HTTP/1.1\r\nHost: %s\r\n\r\n", host);
    assert_int_equal(gnutls_record_send(client->session, request, (size_t)length), length);
    while (strstr(answer, "}") == NULL) { /* the end of the body, which may come by itself */
        ssize_t got = gnutls_record_recv(client->session, answer + used, sizeof answer - 1 - used);
        if (got <= 0 && (got == 0 || gnutls_error_is_fatal((int)got)))
            fail_msg("no answer: %s", gnutls_strerror((int)got));
        used += got > 0 ? (size_t)got : 0;
        answer[used] = '\0';
    }
    assert_int_equal(sscanf(answer, "HTTP/1.1 %d", &status), 1);
    return status;
}

static int tls_ask(struct tls_client *client) {
    return tls_ask_as(client, "localhost");
}

/* What a connection of its own gets that asks for a server of this name. */
static int status_as(const struct tls_server *server, const char *host) {
    struct tls_client client = {0};
    assert_int_equal(tls_open(&client, server->port, "NORMAL"), 0);
    int status = tls_ask_as(&client, host);
    tls_close(&client);
    return status;
}

/* A browser of another site that pointed its own name at this server is refused by that name; who
 * asks for a name of the certificate is not. */
static void names_of_the_certificate_are_the_servers(void **state) {
    (void)state;
    const char *const hosts[] = {"head.invalid", NULL};
    struct tls_server server = {0};
    char fingerprint[FINGERPRINT_SIZE];
    struct error err = {0};
    assert_int_equal(self_signed_make("named", hosts, 10, fingerprint, &err), 0);
    start(&server, "named/certificate.pem", "named/key.pem", "named.db");
    assert_int_equal(status_as(&server, "Head.invalid:8080"), 200);
    assert_int_equal(status_as(&server, "other.invalid"), 403);
    assert_int_equal(status_as(&server, "head.invalid.other.invalid"), 403);

    /* as those of the next one are, once that is read */
    make("unnamed", 10, fingerprint);
    replace_files("unnamed", "named");
    process_kill(&server.process, SIGHUP);
    wait_for_text(server.process.err, fingerprint);
    assert_int_equal(status_as(&server, "head.invalid"), 403);
    assert_int_equal(status_as(&server, "localhost"), 200);
    stop(&server);
}

static void a_certificate_is_replaced_under_open_connections(void **state) {
    (void)state;
    struct tls_server server = {0};
    struct tls_client before = {0}, after = {0};
    char first[FINGERPRINT_SIZE], second[FINGERPRINT_SIZE], seen[FINGERPRINT_SIZE];
    make("used", 10, first);
    make("next", 10, second);
    assert_string_not_equal(first, second);
    start(&server, "used/certificate.pem", "used/key.pem", "replaced.db");
    assert_int_equal(tls_open(&before, server.port, "NORMAL"), 0);
    tls_fingerprint(&before, seen);
    assert_string_equal(seen, first);
    assert_int_equal(tls_ask(&before), 200);

    replace_files("next", "used");
    process_kill(&server.process, SIGHUP);
    wait_for_text(server.process.err, second);
    assert_int_equal(tls_ask(&before), 200);
    assert_int_equal(tls_open(&after, server.port, "NORMAL"), 0);
    tls_fingerprint(&after, seen);
    assert_string_equal(seen, second);
    assert_int_equal(tls_ask(&after), 200);
    tls_close(&after);

    /* Files that do not fit leave what is there. */
    assert_int_equal(system("cp pair/key.pem used/key.pem 2>/dev/null || echo no >used/key.pem"),
                     0);
    process_kill(&server.process, SIGHUP);
    wait_for_text(server.process.err, "stays as it was");
    assert_int_equal(tls_ask(&before), 200);
    assert_int_equal(tls_open(&after, server.port, "NORMAL"), 0);
    tls_fingerprint(&after, seen);
    assert_string_equal(seen, second);
    tls_close(&after);
    tls_close(&before);

    /* Old versions of the protocol are no more. */
    assert_int_not_equal(
        tls_open(&after, server.port, "NORMAL:-VERS-ALL:+VERS-TLS1.1:+VERS-TLS1.0:%COMPAT"), 0);
    tls_close(&after);
    assert_int_equal(tls_open(&after, server.port, "NORMAL:-VERS-ALL:+VERS-TLS1.2"), 0);
    tls_close(&after);
    stop(&server);
}

/* --- files --- */

static void expect_refusal(const char *certificate, const char *key, const char *text) {
    assert_int_equal(run_rugo("refused", (const char *[]){"serve", "--db", "refused.db", "--listen",
                                                          "127.0.0.1:0", "--tls-cert", certificate,
                                                          "--tls-key", key, NULL}),
                     2);
    if (!contains("refused.err", text))
        fail_msg("%s, %s: not \"%s\"", certificate, key, text);
}

static void faults_of_files_are_told(void **state) {
    (void)state;
    char fingerprint[FINGERPRINT_SIZE];
    make("good", 10, fingerprint);
    make("pair", 10, fingerprint);
    make("expired", 0, fingerprint);
    spit("text", "no certificate\n");
    spit_secret("secret-text", "no key\n");
    expect_refusal("absent", "good/key.pem", "absent: No such file");
    expect_refusal("text", "good/key.pem", "text holds no certificate");
    expect_refusal("good/certificate.pem", "absent", "absent: No such file");
    expect_refusal("good/certificate.pem", "secret-text", "secret-text holds no private key");
    expect_refusal("good/certificate.pem", "pair/key.pem", "another key");
    assert_int_equal(chmod("good/key.pem", 0644), 0);
    expect_refusal("good/certificate.pem", "good/key.pem", "chmod 600");
    assert_int_equal(run_rugo("refused", (const char *[]){"serve", "--db", "refused.db",
                                                          "--tls-cert", "text", NULL}),
                     2);
    assert_true(contains("refused.err", "go together"));
    assert_int_equal(run_rugo("again", (const char *[]){"certificate", "new", "pair", NULL}), 2);
    assert_true(contains("again.err", "left as it is"));

    struct tls_server server = {0};
    sleep_ms(1100); /* its last second */
    start(&server, "expired/certificate.pem", "expired/key.pem", "expired.db");
    assert_true(contains(server.process.err, "has expired"));
    stop(&server);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_authority_vouches_for_names),
        cmocka_unit_test(a_study_runs_by_fingerprint_alone),
        cmocka_unit_test(names_of_the_certificate_are_the_servers),
        cmocka_unit_test(a_certificate_is_replaced_under_open_connections),
        cmocka_unit_test(faults_of_files_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

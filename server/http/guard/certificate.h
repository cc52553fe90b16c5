/* The certificate of a server that speaks TLS, with its key. It may be replaced at any time: open
 * connections keep what they began with, new ones get the new one. Safe from many threads. */
#ifndef RUGO_SERVER_HTTP_GUARD_CERTIFICATE_H
#define RUGO_SERVER_HTTP_GUARD_CERTIFICATE_H

#include "core/error.h"
#include "schema/digest.h"
#include <gnutls/abstract.h>
#include <stdbool.h>

enum { FINGERPRINT_SIZE = DIGEST_TEXT_SIZE };

/* What a server offers: TLS 1.2 and 1.3, and no cipher that is known to be weak (GnuTLS, priority
 * strings). */
#define CERTIFICATE_PRIORITIES "NORMAL:-VERS-ALL:+VERS-TLS1.3:+VERS-TLS1.2:%SERVER_PRECEDENCE"

struct certificate;
/* Reads a certificate with the chain of those that vouch for it, and its key, in PEM. ERROR_INPUT
 * where a file cannot be understood, is a key that others may read (secret_file.h), or is of
 * another key. One that is not valid at this time is warned of in the log, and taken. */
int certificate_open(struct certificate **out, const char *certificate_file, const char *key_file,
                     struct error *err);
void certificate_close(struct certificate **certificate);
/* Reads the files again; what was there stays where that fails. */
int certificate_reload(struct certificate *certificate, struct error *err);
/* Writes the SHA-256 digest of the public key, in DER as a SubjectPublicKeyInfo (RFC 5280, 4.1): a
 * certificate that is renewed for the same key keeps it. */
void certificate_fingerprint(struct certificate *certificate, char text[FINGERPRINT_SIZE]);
/* Whether the certificate is for this name of a server. */
bool certificate_names(struct certificate *certificate, const char *name);
/* Writes the fingerprint of the first certificate of a file. */
int certificate_file_fingerprint(const char *file, char text[FINGERPRINT_SIZE], struct error *err);

/* What a connection shows: certificate and key as they were when it was opened. Lent to a session
 * before its handshake, and given back once the session is over. */
struct certificate_identity;
struct certificate_identity *certificate_lend(struct certificate *certificate,
                                              gnutls_session_t session);
void certificate_give_back(struct certificate *certificate, struct certificate_identity *identity);
/* Notes in GnuTLS what was lent to a session. */
gnutls_certificate_retrieve_function3 certificate_retrieve;

#endif

/* Certificates that a server makes for itself: no authority signs them, so that clients need their
 * fingerprint. */
#ifndef RUGO_SERVER_HTTP_GUARD_SELF_SIGNED_H
#define RUGO_SERVER_HTTP_GUARD_SELF_SIGNED_H

#include "core/error.h"
#include "server/http/guard/certificate.h"

#define CERTIFICATE_FILE "certificate.pem"
#define KEY_FILE "key.pem"

/* Makes a key (of the curve P-256) and a certificate for it, from now on for so many days, for
 * this machine's loopback and these names and addresses (NULL-terminated), and writes them into a
 * folder, which is made where there is none. Files that are there stay: ERROR_INPUT. */
int self_signed_make(const char *folder, const char *const *hosts, unsigned days,
                     char fingerprint[FINGERPRINT_SIZE], struct error *err);

#endif

/* Which servers a client trusts, and with which it shares its token. */
#ifndef RUGO_WORKER_LINK_CLIENT_TRUST_H
#define RUGO_WORKER_LINK_CLIENT_TRUST_H

#include <stdbool.h>

/* All zero: servers whose certificate an authority of the system signed. A token is sent over TLS,
 * or to this machine, alone. */
struct client_trust {
    const char *ca_file; /* PEM: these authorities alone; NULL: the system's */
    /* "sha256:" and 64 hexadecimal digits: the server whose public key has this digest, whatever
     * its name and its certificate; NULL: any with a valid certificate. */
    const char *fingerprint;
    bool insecure; /* a token may cross a network in clear text */
    bool own;      /* the server is of this process, and need not be checked */
};

#endif

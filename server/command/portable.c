#include "server/command/portable.h"
#include <nss.h>
#include <stdbool.h>
#include <stdlib.h>
#include <sys/auxv.h>
#include <unistd.h>

/* Address of the interpreter, which loads shared libraries, by the kernel: none. */
static bool is_static(void) {
    return getauxval(AT_BASE) == 0;
}

void portable_prepare(void) {
    static const char *const BUNDLES[] = {
        "/etc/ssl/certs/ca-certificates.crt", /* Debian, Ubuntu, Arch, Alpine */
        "/etc/pki/tls/certs/ca-bundle.crt",   /* Fedora, Red Hat and its kin */
        "/etc/ssl/ca-bundle.pem",             /* SUSE */
    };
    if (!is_static())
        return;
    __nss_configure_lookup("hosts", "files dns");
    __nss_configure_lookup("passwd", "files");
    for (size_t b = 0; b < sizeof BUNDLES / sizeof *BUNDLES; b++)
        if (access(BUNDLES[b], R_OK) == 0)
            setenv("SSL_CERT_FILE", BUNDLES[b], 0);
}

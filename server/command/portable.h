/* What a statically linked program settles with the machine it was copied to. */
#ifndef RUGO_SERVER_COMMAND_PORTABLE_H
#define RUGO_SERVER_COMMAND_PORTABLE_H

/* To be called first in main, before any thread; does nothing in a program with shared libraries.
 *
 * Host names are looked up in /etc/hosts and DNS alone: what else /etc/nsswitch.conf names are
 * shared objects, which belong to the machine's own C library and may crash with this one.
 * Certificates of authorities are taken from where the machine's distribution keeps them, unless
 * SSL_CERT_FILE says where. */
void portable_prepare(void);

#endif

/* Headers that let two readers, such as a proxy and this server, see different requests in the same
 * bytes (RFC 9112, 2.2, 5.1, 5.2 and 6.3). */
#ifndef RUGO_SERVER_HTTP_HEADERS_H
#define RUGO_SERVER_HTTP_HEADERS_H

#include <microhttpd.h>

/* Returns what is wrong with the headers of a request, a static text; NULL where nothing is. */
const char *headers_fault(struct MHD_Connection *connection);

#endif

/* What a peer likes to get: the headers Accept and Accept-Encoding (RFC 9110, 12.5). */
#ifndef RUGO_SERVER_HTTP_ACCEPT_H
#define RUGO_SERVER_HTTP_ACCEPT_H

/* How much a media type ("text/csv") or a coding ("gzip") is liked, by the range that fits it most
 * closely: 1 without a header, 0 where nothing fits. */
double accept_quality(const char *accept, const char *type);

#endif

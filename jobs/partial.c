#include "jobs/partial.h"

int partial_encode(const struct job_kind *kind, uint64_t fingerprint, const void *tally,
                   unsigned char **data, size_t *size, struct error *err) {
    struct bytes bytes = {0};
    bytes_put_unsigned(&bytes, kind->format);
    bytes_put_unsigned(&bytes, kind->format_version);
    bytes_put_unsigned(&bytes, fingerprint);
    kind->put(&bytes, tally);
    bytes_put_checksum(&bytes);
    if (bytes.failed) {
        int status = error_memory(err, bytes.capacity, "a partial result");
        bytes_clear(&bytes);
        return status;
    }
    *data = bytes.data;
    *size = bytes.size;
    return 0;
}

static int refuse(struct error *err, const char *reason) {
    return error_set(err, ERROR_INPUT, "the partial result %s", reason);
}

int partial_decode(const struct job_kind *kind, uint64_t fingerprint, const unsigned char *data,
                   size_t size, void *tally, struct error *err) {
    struct byte_reader reader = bytes_open(data, size);
    if (reader.failed)
        return refuse(err, "is cut short or damaged: its checksum does not match");
    if (bytes_get_unsigned(&reader) != kind->format)
        return error_set(err, ERROR_INPUT, "the partial result is not one of %s", kind->study.name);
    if (bytes_get_unsigned(&reader) != kind->format_version)
        return refuse(err, "is of another version of its format; rugo retry computes it anew");
    if (bytes_get_unsigned(&reader) != fingerprint)
        return refuse(err, "is of a case with other parameters");
    kind->get(&reader, tally);
    if (reader.out_of_memory)
        return error_memory(err, size, "a partial result");
    if (reader.failed || reader.at != reader.end)
        return refuse(err, "is malformed");
    return kind->adds_up == NULL || kind->adds_up(tally) ? 0 : refuse(err, "does not add up");
}

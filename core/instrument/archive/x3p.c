/* X3P, the container of ISO 25178-72 (before: ISO 5436-2): a zip archive with main.xml, and a
 * binary file of points unless main.xml lists them. Lengths are in metres by the standard. A
 * rotation of the patch in space is ignored: heights stay those above the grid of the
 * instrument. */
#include "core/instrument/archive/x3p_points.h"
#include "core/instrument/archive/zip_archive.h"
#include "core/instrument/formats.h"
#include "core/instrument/layers.h"
#include <nettle/md5.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct x3p {
    struct zip_archive *zip;                  /* owned */
    const struct instrument_request *request; /* borrowed */
    const char *folder;                       /* borrowed, of the name of main.xml: */
    int folder_length;                        /* "" or "scan/" */
    struct x3p_fields fields;
    struct x3p_xml *xml;       /* owned */
    struct x3p_points *points; /* owned; NULL until the layout is known */
    struct x3p_layout layout;  /* as `points` */
    size_t listed_most;        /* points that main.xml has room for */
    struct md5_ctx md5;        /* of the entry that is being unpacked */
};

/* --- checksums --- */

static int digit_of(char character) {
    static const char DIGITS[] = "0123456789abcdef0123456789ABCDEF";
    const char *at = character != '\0' ? strchr(DIGITS, character) : NULL;
    return at != NULL ? (int)((at - DIGITS) % 16) : -1;
}

/* Compares what was unpacked with the 32 hexadecimal digits at the beginning of a text. */
static int check_md5(struct x3p *x3p, const char *name, const char *text, struct error *err) {
    uint8_t digest[MD5_DIGEST_SIZE];
    md5_digest(&x3p->md5, sizeof digest, digest);
    for (int digit = 0; digit < 2 * MD5_DIGEST_SIZE; digit++)
        if (digit_of(text[digit]) !=
            (digit % 2 == 0 ? digest[digit / 2] >> 4 : digest[digit / 2] & 15))
            return error_set(err, ERROR_INPUT,
                             "%s is damaged: its MD5 checksum is not the one in the file, "
                             "%.32s",
                             name, text);
    return 0;
}

/* --- entries --- */

/* Finds the entry that a link of main.xml names, relative to main.xml. */
static int find_linked(const struct x3p *x3p, const char *link, size_t *entry, struct error *err) {
    char name[2 * X3P_TEXT];
    int length = snprintf(name, sizeof name, "%.*s%s", x3p->folder_length, x3p->folder, link);
    if (length > 0 && (size_t)length < sizeof name && zip_archive_find(x3p->zip, name, entry))
        return 0;
    return error_set(err, ERROR_INPUT,
                     "there is no file %.80s in the archive, which main.xml names", link);
}

static int find_main(struct x3p *x3p, size_t *entry, struct error *err) {
    static const char MAIN[] = "main.xml";
    size_t count = zip_archive_entries(x3p->zip);
    bool found = false;
    for (size_t at = 0; at < count; at++) {
        const char *name = zip_archive_name(x3p->zip, at);
        size_t length = strlen(name), tail = sizeof MAIN - 1;
        if (length < tail || length > X3P_TEXT || strcmp(name + length - tail, MAIN) != 0 ||
            (length > tail && strchr("/\\", name[length - tail - 1]) == NULL) ||
            (found && length - tail >= (size_t)x3p->folder_length))
            continue;
        found = true;
        *entry = at;
        x3p->folder = name;
        x3p->folder_length = (int)(length - tail);
    }
    if (found)
        return 0;
    return error_set(err, ERROR_INPUT,
                     "this zip archive holds no main.xml, as X3P files do, and no .npy, as NPZ "
                     "files do");
}

/* Layers have no names, only numbers from 1. */
static int choose_layer(const struct x3p *x3p, size_t *layer, struct error *err) {
    const char *asked = x3p->request != NULL ? x3p->request->layer : NULL;
    char *stop;
    *layer = 0;
    if (asked == NULL)
        return 0;
    unsigned long long number = strtoull(asked, &stop, 10);
    if (*asked < '0' || *asked > '9' || *stop != '\0' || number == 0 || number > x3p->layout.layers)
        return error_set(
            err, ERROR_INPUT,
            "there is no layer '%.40s'; allowed: 1 to %zu, layers of X3P have no names", asked,
            x3p->layout.layers);
    *layer = (size_t)number - 1;
    return 0;
}

/* Allocates the points once the fields before them are known. */
static int begin_points(struct x3p *x3p, const struct x3p_fields *fields, size_t most,
                        struct error *err) {
    size_t layer = 0;
    int status = x3p_layout_read(&x3p->layout, fields, most, err);
    if (status == 0)
        status = choose_layer(x3p, &layer, err);
    if (status == 0)
        status = x3p_points_create(&x3p->points, &x3p->layout, layer, err);
    if (status == 0 && x3p->request != NULL)
        layer_say(x3p->request->layer_read, NULL, layer, x3p->layout.layers);
    return status;
}

/* --- main.xml --- */

static int take_datum(void *context, const struct x3p_fields *fields, const char *text,
                      struct error *err) {
    struct x3p *x3p = context;
    int status = 0;
    if (x3p->points == NULL)
        status = begin_points(x3p, fields, x3p->listed_most, err);
    return status == 0 ? x3p_points_take_text(x3p->points, text, err) : status;
}

static int take_xml(void *context, const char *bytes, size_t count, struct error *err) {
    struct x3p *x3p = context;
    md5_update(&x3p->md5, count, (const uint8_t *)bytes);
    return x3p_xml_feed(x3p->xml, bytes, count, false, err);
}

/* The checksum of main.xml is in a file beside it, which Record4 names. Without that file the CRC
 * of the archive is the only check. */
static int check_main(struct x3p *x3p, struct error *err) {
    const char *link = x3p->fields.text[X3P_CHECKSUM_LINK];
    char text[2 * MD5_DIGEST_SIZE + 1] = "";
    size_t entry = 0, size = sizeof text - 1;
    if (*link == '\0' || find_linked(x3p, link, &entry, NULL) != 0)
        return 0;
    int status = zip_archive_peek(x3p->zip, entry, text, &size, err);
    return status == 0 ? check_md5(x3p, "main.xml", text, err) : status;
}

static int read_main(struct x3p *x3p, struct error *err) {
    static const size_t SHORTEST = sizeof "<Datum/>" - 1;
    size_t entry = 0, size = 0;
    int status = find_main(x3p, &entry, err);
    if (status == 0)
        status = zip_archive_size(x3p->zip, entry, &size, err);
    x3p->listed_most = size / SHORTEST;
    if (status == 0)
        status = x3p_xml_create(&x3p->xml, &x3p->fields, take_datum, x3p, err);
    md5_init(&x3p->md5);
    if (status == 0)
        status = zip_archive_unpack(x3p->zip, entry, take_xml, x3p, err);
    if (status == 0)
        status = x3p_xml_feed(x3p->xml, "", 0, true, err);
    return status == 0 ? check_main(x3p, err) : status;
}

/* --- binary files --- */

static int take_binary(void *context, const char *bytes, size_t count, struct error *err) {
    struct x3p *x3p = context;
    md5_update(&x3p->md5, count, (const uint8_t *)bytes);
    return x3p_points_take_binary(x3p->points, bytes, count, err);
}

static int take_valid(void *context, const char *bytes, size_t count, struct error *err) {
    struct x3p *x3p = context;
    md5_update(&x3p->md5, count, (const uint8_t *)bytes);
    return x3p_points_take_valid(x3p->points, bytes, count, err);
}

/* Unpacks the entry of a link, which must have `size` bytes; the field after the link is its
 * checksum. */
static int read_linked(struct x3p *x3p, int link, size_t entry, size_t has, size_t size,
                       zip_archive_take *take, struct error *err) {
    const char *name = x3p->fields.text[link], *sum = x3p->fields.text[link + 1];
    if (has != size)
        return error_set(err, ERROR_INPUT,
                         "%.80s has %zu bytes; allowed: %zu, for the %zu points that Record3 says",
                         name, has, size, x3p->layout.n);
    md5_init(&x3p->md5);
    int status = zip_archive_unpack(x3p->zip, entry, take, x3p, err);
    return status == 0 && *sum != '\0' ? check_md5(x3p, name, sum, err) : status;
}

static int read_points(struct x3p *x3p, struct error *err) {
    size_t entry = 0, has = 0;
    int status = find_linked(x3p, x3p->fields.text[X3P_POINTS_LINK], &entry, err);
    if (status == 0)
        status = zip_archive_size(x3p->zip, entry, &has, err);
    if (status == 0)
        status = begin_points(x3p, &x3p->fields, has / 2, err);
    if (status != 0)
        return status;
    return read_linked(x3p, X3P_POINTS_LINK, entry, has, x3p->layout.n * x3p->layout.record,
                       take_binary, err);
}

static int read_valid(struct x3p *x3p, struct error *err) {
    size_t entry = 0, has = 0;
    int status = find_linked(x3p, x3p->fields.text[X3P_VALID_LINK], &entry, err);
    if (status == 0)
        status = zip_archive_size(x3p->zip, entry, &has, err);
    if (status == 0)
        status =
            read_linked(x3p, X3P_VALID_LINK, entry, has, (x3p->layout.n + 7) / 8, take_valid, err);
    return status;
}

static int read_all(struct x3p *x3p, struct height_map *out, struct error *err) {
    int status = read_main(x3p, err);
    if (status != 0)
        return status;
    bool listed = x3p->points != NULL, linked = *x3p->fields.text[X3P_POINTS_LINK] != '\0';
    if (listed == linked)
        return error_set(
            err, ERROR_INPUT,
            "Record3 of main.xml has %s a DataList and a DataLink; allowed: one of them",
            listed ? "both" : "neither");
    if (linked)
        status = read_points(x3p, err);
    if (status == 0 && linked && *x3p->fields.text[X3P_VALID_LINK] != '\0')
        status = read_valid(x3p, err);
    return status == 0 ? x3p_points_map(x3p->points, out, err) : status;
}

static int x3p_read(struct height_map *out, const char *data, size_t size,
                    const struct instrument_request *request, struct error *err) {
    struct x3p x3p = {.request = request};
    int status = zip_archive_open(&x3p.zip, data, size, err);
    if (status == 0)
        status = read_all(&x3p, out, err);
    x3p_points_destroy(&x3p.points);
    x3p_xml_destroy(&x3p.xml);
    zip_archive_close(&x3p.zip);
    return status;
}

const struct instrument_format INSTRUMENT_X3P = {"x3p", "x3p", zip_archive_begins, x3p_read};

#include "tests/support/x3p_file.h"
#include "tests/support/zip_file.h"
#include <nettle/md5.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

const struct x3p_sheet X3P_USUAL = {
    .head = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n",
    .root = "p:ISO5436_2",
    .feature = "SUR",
    .x = X3P_INCREMENTAL("2e-6"),
    .y = X3P_INCREMENTAL("3e-6"),
    .z = "<AxisType>A</AxisType><DataType>D</DataType>",
    .rotation = "",
    .dimension = X3P_MATRIX("3", "2", "1"),
    .tail = "",
    .folder = "",
};

void x3p_file_md5(char out[33], const void *data, size_t size) {
    struct md5_ctx md5;
    uint8_t digest[MD5_DIGEST_SIZE];
    md5_init(&md5);
    md5_update(&md5, size, data);
    md5_digest(&md5, sizeof digest, digest);
    for (size_t byte = 0; byte < sizeof digest; byte++)
        snprintf(out + 2 * byte, 3, "%02X", digest[byte]);
}

static const char *either(const char *text, const char *otherwise) {
    return text != NULL ? text : otherwise;
}

/* The elements that link to binary files. */
static void print_links(char *out, size_t size, const struct x3p_sheet *sheet) {
    char sum[33], valid_sum[33];
    x3p_file_md5(sum, sheet->points, sheet->size);
    int length = snprintf(out, size,
                          "<DataLink><PointDataLink>bindata/data.bin</PointDataLink>"
                          "<MD5ChecksumPointData>%s</MD5ChecksumPointData>",
                          sum);
    if (sheet->valid != NULL) {
        x3p_file_md5(valid_sum, sheet->valid, sheet->valid_size);
        length += snprintf(out + length, size - (size_t)length,
                           "<ValidPointsLink>bindata/valid.bin</ValidPointsLink>"
                           "<MD5ChecksumValidPoints>%s</MD5ChecksumValidPoints>",
                           valid_sum);
    }
    snprintf(out + length, size - (size_t)length, "</DataLink>");
}

size_t x3p_sheet_print(char *out, const struct x3p_sheet *sheet) {
    const struct x3p_sheet *usual = &X3P_USUAL;
    const char *root = either(sheet->root, usual->root);
    char links[1000] = "";
    if (sheet->data == NULL)
        print_links(links, sizeof links, sheet);
    int length = snprintf(
        out, X3P_SHEET_MOST,
        "%s<%s xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\">\n <Record1>"
        "<Revision>ISO5436 - 2000</Revision><FeatureType>%s</FeatureType>\n"
        "  <Axes><CX>%s</CX><CY>%s</CY><CZ>%s</CZ>%s</Axes></Record1>\n"
        " <Record2><Date>2026-01-01T00:00:00</Date><!-- nobody --></Record2>\n"
        " <Record3>%s%s</Record3>\n"
        " <Record4><ChecksumFile>md5checksum.hex</ChecksumFile></Record4>%s\n</%s>\n",
        either(sheet->head, usual->head), root, either(sheet->feature, usual->feature),
        either(sheet->x, usual->x), either(sheet->y, usual->y), either(sheet->z, usual->z),
        either(sheet->rotation, usual->rotation), either(sheet->dimension, usual->dimension),
        either(sheet->data, links), either(sheet->tail, usual->tail), root);
    assert_true(length > 0 && length < X3P_SHEET_MOST);
    return (size_t)length;
}

char *x3p_file_create(const struct x3p_sheet *sheet, size_t *size) {
    static const char *const NAMES[] = {"bindata/data.bin", "bindata/valid.bin", "main.xml",
                                        "md5checksum.hex"};
    char names[4][300], sum[64], *xml = malloc(X3P_SHEET_MOST);
    struct zip_part parts[4];
    size_t count = 0;
    assert_non_null(xml);
    size_t length = x3p_sheet_print(xml, sheet);
    x3p_file_md5(sum, xml, length);
    snprintf(sum + 32, sizeof sum - 32, " *main.xml\n");
    const char *told = either(sheet->sum, sum);
    const struct zip_part all[] = {{NULL, sheet->points, sheet->size, sheet->stored},
                                   {NULL, sheet->valid, sheet->valid_size, sheet->stored},
                                   {NULL, xml, length, sheet->stored},
                                   {NULL, told, strlen(told), true}};
    for (size_t part = 0; part < 4; part++) {
        if (all[part].data == NULL)
            continue;
        snprintf(names[count], sizeof names[count], "%s%s", either(sheet->folder, X3P_USUAL.folder),
                 NAMES[part]);
        parts[count] = all[part];
        parts[count].name = names[count];
        count++;
    }
    char *out = zip_file_create(parts, count, size);
    free(xml);
    return out;
}

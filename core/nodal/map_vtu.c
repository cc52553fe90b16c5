#include "core/nodal/map_vtu.h"
#include <errno.h>
#include <nettle/base64.h>
#include <stdint.h>
#include <string.h>

enum { VTK_LINE = 3, VTK_QUAD = 9 };

/* An array that is written as base64. */
struct base64_stream {
    FILE *file;
    struct base64_encode_ctx context;
};

/* Puts one number. */
static void stream_put(struct base64_stream *stream, const void *data, size_t size) {
    char text[BASE64_ENCODE_LENGTH(sizeof(double))];
    fwrite(text, 1, base64_encode_update(&stream->context, text, size, data), stream->file);
}

static void put_number(struct base64_stream *stream, double value) {
    stream_put(stream, &value, sizeof value);
}

static void put_index(struct base64_stream *stream, size_t value) {
    int64_t number = (int64_t)value;
    stream_put(stream, &number, sizeof number);
}

/* The header of an array is the number of its bytes. */
static struct base64_stream array_open(FILE *file, const char *type, const char *name,
                                       int components, size_t bytes) {
    struct base64_stream stream = {.file = file};
    uint64_t size = bytes;
    fprintf(file,
            "        <DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" "
            "format=\"binary\">\n",
            type, name, components);
    base64_encode_init(&stream.context);
    stream_put(&stream, &size, sizeof size);
    return stream;
}

static void array_close(struct base64_stream *stream) {
    char text[BASE64_ENCODE_FINAL_LENGTH];
    fwrite(text, 1, base64_encode_final(&stream->context, text), stream->file);
    fputs("\n        </DataArray>\n", stream->file);
}

static void write_points(FILE *file, const struct grid *grid, const double *z) {
    bool profile = grid_is_profile(grid);
    struct base64_stream stream =
        array_open(file, "Float64", "Points", 3, 3 * sizeof(double) * grid_points(grid));
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++) {
            double height = z[j * grid->nx + i];
            put_number(&stream, (double)i * grid_dx(grid));
            put_number(&stream, profile ? height : (double)j * grid_dy(grid));
            put_number(&stream, profile ? 0 : height);
        }
    array_close(&stream);
}

static void write_corners(FILE *file, const struct grid *grid, size_t cells) {
    size_t nx = grid->nx, corners = grid_is_profile(grid) ? 2 : 4;
    struct base64_stream stream =
        array_open(file, "Int64", "connectivity", 1, cells * corners * sizeof(int64_t));
    for (size_t c = 0; c < cells; c++) {
        size_t first = c / (nx - 1) * nx + c % (nx - 1);
        put_index(&stream, first);
        put_index(&stream, first + 1);
        if (corners == 4) {
            put_index(&stream, first + nx + 1);
            put_index(&stream, first + nx);
        }
    }
    array_close(&stream);
}

static void write_cells(FILE *file, const struct grid *grid, size_t cells) {
    size_t corners = grid_is_profile(grid) ? 2 : 4;
    const unsigned char type = corners == 2 ? VTK_LINE : VTK_QUAD;
    write_corners(file, grid, cells);
    struct base64_stream stream = array_open(file, "Int64", "offsets", 1, cells * sizeof(int64_t));
    for (size_t c = 1; c <= cells; c++)
        put_index(&stream, c * corners);
    array_close(&stream);
    stream = array_open(file, "UInt8", "types", 1, cells);
    for (size_t c = 0; c < cells; c++)
        stream_put(&stream, &type, 1);
    array_close(&stream);
}

/* A comment holds no "--". */
static void put_title(FILE *file, const char *title) {
    char last = '\0';
    for (; *title != '\0'; title++)
        if ((unsigned char)*title >= ' ' && !(*title == '-' && last == '-')) {
            last = *title;
            fputc(last, file);
        }
}

int map_vtu(FILE *file, const char *title, const struct grid *grid, const double *z,
            size_t field_count, const struct map_field *fields, struct error *err) {
    static const uint16_t ONE = 1;
    size_t cells = (grid->nx - 1) * (grid_is_profile(grid) ? 1 : grid->ny - 1);
    bool little = *(const unsigned char *)&ONE == 1;
    errno = 0;
    fputs("<?xml version=\"1.0\"?>\n<!-- ", file);
    put_title(file, title);
    fprintf(file,
            " -->\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"%s\" "
            "header_type=\"UInt64\">\n  <UnstructuredGrid>\n"
            "    <Piece NumberOfPoints=\"%zu\" NumberOfCells=\"%zu\">\n      <Points>\n",
            little ? "LittleEndian" : "BigEndian", grid_points(grid), cells);
    write_points(file, grid, z);
    fputs("      </Points>\n      <Cells>\n", file);
    write_cells(file, grid, cells);
    fputs("      </Cells>\n      <PointData>\n", file);
    for (size_t f = 0; f < field_count; f++) {
        struct base64_stream stream =
            array_open(file, "Float64", fields[f].name, 1, sizeof(double) * grid_points(grid));
        for (size_t i = 0; i < grid_points(grid); i++)
            put_number(&stream, fields[f].values[i]);
        array_close(&stream);
    }
    fputs("      </PointData>\n    </Piece>\n  </UnstructuredGrid>\n</VTKFile>\n", file);
    if (fflush(file) != 0 || ferror(file) != 0)
        return error_set(err, ERROR_SYSTEM, "cannot write the map: %s", strerror(errno));
    return 0;
}

/* Protects: plain columns of numbers are taken for what they are, a trace, a list of points or a
 * map, or are asked back with the option that decides; traces keep their heights where their
 * positions are even, are resampled within a bound of the interpolation where they are not, and say
 * so; heads and units of instruments' exports are understood. */
#include "tests/support/instrument_files.h"

struct reading {
    struct height_map map;
    struct error err;
    char done[INSTRUMENT_DONE];
    int status;
};

static struct reading read_as(const char *name, const char *text, enum instrument_columns columns) {
    struct reading reading = {.status = 0};
    struct bytes bytes = bytes_of_text(text);
    const struct instrument_request request = {.columns = columns, .done = reading.done};
    reading.status = instrument_read(&reading.map, name, bytes.data, bytes.size, 0, &request, NULL,
                                     &reading.err);
    free(bytes.data);
    return reading;
}

/* Returns the numbers of the first line, which stand between blanks. */
static size_t text_columns(const char *text) {
    size_t columns = 1;
    for (; *text != '\n'; text++)
        columns += *text == ' ' ? 1 : 0;
    return columns;
}

static void expect_shape(const char *text, enum instrument_columns columns, size_t nx, size_t ny) {
    struct reading reading = read_as("a.csv", text, columns);
    if (reading.status != 0 || reading.map.grid.nx != nx || reading.map.grid.ny != ny)
        fail_msg("%s: %zu x %zu, not %zu x %zu: %s", text, reading.map.grid.nx, reading.map.grid.ny,
                 nx, ny, reading.err.text);
    /* What is no map of the rows of the file is said. */
    const bool map = text_columns(text) == nx;
    if ((*reading.done == '\0') != map)
        fail_msg("%s: '%s'", text, reading.done);
    height_map_clear(&reading.map);
}

static void expect_refusal(const char *text, enum instrument_columns columns, const char *words) {
    struct reading reading = read_as("a.csv", text, columns);
    if (reading.status != ERROR_INPUT || strstr(reading.err.text, words) == NULL ||
        reading.map.z != NULL)
        fail_msg("%s: status %d, '%s', not '%s'", text, reading.status, reading.err.text, words);
}

static const char EVEN_TRACE[] = "0 5\n0.5 3\n1 4\n1.5 1\n2 2\n";
static const char RISING[] = "0 5\n1 3\n5 4\n7 1\n8 2\n";
static const char LIST[] = "0 0 3\n1 0 1\n2 0 4\n3 0 1\n0 1 5\n1 1 9\n2 1 2\n3 1 6\n";
static const char NEITHER[] = "3 1 4\n1 5 9\n2 6 5\n3 5 8\n";

static void columns_are_chosen(void **state) {
    (void)state;
    expect_shape(EVEN_TRACE, COLUMNS_AUTO, 5, 1);
    /* Eight rows that rise throughout are no heights by accident. */
    expect_shape("0 5\n1 3\n5 4\n7 1\n8 2\n9 3\n12 1\n13 0\n", COLUMNS_AUTO, 8, 1);
    expect_shape("13 5\n12 3\n9 4\n8 1\n7 2\n5 3\n2 1\n0 0\n", COLUMNS_AUTO, 8, 1);
    expect_shape(LIST, COLUMNS_AUTO, 4, 2);
    /* Maps: too few rows, up and down, positions with a hole, other numbers of columns. */
    expect_shape("0 5\n1 3\n2 4\n", COLUMNS_AUTO, 2, 3);
    expect_shape("3 5\n1 3\n2 4\n1 1\n2 2\n", COLUMNS_AUTO, 2, 5);
    expect_shape("0 5\nnan 3\n1 4\n1.5 1\n2 2\n", COLUMNS_AUTO, 2, 5);
    expect_shape("3 1 4\n1 5 9\n2 nan 5\n3 5 8\n", COLUMNS_AUTO, 3, 4);
    expect_shape("0 1 2 3\n1 2 3 4\n2 3 4 5\n3 4 5 6\n", COLUMNS_AUTO, 4, 4);
    /* The option decides, also against the evidence. */
    expect_shape(EVEN_TRACE, COLUMNS_MAP, 2, 5);
    expect_shape(LIST, COLUMNS_MAP, 3, 8);
    expect_shape(RISING, COLUMNS_XZ, 5, 1);
    expect_shape(NEITHER, COLUMNS_MAP, 3, 4);
}

static void doubt_is_asked_back(void **state) {
    (void)state;
    expect_refusal(
        RISING, COLUMNS_AUTO,
        "5 rows of 2 numbers are either positions and heights of a trace or a map of 2 x "
        "5 heights; --columns xz or --columns map says which");
    /* Both columns rise throughout: a tilted trace or a tilted map. */
    expect_refusal("0 0\n1 1\n2 3\n4 4\n5 6\n7 7\n9 8\n12 9\n", COLUMNS_AUTO, "--columns xz");
    /* One position is lower than the last: a trace with a fault, or heights. */
    expect_refusal("0 0\n1 1\n2 0\n4 1\n5 0\n7 1\n6.5 0\n12 1\n", COLUMNS_AUTO, "--columns xz");
    expect_refusal(NEITHER, COLUMNS_AUTO,
                   "4 rows of 3 numbers are either points x y z or a map of "
                   "3 x 4 heights; --columns xyz or --columns map");
    expect_refusal("0 1\n0 2\n1 3\n2 4\n", COLUMNS_XZ, "x = 0 has two heights, 1 and 2");
    expect_refusal("0 1\n2 2\n", COLUMNS_XZ, "2 rows; a trace has at least 3");
    expect_refusal("0 1\nnan 2\n1 3\n2 4\n", COLUMNS_XZ, "row 2 has no finite position");
    expect_refusal("0 1\n1 2\n", COLUMNS_XYZ, "--columns xyz needs 3 numbers a row, not 2");
    expect_refusal("0 1 2\n1 5.37 7\n3.141 2 2\n8 1.777 2\n", COLUMNS_XYZ, "no regular grid");
    expect_refusal("0 nan\n1 2\n2.7 nan\n3 nan\n", COLUMNS_XZ, "1 of 4 positions have heights");
}

/* What pandas writes, with and without its index: numbers of rows and columns are no heights. A row
 * or column of heights that happens to be such is a slope, and those beside it are, too. */
static void numbered_rows_and_columns_are_refused(void **state) {
    (void)state;
    static const char WITH_INDEX[] =
        ",0,1,2\n0,1e-7,3e-7,2e-7\n1,4e-7,1e-7,5e-7\n2,9e-7,2e-7,6e-7\n";
    static const char WITHOUT[] = "0,1,2,3\n1e-7,3e-7,2e-7,4e-7\n4e-7,1e-7,5e-7,2e-7\n";
    expect_refusal(
        WITH_INDEX, COLUMNS_AUTO,
        "the first row of the numbers, 0 to 2, numbers the columns, and the first column "
        "the rows; allowed: heights alone");
    expect_refusal(WITHOUT, COLUMNS_AUTO, "row of the numbers, 0 to 3, numbers the columns;");
    expect_refusal("1;2;3;4\n1,5;3;2;4\n4;1;5;2,5\n", COLUMNS_AUTO, "1 to 4, numbers the columns");
    /* Columns of positions, rows of numbers; a tilt of small heights; a column of a table. */
    expect_refusal(",0.0,0.5,1.0\n0,3,1,2\n1,1,2,1\n2,5,1,3\n", COLUMNS_AUTO,
                   "the first column of the numbers, 0 to 2, numbers the rows;");
    expect_refusal("0,1,2,3\n1e-7,2e-7,3e-7,4e-7\n4e-7,5e-7,6e-7,7e-7\n", COLUMNS_AUTO, "0 to 3");
    expect_refusal(",0\n0,0.5\n1,0.3\n2,0.4\n", COLUMNS_AUTO, "column of the numbers, 0 to 2");
    /* The option decides; heights stay heights. */
    const char *const heights[] = {"0 1 2 3\n1 2 3 4\n2 3 4 5\n",
                                   "0 1 2 3\n0 1 2 3\n0 1 2 3\n",
                                   "0 1 2 4\n3 1 2 3\n1 1 2 2\n",
                                   "0 1 2 3\n5 1 2 3\n",
                                   "nan 1 2 3\n1 2 3 4\n2 3 4 5\n3 4 5 6\n",
                                   "2 3 4 5\n3 1 4 1\n1 2 2 1\n"};
    for (size_t h = 0; h < sizeof heights / sizeof *heights; h++) {
        struct reading reading = read_as("a.csv", heights[h], COLUMNS_AUTO);
        if (reading.status != 0 || reading.map.grid.nx != 4)
            fail_msg("%s: %s", heights[h], reading.err.text);
        height_map_clear(&reading.map);
    }
    struct reading reading = read_as("a.csv", WITHOUT, COLUMNS_MAP);
    assert_true(reading.status == 0 && reading.map.grid.ny == 3 && reading.map.z[1] == 1);
    height_map_clear(&reading.map);
}

/* Rows of N heights, as "%.3f" with a decimal comma or another format, behind a header. */
static const char *comma_column(const char *header, const char *format, int n) {
    static char text[2000];
    size_t used = (size_t)snprintf(text, sizeof text, "%s", header);
    for (int i = 0; i < n; i++) {
        char number[32];
        snprintf(number, sizeof number, format, 3 * sin(1.7 * i) + 0.05 * (i % 2));
        char *point = strchr(number, '.');
        *(point != NULL ? point : number) = ',';
        used += (size_t)snprintf(text + used, sizeof text - used, "%s\r\n", number);
    }
    return text;
}

/* One column with decimal commas is one, where leading zeros show it, and asked about where not. */
static void decimal_commas_make_one_column(void **state) {
    (void)state;
    static const char *const HEADERS[] = {"", "# dx: 0.5 um\n# z unit: um\n", "# a profile\n\n"};
    for (size_t h = 0; h < 3; h++) {
        const double metres = h == 1 ? 1e-6 : 1;
        struct reading reading =
            read_as("a.csv", comma_column(HEADERS[h], "%.3f", 40), COLUMNS_AUTO);
        if (reading.status != 0 || reading.map.grid.nx != 40 || reading.map.grid.ny != 1)
            fail_msg("%zu: %zu x %zu, %s", h, reading.map.grid.nx, reading.map.grid.ny,
                     reading.err.text);
        assert_string_equal(reading.done, "z, 40 rows with decimal commas");
        assert_true(fabs(grid_dx(&reading.map.grid) / (h == 1 ? 5e-7 : 1) - 1) <= 1e-12);
        for (int i = 0; i < 40; i++) /* a printed height is off by half of its last digit */
            assert_true(fabs(reading.map.z[i] / metres - 3 * sin(1.7 * i) - 0.05 * (i % 2)) <=
                        0.0005001);
        height_map_clear(&reading.map);
    }
    /* One digit behind each comma, which has no leading zero, of positive numbers. */
    static const char OPEN[] = "1,5\n2,1\n1,7\n3,4\n2,2\n1,9\n2,0\n1,1\n";
    expect_refusal(OPEN, COLUMNS_AUTO,
                   "8 rows of digits, a comma and digits are either one height");
    expect_refusal("1,05\n2,1\n1,7\n3,4\n2,2\n1,9\n2,0\n1,1\n", COLUMNS_AUTO,
                   "points in place of the commas, or --columns xz or --columns map");
    struct reading reading = read_as("a.csv", OPEN, COLUMNS_MAP);
    assert_true(reading.status == 0 && reading.map.grid.nx == 2 && reading.map.grid.ny == 8);
    height_map_clear(&reading.map);
    /* Two numbers: fewer rows, positions that rise evenly, other forms, columns that are named. */
    static const struct {
        const char *text;
        size_t nx, ny;
    } TWO[] = {
        {"1,05\n2,01\n1,07\n3,04\n2,02\n1,09\n2,00\n", 2, 7},
        {"0,5\n1,1\n2,7\n3,4\n4,2\n5,9\n6,0\n7,1\n", 8, 1},
        {"1,05\n2,01\n1,07\n3,04\n2,02\n1,09\n2,00\n1,-1\n", 2, 8},
        {"1,05\n2,01\n1,07\n3,04\n2,02\n1,09\n2,00\n1,5e1\n", 2, 8},
        {"1,05\n2,01\n1,07\n3,04\n2,02\n1,09\n2,00\n1.0,5\n", 2, 8},
        {"x,z\n0,05\n1,01\n2,07\n3,04\n4,02\n5,09\n6,00\n7,01\n", 8, 1},
    };
    for (size_t t = 0; t < sizeof TWO / sizeof *TWO; t++) {
        reading = read_as("a.csv", TWO[t].text, COLUMNS_AUTO);
        if (reading.status != 0 || reading.map.grid.nx != TWO[t].nx ||
            reading.map.grid.ny != TWO[t].ny)
            fail_msg("%s: %zu x %zu, %s", TWO[t].text, reading.map.grid.nx, reading.map.grid.ny,
                     reading.err.text);
        height_map_clear(&reading.map);
    }
}

/* A format that names its own shape leaves the option nothing to decide. */
static void other_formats_refuse(void **state) {
    (void)state;
    struct bytes bytes = bytes_of_fixture("gwyddion.gwy");
    const struct instrument_request request = {.columns = COLUMNS_XZ};
    struct height_map map = {.z = NULL};
    struct error err = {0};
    assert_int_equal(
        instrument_read(&map, "a.gwy", bytes.data, bytes.size, 0, &request, NULL, &err),
        ERROR_INPUT);
    assert_non_null(strstr(err.text, "a gwy file says what it holds"));
    free(bytes.data);
}

/* Positions printed with one digit at steps of 0.1562, as profilometers do: even, so that the
 * heights are those of the file bit for bit. In falling order they are turned. */
static void even_positions_keep_heights(void **state) {
    (void)state;
    enum { N = 400 };
    static char text[N * 32];
    for (int falling = 0; falling < 2; falling++) {
        size_t used = 0;
        for (int p = 0; p < N; p++) {
            int i = falling ? N - 1 - p : p;
            used += (size_t)snprintf(text + used, sizeof text - used, "%.1f %.17g\n", 0.1562 * i,
                                     sin(i) / 3);
        }
        struct reading reading = read_as("a.txt", text, COLUMNS_AUTO);
        assert_int_equal(reading.status, 0);
        assert_string_equal(reading.done, "x z, 400 rows at even positions");
        assert_true(reading.map.grid.nx == N && reading.map.grid.ny == 1);
        /* The slope of N positions, each rounded by 0.05 at most, is within 6 * 0.05 / N^2. */
        assert_true(fabs(grid_dx(&reading.map.grid) - 0.1562) <= 0.3 / N);
        for (int i = 0; i < N; i++)
            assert_true(reading.map.z[i] == sin(i) / 3);
        height_map_clear(&reading.map);
    }
}

/* A tenth of even positions may be missing, which makes holes; of more, the rest is resampled. */
static void missing_positions_are_holes(void **state) {
    (void)state;
    char text[400] = "";
    size_t used = 0;
    for (int i = 0; i < 30; i++)
        if (i != 7 && i != 20)
            used += (size_t)snprintf(text + used, sizeof text - used, "%g %d\n", 0.25 * i, i % 5);
    struct reading reading = read_as("a.txt", text, COLUMNS_AUTO);
    assert_int_equal(reading.status, 0);
    assert_string_equal(reading.done, "x z, 28 rows at even positions, 2 of which are missing");
    assert_int_equal(reading.map.grid.nx, 30);
    assert_true(fabs(grid_dx(&reading.map.grid) - 0.25) <= 1e-15);
    for (int i = 0; i < 30; i++)
        assert_true(i == 7 || i == 20 ? isnan(reading.map.z[i]) : reading.map.z[i] == i % 5);
    height_map_clear(&reading.map);
}

/* Uneven positions of a sine. A slope of Steffen's cubics is off by |z''| h at most, where it is
 * set to 0 at an extreme, and so a height by |z''| h^2/4, with |z''| <= 0.01 and gaps h of at
 * most 1.46: 0.0053. Nodes taken for the nearest rows would be off by 0.1 * 0.25 = 0.025. */
static void uneven_positions_are_resampled(void **state) {
    (void)state;
    enum { N = 200 };
    char text[N * 32];
    size_t used = 0;
    double last = 0;
    for (int i = 0; i < N; i++) {
        last = i + 0.25 * sin(2.3 * i);
        used +=
            (size_t)snprintf(text + used, sizeof text - used, "%.6f %.9f\n", last, sin(0.1 * last));
    }
    struct reading reading = read_as("a.txt", text, COLUMNS_AUTO);
    assert_int_equal(reading.status, 0);
    assert_non_null(strstr(reading.done, "x z, 200 rows at uneven positions"));
    assert_non_null(strstr(reading.done, "resampled at it by monotone cubics"));
    const double dx = grid_dx(&reading.map.grid);
    assert_int_equal(reading.map.grid.nx, N);
    assert_true(fabs(dx * (N - 1) - last) <= 1e-5);
    double worst = 0;
    for (int i = 0; i < N; i++)
        worst = fmax(worst, fabs(reading.map.z[i] - sin(0.1 * i * dx)));
    if (!(worst <= 0.0053 && worst > 0))
        fail_msg("off by %g", worst);
    height_map_clear(&reading.map);
}

/* Nothing is invented beside a height that is missing. */
static void holes_are_not_bridged(void **state) {
    (void)state;
    struct reading reading =
        read_as("a.txt", "0 0\n1 1\n2.5 nan\n3 3\n4.2 4\n5 5\n5.5 6\n7 7\n", COLUMNS_XZ);
    assert_int_equal(reading.status, 0);
    for (int i = 0; i < 8; i++) /* at 0 1 2 3 4 5 6 7 */
        assert_true(isnan(reading.map.z[i]) == (i == 2));
    assert_true(reading.map.z[1] == 1 && reading.map.z[3] == 3 && reading.map.z[7] == 7);
    height_map_clear(&reading.map);
}

/* A trace of five rows in units of a head. */
struct head {
    const char *text;
    double x_metres, z_metres; /* 1 where the unit is unknown */
    const char *x_unit, *z_unit;
};

static void heads_are_understood(void **state) {
    (void)state;
    const struct head heads[] = {
        {"X_(microns),Z_(angstroms)\n", 1e-6, 1e-10, "m", "m"},
        {"X_(microns),y1\n", 1e-6, 1, "m", ""},
        {"x in \xc2\xb5m, y in \xc2\xb5m\n", 1e-6, 1e-6, "m", "m"},
        {"\xc2\xb5m  nm\n", 1e-6, 1e-9, "m", "m"},
        {"\xc2\xb5m  nm\n5\n", 1e-6, 1e-9, "m", "m"}, /* the number of rows */
        {"X;Z\nmm;\xc2\xb5m\n", 1e-3, 1e-6, "m", "m"},
        {"Duration,32 sec\n\nScan Data\nLateral um,Raw Micrometers,\n", 1e-6, 1e-6, "m", "m"},
        {"X (mils),Z (microinches)\n", 2.54e-5, 2.54e-8, "m", "m"},
        {"Distance [mm]\tHeight [\xc3\x85]\n", 1e-3, 1e-10, "m", "m"},
        {"Position/inch Height/\xc3\xa5ngstr\xc3\xb6m\n", 0.0254, 1e-10, "m", "m"},
        {"# x z\n", 1, 1, "", ""},
    };
    for (size_t h = 0; h < sizeof heads / sizeof *heads; h++) {
        const struct head *head = &heads[h];
        const char mark = strchr(head->text, ',') != NULL    ? ','
                          : strchr(head->text, ';') != NULL  ? ';'
                          : strchr(head->text, '\t') != NULL ? '\t'
                                                             : ' ';
        char text[400];
        size_t used = (size_t)snprintf(text, sizeof text, "%s", head->text);
        for (int i = 0; i < 5; i++)
            used += (size_t)snprintf(text + used, sizeof text - used, "%g%c%d%s\n", 10 + 0.5 * i,
                                     mark, i * i, strstr(head->text, "Raw") != NULL ? ",," : "");
        struct reading reading = read_as("a.csv", text, COLUMNS_AUTO);
        if (reading.status != 0 || reading.map.grid.nx != 5)
            fail_msg("%s: %s", text, reading.err.text);
        assert_string_equal(reading.done, "x z, 5 rows at even positions");
        assert_string_equal(reading.map.xy_unit, head->x_unit);
        assert_string_equal(reading.map.z_unit, head->z_unit);
        assert_true(fabs(grid_dx(&reading.map.grid) / (0.5 * head->x_metres) - 1) <= 1e-12);
        assert_true(fabs(reading.map.z[4] / (16 * head->z_metres) - 1) <= 1e-12);
        height_map_clear(&reading.map);
    }
}

/* An index, and heights that other columns stand beside. */
static void columns_stand_among_others(void **state) {
    (void)state;
    struct reading reading =
        read_as("a.csv", "index,x in um,y in nm\n0,5,1\n1,5.5,4\n2,6,9\n3,6.5,16\n", COLUMNS_AUTO);
    assert_int_equal(reading.status, 0);
    assert_true(reading.map.grid.nx == 4 && fabs(reading.map.z[3] - 16e-9) <= 1e-22);
    height_map_clear(&reading.map);
    /* A line of three units is that of points. */
    reading = read_as("a.txt", "um um nm\n0 0 1\n1 0 2\n0 1 3\n1 1 4\n", COLUMNS_AUTO);
    assert_int_equal(reading.status, 0);
    assert_true(reading.map.grid.ny == 2 && fabs(reading.map.z[3] - 4e-9) <= 1e-22);
    height_map_clear(&reading.map);
    /* What has the lengths of a matrix is one. */
    reading = read_as("a.txt", "# dx: 1 um\n# z unit: um\n0 5\n1 3\n2 4\n3 1\n", COLUMNS_AUTO);
    assert_int_equal(reading.status, 0);
    assert_true(reading.map.grid.nx == 2 && reading.map.grid.ny == 4);
    height_map_clear(&reading.map);
}

/* The map is finite and whole enough to be cleared, whatever byte changed. */
static void check_any(struct height_map *map) {
    assert_true(map->grid.nx >= 2 && map->z != NULL);
}

static void damage_is_survived(void **state) {
    (void)state;
    static const char text[] = "X_(um),Z_(nm)\n0,1\n1,3\n2.2,2\n3,5\n4.1,4\n5,1\n6.3,2\n7,2\n";
    for (size_t at = 0; at + 1 < 2 * sizeof text; at++) {
        struct bytes copy = bytes_of(text, at < sizeof text ? at : sizeof text - 1);
        if (at >= sizeof text)
            copy.data[at - sizeof text] = (char)(copy.data[at - sizeof text] ^ 0x41);
        struct height_map map = {.z = NULL};
        struct error err = {0};
        int status = instrument_read(&map, "a.csv", copy.data, copy.size, 0,
                                     &(struct instrument_request){0}, NULL, &err);
        assert_true(status == 0 || (status == ERROR_INPUT && *err.text != '\0' && map.z == NULL));
        if (status == 0)
            check_any(&map);
        height_map_clear(&map);
        free(copy.data);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(columns_are_chosen),
        cmocka_unit_test(doubt_is_asked_back),
        cmocka_unit_test(numbered_rows_and_columns_are_refused),
        cmocka_unit_test(decimal_commas_make_one_column),
        cmocka_unit_test(other_formats_refuse),
        cmocka_unit_test(even_positions_keep_heights),
        cmocka_unit_test(missing_positions_are_holes),
        cmocka_unit_test(uneven_positions_are_resampled),
        cmocka_unit_test(holes_are_not_bridged),
        cmocka_unit_test(heads_are_understood),
        cmocka_unit_test(columns_stand_among_others),
        cmocka_unit_test(damage_is_survived),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

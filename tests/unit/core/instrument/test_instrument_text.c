/* Text exports: those that Gwyddion writes, and others by the layouts that
 * core/instrument/README.md names: headers with units, comma as the decimal mark, lists of points
 * in any order; and damaged ones, each refused with words that name the line. */
#include "core/instrument/foreign.h"
#include "tests/support/instrument_files.h"
#include <time.h>

static void by_gwyddion(void **state) {
    (void)state;
    const char *const names[] = {"gwyddion-matrix.txt", "gwyddion-spip.asc", "gwyddion-points.xyz"};
    for (size_t n = 0; n < 3; n++) {
        struct height_map map = bytes_map(bytes_of_fixture(names[n]), names[n], NULL);
        assert_int_equal(check_fixture_map(&map, 1e-20), 0);
        height_map_clear(&map);
    }
    struct height_map map = bytes_map(bytes_of_fixture(names[0]), "matrix.csv", "Topography");
    height_map_clear(&map);
    bytes_refused(bytes_of_fixture(names[0]), names[0], "Error",
                  "no layer 'Error'; allowed: a title or number of 1 'Topography' [m]");
}

/* A matrix of three columns and two rows: 1.5 -2 hole / 4 5 6.25 in units of z_metres. */
struct layout {
    const char *name, *text;
    double dx, dy, z_metres;
    const char *xy_unit, *z_unit;
};

static void check_layout(const struct layout *layout) {
    const double heights[6] = {1.5, -2, NAN, 4, 5, 6.25};
    struct height_map map = bytes_map(bytes_of_text(layout->text), layout->name, NULL);
    if (map.grid.nx != 3 || map.grid.ny != 2)
        fail_msg("%s: %zu x %zu", layout->name, map.grid.nx, map.grid.ny);
    if (!(fabs(grid_dx(&map.grid) / layout->dx - 1) <= 1e-12) ||
        !(fabs(grid_dy(&map.grid) / layout->dy - 1) <= 1e-12))
        fail_msg("%s: %g x %g apart", layout->name, grid_dx(&map.grid), grid_dy(&map.grid));
    if (strcmp(map.xy_unit, layout->xy_unit) != 0 || strcmp(map.z_unit, layout->z_unit) != 0)
        fail_msg("%s: units '%s' and '%s'", layout->name, map.xy_unit, map.z_unit);
    for (size_t point = 0; point < 6; point++)
        if (point == 2 ? !isnan(map.z[point])
                       : !(fabs(map.z[point] / layout->z_metres - heights[point]) <= 1e-12))
            fail_msg("%s: height %zu is %g", layout->name, point + 1, map.z[point]);
    height_map_clear(&map);
}

/* The same behind the mark of UTF-8 that Excel and Notepad write. */
static void check_marked(const struct layout *layout) {
    char text[1024];
    struct layout marked = *layout;
    snprintf(text, sizeof text, "\xef\xbb\xbf%s", layout->text);
    marked.text = text;
    check_layout(&marked);
}

static void matrices(void **state) {
    (void)state;
    const struct layout layouts[] = {
        {"gwyddion.txt",
         "# Channel: Topo\n# Width: 3.0 \xc2\xb5m\n# Height: 4.0 \xc2\xb5m\n# Value units: m\n"
         "1.5\t-2\tnan\n4\t5\t6.25\n",
         1e-6, 2e-6, 1, "m", "m"},
        {"german.txt", /* in German, and with the comma of that language */
         "# Kanal: Topo\n# Breite: 3,0 \xc2\xb5m\n# H\xc3\xb6he: 4,0 \xc2\xb5m\n# Einheiten: nm\n"
         "1,5\t-2\tnan\n4\t5\t6,25\n",
         1e-6, 2e-6, 1e-9, "m", "m"},
        {"latin.txt",
         "# nx = 3\r\n# Breite: 3,0 \xb5m\r\n# H\xf6he: 4,0 \xb5m\r\n1,5;-2;\r\n4;5;6,25\r\n", 1e-6,
         2e-6, 1, "m", ""},
        {"comma.csv", "1,5;-2;nan\n4;5;6,25\n", 1, 1, 1, "", ""},
        {"blanks.csv", "1,5 -2,0 nan\n4,0 5,0 6,25\n", 1, 1, 1, "", ""},
        {"spip.asc",
         "# File Format = ASCII\n# x-pixels = 3\n# y-pixels = 2\n# x-length = 3000\n"
         "# y-length = 4000\n# z-unit = nm\n# Start of Data:\n1.5\t-2\tBad\t\n4\t5\t6.25\t\n",
         1e-6, 2e-6, 1e-9, "m", "m"},
        {"attocube.asc",
         "# Daisy frame view snapshot\n# x-pixels: 3\n# y-pixels: 2\n# x-length: 3\n# y-length: 4\n"
         "# x-unit: um\n# y-unit: um\n# z-unit: nm\n# Start of Data:\n1.5 -2 nan\n4 5 6.25\n",
         1e-6, 2e-6, 1e-9, "m", "m"},
        {"nova.txt",
         "File Format = ASCII\nCreated by Nova\nNX = 3\nNY = 2\nScale X = 1\nScale Y = 2\n"
         "Unit X = um\nUnit Data = nm\nScale Data = 1\nStart of Data :\n1.5 -2 nan\n4 5 6.25\n",
         1e-6, 2e-6, 1e-9, "m", "m"},
        {"keyence.csv",
         "\"Measured date\",\"2026-04-15 00:00:00\"\r\n\"Model\",\"VK-X3000 Series\"\r\n"
         "\"Data type\n\",\"ImageDataCsv\"\r\n\"XY Calibration\",\"500\",\"nm\"\r\n"
         "\"Output image data\",\"Height\"\r\n\"Horizontal\",\"3\"\r\n\"Vertical\",\"2\"\r\n"
         "\"Minimum value\",\"-2\"\r\n\"Unit\",\"\xce\xbcm\"\r\n\"Reference data "
         "name\",\"\"\r\n\r\n"
         "\"Height\"\r\n\"1.5\",\"-2\",\"\"\r\n\"4\",\"5\",\"6.25\"\r\n",
         5e-7, 5e-7, 1e-6, "m", "m"},
        {"key-value.csv",
         "Instrument, Sensor\nWidth, 3\nHeight, 2\nPixel size [\xc2\xb5m], 1.0\n"
         "y spacing, 2.0, \xc2\xb5m\nZ unit, mm\n\n1.5, -2, No Data\n4, 5, 6.25\n",
         1e-6, 2e-6, 1e-3, "m", "m"},
        {"microscope.txt",
         "h=2 w=3\npixel size=1e-006 m\ndata unit=rad\n"
         "height conversion factor (-> m)=2e-009\n1.5 -2 nan\n4 5 6.25\n",
         1e-6, 1e-6, 2e-9, "m", "m"},
        {"volts.txt", "# Width: 3 nm\n# Height: 2 nm\n# Value units: V\n1.5 -2 nan\n4 5 6.25\n",
         1e-9, 1e-9, 1, "m", "V"},
        {"empty.txt", "dx: 1 mm\nno data value: -99\nz unit: mm\n1.5 -2 -99\n4 5 6.25\n", 1e-3,
         1e-3, 1e-3, "m", "m"},
    };
    for (size_t l = 0; l < sizeof layouts / sizeof layouts[0]; l++)
        check_layout(&layouts[l]);
}

/* Of SPIP's text a unit of heights counts where there is one, as Gwyddion writes and reads it, and
 * the nanometres of Bit2nm elsewhere. */
static void units_beside_a_scale(void **state) {
    (void)state;
    static const struct {
        const char *unit, *kept;
        double metres;
    } CASES[] = {{"", "m", 2e-9},
                 {"# z-unit = um\n", "m", 1e-6},
                 {"# z-unit = nm\n", "m", 1e-9},
                 {"# z-unit = V\n", "V", 1},
                 {"# z-unit = deg\n", "deg", 1},
                 {"# z-unit = A\n", "A", 1}};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++)
        for (size_t after = 0; after < 2; after++) {
            char text[300];
            snprintf(text, sizeof text,
                     "# File Format = ASCII\n# x-pixels = 3\n# y-pixels = 2\n# x-length = 3000\n"
                     "# y-length = 4000\n%s# Bit2nm = 2.0\n%s# Start of Data:\n"
                     "1.5\t-2\tBad\n4\t5\t6.25\n",
                     after ? "" : CASES[c].unit, after ? CASES[c].unit : "");
            check_layout(&(struct layout){"spip.asc", text, 1e-6, 2e-6, CASES[c].metres, "m",
                                          CASES[c].kept});
        }
    struct height_map map =
        bytes_map(bytes_of_text("# Channel: A\n# Bit2nm: 1\n# z-unit: V\n1 2\n3 4\n\n"
                                "# Channel: B\n# Bit2nm: 1\n# z-unit: um\n5 6\n7 8\n"),
                  "a.txt", NULL);
    assert_true(fabs(map.z[0] - 5e-6) <= 1e-18); /* the first with heights */
    height_map_clear(&map);
}

/* What a number of 1 is in metres goes with the heights, so that marks are known by their numbers;
 * where a header names the mark, or has nothing of heights, there is nothing to look for. */
static void numbers_of_the_file_are_known(void **state) {
    (void)state;
    static const struct {
        const char *text;
        double of_one;
    } FILES[] = {
        {"dx: 1 mm\nz unit: um\n1 2 3\n4 5 -9999\n", 1e-6},
        {"h=2 w=3\nheight conversion factor (-> m)=2e-009\n1 2 3\n4 5 -9999\n", 2e-9},
        {"x [mm];z [nm]\n0;1\n1;2\n2;-9999\n3;5\n", 1e-9},
        {"x [mm];y [mm];z [nm]\n0;0;1\n1;0;2\n0;1;-9999\n1;1;5\n", 1e-9},
        {"dx: 1 mm\nz unit: V\n1 2 3\n4 5 -9999\n", 1},
        {"dx: 1 mm\nno data value: -9999\nz unit: um\n1 2 3\n4 5 -9999\n", 0},
        {"dx: 1 mm\n1 2 3\n4 5 -9999\n", 0},
    };
    for (size_t f = 0; f < sizeof FILES / sizeof *FILES; f++) {
        struct height_map map = bytes_map(bytes_of_text(FILES[f].text), "a.txt", NULL);
        if (!(fabs(map.z_of_one - FILES[f].of_one) <= 1e-15 * FILES[f].of_one))
            fail_msg("%s: %g", FILES[f].text, map.z_of_one);
        height_map_clear(&map);
    }
}

/* Texts of all formats in UTF-16, of either order, as some instruments and spreadsheets write them:
 * as in UTF-8. Latin-1 is UTF-16 with zeros. */
static void sixteen_bits(void **state) {
    (void)state;
    const struct {
        const char *name, *text;
        double dx;
    } files[] = {
        {"wide.csv", "Width: 3 \xb5m\n1 2 3\n4 5 6\n", 1e-6},
        {"plain.csv", "1,2,3\n4,5,6\n", 1},
        {"plain.xyz", "0 0 1\n2 0 2\n4 0 3\n0 2 4\n2 2 5\n4 2 6\n", 2},
        {"esri.asc", "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 0.5\n4 5 6\n1 2 3\n",
         0.5},
        {"surfer.grd", "DSAA\n3 2\n0 4\n0 2\n1 6\n1 2 3\n4 5 6\n", 2},
    };
    for (size_t f = 0; f < sizeof files / sizeof files[0]; f++)
        for (size_t high_first = 0; high_first < 2; high_first++) {
            const size_t count = strlen(files[f].text);
            char wide[512] = {0};
            wide[high_first] = '\xff';
            wide[1 - high_first] = '\xfe';
            for (size_t c = 0; c < count; c++)
                wide[2 + 2 * c + high_first] = files[f].text[c];
            struct height_map map = bytes_map(bytes_of(wide, 2 + 2 * count), files[f].name, NULL);
            assert_true(map.grid.nx == 3 && map.grid.ny == 2);
            assert_true(fabs(grid_dx(&map.grid) / files[f].dx - 1) <= 1e-12);
            for (size_t p = 0; p < 6; p++)
                assert_true(map.z[p] == (double)p + 1);
            height_map_clear(&map);
        }
}

/* Lines that end with CR alone are lines, in texts of all formats, with a mark or none. */
static void lines_end_with_cr(void **state) {
    (void)state;
    static const struct {
        const char *name, *text;
        double dx;
    } FILES[] = {
        {"plain.csv", "1,2,3\r4,5,6\r", 1},
        {"plain.txt", "1 2 3\r4 5 6", 1},
        {"marked.csv",
         "\xef\xbb\xbf"
         "1,2,3\r4,5,6\r",
         1},
        {"header.txt", "Width: 3 um\r1 2 3\r4 5 6\r", 1e-6},
        {"plain.xyz", "0 0 1\r2 0 2\r4 0 3\r0 2 4\r2 2 5\r4 2 6\r", 2},
        {"esri.asc", "ncols 3\rnrows 2\rcellsize 0.5\r4 5 6\r1 2 3\r", 0.5},
    };
    for (size_t f = 0; f < sizeof FILES / sizeof *FILES; f++) {
        struct height_map map = bytes_map(bytes_of_text(FILES[f].text), FILES[f].name, NULL);
        assert_true(map.grid.nx == 3 && map.grid.ny == 2);
        assert_true(fabs(grid_dx(&map.grid) / FILES[f].dx - 1) <= 1e-12);
        for (size_t p = 0; p < 6; p++)
            assert_true(map.z[p] == (double)p + 1);
        height_map_clear(&map);
    }
    static const char WIDE[] = "\xff\xfe"
                               "1\0,\0002\0\r\0003\0,\0004\0\r";
    struct height_map map = bytes_map(bytes_of(WIDE, sizeof WIDE), "wide.csv", NULL);
    assert_true(map.grid.nx == 2 && map.grid.ny == 2 && map.z[3] == 4);
    height_map_clear(&map);
}

/* Several layers, a block each: by title and by number. */
static void blocks(void **state) {
    (void)state;
    static const char text[] =
        "# Channel: Phase\n# Width: 2 um\n# Height: 2 um\n# Value units: deg\n1 2\n3 4\n\n"
        "# Channel: Height\n# Width: 4 um\n# Height: 2 um\n# Value units: nm\n5 6\n7 8\n";
    const char *const layers[] = {NULL, "Height", "2"};
    for (size_t l = 0; l < 3; l++) {
        struct height_map map = bytes_map(bytes_of_text(text), "a.txt", layers[l]);
        assert_true(map.grid.nx == 2 && map.grid.ny == 2);
        assert_true(fabs(map.z[0] - 5e-9) <= 1e-22 && fabs(grid_dx(&map.grid) - 2e-6) <= 1e-18);
        height_map_clear(&map);
    }
    struct height_map map = bytes_map(bytes_of_text(text), "a.txt", "1");
    assert_string_equal(map.z_unit, "deg");
    assert_true(map.z[3] == 4);
    height_map_clear(&map);
    expect_layer(bytes_of_text(text), NULL, "2 'Height' of 2");
    expect_layer(bytes_of_text(text), "Phase", "1 'Phase' of 2");
    expect_layer(bytes_of_text("Width: 2 um\n1 2\n3 4\n\nWidth: 2 um\n5 6\n7 8\n"), "2", "2 of 2");
    expect_layer(bytes_of_text("# Channel: A\nWidth: 2 um\n1 2\n3 4\n"), NULL, "");
    /* A title is shown, whatever its bytes. */
    expect_layer(bytes_of_text("# Channel: A\x1b[2J\xe9\nWidth: 2 um\n1 2\n3 4\n"
                               "# Channel: B\nWidth: 2 um\n1 2\n3 4\n"),
                 NULL, "1 'A?[2J?' of 2");
}

/* Points in any order, some of them missing, with units in the names of columns, behind them, or in
 * a header; the heights are 1 to 6 on a grid of 3 x 2 but for the third. */
static void points(void **state) {
    (void)state;
    const struct layout layouts[] = {
        {"a.xyz", "4 2 6.25\n0 0 1.5\n2 0 -2\n0 2 4\n2 2 5\n", 2, 2, 1, "", ""},
        {"b.xyz", "0,0 0,0 1,5\n2,0 0,0 -2\n4,0 0,0 nan\n0,0 2,0 4\n2,0 2,0 5\n4,0 2,0 6,25\n", 2,
         2, 1, "", ""},
        {"c.txt",
         "X [mm];Y [mm];Z [\xc2\xb5m]\n0,1;7;1,5\n0,2;7;-2\n0,3;8;6,25\n0,2;8;5\n0,1;8;4\n", 1e-4,
         1e-3, 1e-6, "m", "m"},
        {"d.txt",
         "X\tY\tZ\n\xc2\xb5m\t\xc2\xb5m\tnm\n0\t5\t4\n1\t5\t5\n2\t5\t6.25\n1\t3\t-2\n0\t3\t1.5\n",
         1e-6, 2e-6, 1e-9, "m", "m"},
        {"e.csv",
         "N,Z(mm),X(mm),Y(mm),I\n1,1.5,0,0,9\n2,-2,1,0,9\n3,4,0,1,9\n4,5,1,1,9\n5,6.25,2,1,9\n",
         1e-3, 1e-3, 1e-3, "m", "m"},
        {"f.txt",
         "# Channel: T\n# Lateral units: um\n# Value units: nm\n0.33\t0\t1.5\n0.67\t0\t-2\n"
         "0.33\t1\t4\n0.67\t1\t5\n1.00\t1\t6.25\n",
         0.67e-6 / 2, 1e-6, 1e-9, "m", "m"},
    };
    for (size_t l = 0; l < sizeof layouts / sizeof layouts[0]; l++)
        check_layout(&layouts[l]);
}

static void profile_of_points(void **state) {
    (void)state;
    struct height_map map =
        bytes_map(bytes_of_text("x [um] y [um] z [nm]\n0 3 1\n1 3 2\n3 3 4\n"), "p.txt", NULL);
    assert_true(map.grid.nx == 4 && map.grid.ny == 1 && isnan(map.z[2]));
    assert_true(fabs(map.z[3] - 4e-9) <= 1e-22 && fabs(grid_dx(&map.grid) - 1e-6) <= 1e-18);
    height_map_clear(&map);
}

/* A plain list in order is read as it always was. */
static void plain_points(void **state) {
    (void)state;
    struct height_map map =
        bytes_map(bytes_of_text("0 0 1\n0.1 0 2\n0 0.1 3\n0.1 0.1 4\n"), "p.xyz", NULL);
    assert_true(map.grid.nx == 2 && map.grid.ny == 2 && map.z[3] == 4);
    assert_true(map.grid.lx == 0.2 && *map.xy_unit == '\0');
    height_map_clear(&map);
}

static const char ZYGO[] = "Zygo XYZ Data File - Format 1\n0 3 0 0 \"Tue Aug 25 16:59:23 2026\"\n"
                           "0 0 3 2 1 255\n10 20 3 2\n\"\"\n\"\"\n\"\"\n"
                           "0 0.5 6.328e-07 0 1 0 1e-06 1787677163\n3 2 0 0 0 6666 \"\"\n"
                           "0 0 0 0 0 0 0 0 0 0\n1 0 0 0 0 0 0 0 0\n0 \"\"\n1 0\n\"\"\n#\n"
                           "10 20 1.5\n11 20 -2\n12 20 No Data\n10 21 4\n11 21 5\n12 21 6.25\n#\n";

static void grids(void **state) {
    (void)state;
    const struct layout layouts[] = {
        {"surfer.grd",
         "DSAA\r\n3 2\r\n10 14\r\n5 6\r\n-2 6.25\r\n1.5 -2\r\n1.70141e+038\r\n4 5\r\n6.25\r\n", 2,
         1, 1, "", ""},
        {"esri.asc",
         "ncols 3\nnrows 2\nxllcorner 0.0\nyllcorner 0.0\ncellsize 2.5\nNODATA_value -9999\n"
         "4 5 6.25\n1.5 -2 -9999\n",
         2.5, 2.5, 1, "", ""},
        {"esri-comma.asc",
         "NCOLS 3\nNROWS 2\nXLLCENTER 0\nYLLCENTER 0\nDX 2,5\nDY 5\n4 5 6,25\n"
         "1,5 -2 -9999\n",
         2.5, 5, 1, "", ""},
        {"zygo.xyz", ZYGO, 1e-6, 1e-6, 1e-6, "m", "m"},
    };
    for (size_t l = 0; l < sizeof layouts / sizeof layouts[0]; l++) {
        check_layout(&layouts[l]);
        check_marked(&layouts[l]);
    }
    check_marked(&(struct layout){"plain.csv", "1.5,-2,nan\n4,5,6.25\n", 1, 1, 1, "", ""});
}

struct refusal {
    const char *name, *text, *words;
};

static void refused(void **state) {
    (void)state;
    const struct refusal refusals[] = {
        {"a.txt", "Width: 3 um\nx-pixels: 4\n1 2 3\n4 5 6\n", "line 3 has 3 numbers, not 4"},
        {"a.txt", "Width: 3 um\nRows: 3\n1 2 3\n4 5 6\n", "the header says 3 rows, 2 are there"},
        {"a.txt", "Width: 3 um\nRows: -3\n1 2 3\n4 5 6\n", "the header says -3 rows"},
        {"a.txt", "Width: 3 um\nColumns: 1e300\n1 2 3\n4 5 6\n", "the header says 1e+300 points"},
        {"a.txt", "Width: 0 um\n1 2 3\n4 5 6\n", "a length along x of 0 um; allowed: above 0"},
        {"a.txt", "Pixel size: -1 um\n1 2 3\n4 5 6\n", "a spacing along x of -1 um"},
        {"a.txt", "Width: 1 um\nHeight: 1 s\n1 2 3\n4 5 6\n", "x is in 'um' and y in 's'"},
        {"a.txt", "Width: 3 um\n1 2 3\n4 5\n", "line 3 has 2 numbers, not 3"},
        {"a.txt", "Width: 3 um\n1 2 3\n4 5 6 7\n", "line 3 has 4 numbers, not 3"},
        {"a.txt", "Width: 3 um\n1 2 3\n4 5x 6\n", "line 3, column 2: '5x' is not a number"},
        {"a.txt", "Width: 3 um\n1 2 3\n4 1e999 6\n", "line 3, column 2: '1e999'"},
        {"a.txt", "Width: 3 um\n1 2 3\n4 inf 6\n", "line 3, column 2: 'inf'"},
        {"a.txt", "Width: 3 um\n1 2 3\n4 5 6\nend of file\n", "line 4: 'end of file' is among the"},
        {"a.txt", "Width: 3 um\n1.5;2;3\n4,5;5;6\n", "line 3, column 1: '4,5' is not a number as"},
        {"a.txt", "Width: 3 um\n1,5;2;3\n1.234,5;5;6\n", "line 3, column 1: '1.234,5'"},
        {"a.txt", "Width: 3 um\nz scale: 1e300\n1 2 3\n4 5 1e300\n", "too large with the scale"},
        {"a.txt", "Width: 3 um\n1\n", "a map of 1 rows of 1 points"},
        {"a.txt", "x y z\n0 0 1\n1 0 2\n0 0 3\n", "point 3 at (0, 0) lies where another"},
        {"a.txt", "x y z\n0 0 1\n1 0 2\n1.3 0 3\n0 1 1\n9.11 4 4\n",
         "lies on no regular grid of steps"},
        {"a.txt", "x y z\n0 0 1\nnan 0 2\n0 1 3\n", "point 2 has no finite x"},
        {"a.txt", "i;x;y;z\n0;0;1\n1;0;2\n", "a point has 3 numbers, z is column 4"},
        {"a.xyz", "0 0 1\n200 0 2\n0 1 1\n1 7 1\n", "one point for 64 nodes"},
        {"a.xyz", "0 0 1\n", "1 points make no map"},
        {"a.xyz", "no numbers\n", "holds no line of numbers"},
        {"a.csv", "\xff\xfe", "holds no number"},
        {"a.grd", "DSAA\n3 2\n0 1\n0 1\n0 1\n1 2 3 4 5\n", "the file ends before a height"},
        {"a.grd", "DSAA\n3 2\n0 1\n0 1\n0 1\n1 2 3 4 5 6 7\n",
         "line 6: more heights than the 3 x 2"},
        {"a.grd", "DSAA\n3 0\n0 1\n0 1\n0 1\n", "line 2: the count of rows is '0'; allowed: 1 to"},
        {"a.grd", "DSAA\n30000 30000\n0 1\n0 1\n0 1\n1 2\n", "30000 x 30000 points do not fit"},
        {"a.grd", "DSAA\n3 2\n1 1\n0 1\n0 1\n1 2 3 4 5 6\n", "x goes from 1 to 1; allowed: up"},
        {"a.grd", "DSAA\n3 x\n", "line 2: the count of rows is 'x'"},
        {"a.grd", "DSAA\n3", "the file ends before the count of rows"},
        {"a.asc", "ncols 3\nnrows 2\ncellsize 0\n1 2 3 4 5 6\n", "cellsize is 0; allowed: above 0"},
        {"a.asc", "ncols 3\nnrows 2\n1 2 3 4 5 6\n", "cellsize is 0"},
        {"a.asc", "ncols 3\nncells 2\ncellsize 1\n1 2 3\n", "nrows is 0; allowed: 1 to"},
        {"a.asc", "ncols 3\nnrows 2\ncellsize 1\n1 2 3 4 5 six\n", "a height is 'six'"},
        {"a.asc", "ncols three\nnrows 2\n", "line 1: a value of the header is 'three'"},
    };
    for (size_t r = 0; r < sizeof refusals / sizeof refusals[0]; r++)
        bytes_refused(bytes_of_text(refusals[r].text), refusals[r].name, NULL, refusals[r].words);
    bytes_refused(bytes_of_text(ZYGO), "z.xyz", "2", "no layer '2'; allowed: 1");
}

static void damaged_zygo(void **state) {
    (void)state;
    const struct damage damages[] = {
        {"10 20 3 2", 9, 6, "4", 1, "6 pixels are there, the frame has 8"},
        {"10 20 3 2", 9, 6, "0", 1, "line 4: the frame of pixels is 10 20 0 2"},
        {"10 20 3 2", 9, 6, "2", 1, "line 18: a pixel is outside the frame"},
        {"10 20 3 2", 9, 0, "-1", 2, "the frame of pixels is -1 20 3 2"},
        {"10 20 3 2", 9, 0, "ab", 2, "line 4: word 1 is no number; allowed: 4 numbers"},
        {"10 20 3 2", 9, 3, "9999999", 7, "line 4: word 2 is no number"},
        {" 1e-06", 6, 1, "-1e-6", 5, "a pixel has -1e-06 m"},
        {" 1e-06", 6, 1, "micro", 5, "line 8: word 7 is no number"},
        {"11 20 -2", 8, 6, "-x", 2, "line 17: the height is '-x'; allowed: a number, or No Data"},
        {"11 20 -2", 8, 0, "99", 2, "line 17: a pixel is outside"},
        {"No Data", 7, 0, "NoDatum", 7, "the height is 'NoDatum'"},
        {"\n#\n10", 5, 1, "x", 1, ""},
    };
    for (size_t d = 0; d < sizeof damages / sizeof damages[0]; d++) {
        struct bytes bytes = bytes_of_text(ZYGO);
        bytes_damage(&bytes, &damages[d]);
        bytes_refused(bytes, "z.xyz", NULL, damages[d].words);
    }
    const size_t last = (size_t)(strstr(ZYGO, "12 21") - ZYGO) + 5;
    for (size_t size = 20; size <= last; size++)
        bytes_refused(bytes_of(ZYGO, size), "z.xyz", NULL, "");
}

/* The time of a row grows as its length does: a number is looked at alone, not with all behind it.
 */
static void wide_rows(void **state) {
    (void)state;
    enum { COLUMNS = 400000 };
    static char text[4 * COLUMNS + 100] = "Z-unit,nm\n";
    size_t begin_of_row = strlen(text);
    for (size_t column = 0; column < COLUMNS; column++)
        snprintf(text + begin_of_row + 4 * column, 5, "%s",
                 column + 1 < COLUMNS ? "1.5," : "1.5\n");
    clock_t begin = clock();
    struct height_map map = bytes_map(bytes_of_text(text), "wide.csv", NULL);
    assert_true(clock() - begin < 5 * CLOCKS_PER_SEC);
    assert_true(map.grid.nx == COLUMNS && fabs(map.z[COLUMNS - 1] - 1.5e-9) <= 1e-20);
    height_map_clear(&map);
}

/* Only the beginning of a text, 16384 bytes, shows what it is. Wherever that ends in a row, as
 * behind 1.00e- too, the header counts, and so do decimal commas. */
static void long_rows_are_recognised(void **state) {
    (void)state;
    enum { COLUMNS = 3000, PAD_MOST = 9, ROW = 9 * COLUMNS };
    static char text[3 * ROW + 100];
    static const char *const NUMBERS[2] = {"1.00e-01,", "1,00e-01;"};
    for (size_t comma = 0; comma < 2; comma++)
        for (size_t pad = 0; pad < PAD_MOST; pad++) {
            const char *head = comma ? "" : "# dx: 0.5 um\n# z unit: um\n";
            int used = snprintf(text, sizeof text, "%s%*s", head, (int)pad, "");
            for (size_t number = 0; number < 3 * (size_t)COLUMNS; number++) {
                memcpy(text + used, NUMBERS[comma], 9);
                used += 9;
                text[used - 1] = number % COLUMNS == COLUMNS - 1 ? '\n' : text[used - 1];
            }
            text[used] = '\0';
            struct height_map map = bytes_map(bytes_of_text(text), "long.csv", NULL);
            assert_true(map.grid.nx == COLUMNS && map.grid.ny == 3);
            assert_string_equal(map.z_unit, comma ? "" : "m");
            assert_true(fabs(grid_dx(&map.grid) / (comma ? 1 : 5e-7) - 1) <= 1e-12);
            assert_true(fabs(map.z[ROW / 3 - 1] / (comma ? 0.1 : 1e-7) - 1) <= 1e-12);
            height_map_clear(&map);
        }
}

/* A file without a mark or an ending that is known is read as text; one of bytes is refused with
 * the endings that there are. */
static void unknown_formats_are_named(void **state) {
    (void)state;
    static const char BYTES[] = "1\0002\n";
    bytes_refused(bytes_of(BYTES, sizeof BYTES - 1), "a.plu", NULL,
                  "ending .plu belong to a format that is known; allowed: .npy, .csv, .xyz, .gwy");
    bytes_refused(bytes_of(BYTES, sizeof BYTES - 1), "folder.d/plain", NULL,
                  "nor its ending belong to a format");
    bytes_refused(bytes_of(BYTES, sizeof BYTES - 1), "a.csv", NULL, "zero byte");
}

/* Files that have a reader, and those that another program may convert. */
static void other_formats_are_told_apart(void **state) {
    (void)state;
    static const struct {
        const char *name, *bytes;
        size_t size;
        bool takes;
        const char *format; /* among those without a reader; NULL: unknown */
    } FILES[] = {
        {"a.al3d", "AliconaImaging\0\r\n", 17, false, "Alicona's AL3D"},
        {"a.opd", "\1\0Directory\0", 12, false, "Wyko's OPD"},
        {"a.dat", "\x88\x1b\x03\x70\0\0", 6, false, "Zygo's MetroPro"},
        {"a.001", "\\*File list\r\n\0", 14, false, "Nanoscope"},
        {"a.grd", "DSBB\0\0", 6, false, "Surfer's binary grid"}, /* the text has this ending, too */
        {"a.plu", "Fri Mar 10\0", 11, false, NULL},
        {"a.plux", "PK\3\4\0\0", 6, false, NULL},
        {"a.txt", "\\*File list\r\n", 13, true, "Nanoscope"}, /* text, which a reader refuses */
        {"a.npy", "\x93NUMPY\0", 7, true, NULL},
        {"a.csv", "1\0002", 3, true, NULL}, /* its reader reports the zero byte */
        {"a.sdf", "bISO\0", 5, true, NULL},
        {"a", "Gwyddion\0", 9, false, NULL},
        {"a.gwy", "GWYPGwyContainer\0", 17, true, NULL},
        {"a",
         "\xff\xfe"
         "1\0",
         4, true, NULL},
        {"a", "", 0, true, NULL},
    };
    for (size_t f = 0; f < sizeof FILES / sizeof *FILES; f++) {
        struct bytes bytes = bytes_of(FILES[f].bytes, FILES[f].size);
        const struct foreign_format *format = foreign_format_of(bytes.data, bytes.size);
        if (instrument_takes(FILES[f].name, bytes.data, bytes.size) != FILES[f].takes)
            fail_msg("%s, '%s': not %d", FILES[f].name, FILES[f].bytes, FILES[f].takes);
        if ((format != NULL) != (FILES[f].format != NULL) ||
            (format != NULL && strcmp(format->name, FILES[f].format) != 0))
            fail_msg("%s: %s", FILES[f].name, format != NULL ? format->name : "unknown");
        free(bytes.data);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(by_gwyddion),
        cmocka_unit_test(unknown_formats_are_named),
        cmocka_unit_test(other_formats_are_told_apart),
        cmocka_unit_test(matrices),
        cmocka_unit_test(sixteen_bits),
        cmocka_unit_test(lines_end_with_cr),
        cmocka_unit_test(units_beside_a_scale),
        cmocka_unit_test(numbers_of_the_file_are_known),
        cmocka_unit_test(blocks),
        cmocka_unit_test(points),
        cmocka_unit_test(profile_of_points),
        cmocka_unit_test(plain_points),
        cmocka_unit_test(grids),
        cmocka_unit_test(refused),
        cmocka_unit_test(damaged_zygo),
        cmocka_unit_test(wide_rows),
        cmocka_unit_test(long_rows_are_recognised),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#include "server/show/plot/plot_pen.h"
#include "core/file/memory_file.h"
#include "schema/json/json.h"
#include "schema/result/result_json.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { HEIGHT = 570 };

/* The first seven are those of Okabe & Ito (2008), which every reader can distinguish. */
const char *const PEN_COLOURS[PLOT_LINES] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                             "#e69f00", "#56b4e9", "#000000", "#8a8a00",
                                             "#7f3b08", "#6a51a3", "#999999", "#a50026"};

static void make_title(const char *name, const char *subject, char title[PLOT_LABEL_SIZE]) {
    snprintf(title, PLOT_LABEL_SIZE, "%.110s%s%.80s", name, *subject != '\0' ? ": " : "", subject);
}

void pen_subject(const struct plot_pen *pen, const char *name, const char *subject) {
    char title[PLOT_LABEL_SIZE];
    make_title(name, subject, title);
    fputs("<title>", pen->file);
    svg_text(pen->file, title);
    fputs("</title>\n", pen->file);
}

void pen_title(const struct plot_pen *pen, const char *name, const char *subject) {
    char title[PLOT_LABEL_SIZE];
    pen_subject(pen, name, subject);
    make_title(name, subject, title);
    fprintf(pen->file, "<text x=\"%d\" y=\"%d\" class=\"title\">", FRAME_LEFT, FRAME_TOP - 14);
    svg_text(pen->file, title);
    fputs("</text>\n", pen->file);
}

void pen_head(const struct plot_pen *pen, int width) {
    pen_head_sized(pen, &(struct pen_size){.width = width, .height = HEIGHT, .font = 13});
}

void pen_head_sized(const struct plot_pen *pen, const struct pen_size *size) {
    fprintf(pen->file, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" ",
            size->width, size->height);
    if (size->millimetres > 0)
        fprintf(pen->file, "width=\"%.4gmm\" height=\"%.4gmm\">\n", size->millimetres,
                size->millimetres * size->height / size->width);
    else
        fprintf(pen->file, "width=\"%d\" height=\"%d\">\n", size->width, size->height);
    fprintf(pen->file,
            "<style>text{font:%gpx system-ui,sans-serif;fill:#222}"
            ".title{font-weight:600}.middle{text-anchor:middle}.end{text-anchor:end}"
            ".note{fill:#666;font-size:%gpx}.grid{stroke:#e4e4e4}.frame{fill:none;stroke:#444}"
            ".curve{fill:none;stroke-linejoin:round}.theory{fill:none;stroke-width:1.4}"
            ".bar{stroke-width:3;stroke-opacity:.45}.partial{fill:#fff}"
            ".total{fill:none;stroke-width:.9;stroke-opacity:.7}.total.part{stroke-dasharray:3 2}"
            ".band{fill-opacity:.22}.wide{fill-opacity:.09}"
            ".wide.part{stroke-width:.7;stroke-opacity:.6;stroke-dasharray:4 3}"
            ".dot{stroke-width:3.6;stroke-linecap:round}.index{font-size:75%%}</style>\n"
            "<rect width=\"%d\" height=\"%d\" fill=\"#fff\"/>\n",
            size->font, size->font - 1, size->width, size->height);
}

/* The measured surface that those of the study are like, where there is one. */
static bool put_like(FILE *file, const struct study_result *study) {
    static const char *const TOLD[] = {"file", "sha256", "prepared"};
    const char *before = ",\"like\":{";
    for (size_t t = 0; t < sizeof TOLD / sizeof *TOLD && study->case_count > 0; t++) {
        char pointer[40];
        snprintf(pointer, sizeof pointer, "/surface/like/%s", TOLD[t]);
        const struct result_parameter *told = result_parameter(&study->cases[0], pointer);
        if (told == NULL || told->text == NULL)
            continue;
        fprintf(file, "%s\"%s\":", before, TOLD[t]);
        before = ",";
        if (!json_print_text(file, told->text))
            return false;
    }
    return *before == ',' && before[1] == '\0' ? fputc('}', file) != EOF : true;
}

void pen_study(const struct plot_pen *pen, const struct study_result *study) {
    struct memory_file memory;
    if (study->provenance == NULL || !memory_file_open(&memory))
        return;
    bool done = study_print_about(memory.file, study) && put_like(memory.file, study) &&
                fputc('}', memory.file) != EOF;
    char *text = memory_file_close(&memory, NULL);
    if (done && text != NULL) {
        fputs("<metadata>", pen->file);
        svg_text(pen->file, text);
        fputs("</metadata>\n", pen->file);
    }
    free(text);
}

bool pen_reaches(const struct plot_pen *pen, double x, double y) {
    const struct frame *frame = &pen->frame;
    return frame_has_place(frame, x, y) && x >= frame->x.low && x <= frame->x.high &&
           y <= frame->y.high && y >= frame->y.low;
}

struct point {
    double x, y; /* on the picture */
};

/* Returns whether a point can be drawn, within the frame or not, and where. */
static bool find_point(const struct frame *frame, double x, double y, struct point *out) {
    if (!frame_has_place(frame, x, y))
        return false;
    *out = (struct point){frame_x(frame, x), frame_y(frame, y)};
    return isfinite(out->x) && isfinite(out->y);
}

/* Cuts a segment to the frame (Liang & Barsky 1984), where axes are straight, logarithmic ones,
 * too. Returns whether some of it is left; *cut: its end is not. */
static bool cut_segment(const struct frame *frame, struct point *from, struct point *to,
                        bool *cut) {
    const double dx = to->x - from->x, dy = to->y - from->y;
    const double sides[4][2] = {{-dx, from->x - frame->left},
                                {dx, frame->right - from->x},
                                {-dy, from->y - frame->top},
                                {dy, frame->bottom - from->y}};
    double first = 0, last = 1;
    for (size_t s = 0; s < 4; s++) {
        double outwards = sides[s][0], room = sides[s][1];
        if (outwards > 0)
            last = fmin(last, room / outwards);
        else if (outwards < 0)
            first = fmax(first, room / outwards);
        else if (room < 0)
            return false;
    }
    const struct point begin = *from;
    *cut = last < 1;
    if (first > 0)
        *from = (struct point){begin.x + first * dx, begin.y + first * dy};
    if (last < 1)
        *to = (struct point){begin.x + last * dx, begin.y + last * dy};
    return first <= last;
}

/* Draws what of a segment lies within the frame. Returns whether the pen is down at its end. */
static bool draw_segment(const struct plot_pen *pen, struct point from, struct point to,
                         bool pen_down) {
    bool cut;
    if (!cut_segment(&pen->frame, &from, &to, &cut))
        return false;
    if (!pen_down)
        fprintf(pen->file, "M%.2f %.2f", from.x, from.y);
    fprintf(pen->file, "L%.2f %.2f", to.x, to.y);
    return !cut;
}

void pen_line(const struct plot_pen *pen, size_t n, const double *x, const double *y,
              const char *style) {
    struct point last = {0}, here;
    bool follows = false, pen_down = false;
    fprintf(pen->file, "<path %s d=\"", style);
    for (size_t a = 0; a < n; a++) {
        if (!find_point(&pen->frame, x[a], y[a], &here)) {
            follows = pen_down = false;
            continue;
        }
        if (follows) {
            pen_down = draw_segment(pen, last, here, pen_down);
        } else if (pen_reaches(pen, x[a], y[a])) {
            fprintf(pen->file, "M%.2f %.2f", here.x, here.y);
            pen_down = true;
        }
        follows = true;
        last = here;
    }
    fputs("\"/>\n", pen->file);
}

bool pen_meets(const struct plot_pen *pen, size_t n, const double *x, const double *y) {
    for (size_t a = 0; a < n; a++) {
        struct point from, to;
        bool cut;
        if (pen_reaches(pen, x[a], y[a]) ||
            (a > 0 && find_point(&pen->frame, x[a - 1], y[a - 1], &from) &&
             find_point(&pen->frame, x[a], y[a], &to) &&
             cut_segment(&pen->frame, &from, &to, &cut)))
            return true;
    }
    return false;
}

int pen_row(int row) {
    return FRAME_TOP + 8 + 20 * row;
}

void pen_legend(struct plot_pen *pen, const char *label, const char *style) {
    int y = pen_row(pen->rows++) + 4;
    fprintf(pen->file, "<path d=\"M%d %dh26\" %s/><text x=\"%d\" y=\"%d\">", pen->frame.right + 16,
            y - 4, style, pen->frame.right + PEN_LEGEND - FRAME_RIGHT, y);
    svg_text(pen->file, label);
    fputs("</text>\n", pen->file);
}

void pen_note(struct plot_pen *pen, const char *text) {
    fprintf(pen->file, "<text x=\"%d\" y=\"%d\" class=\"note\">", pen->frame.right + 16,
            FRAME_TOP + 16 + 20 * pen->rows++);
    svg_label(pen->file, text);
    fputs("</text>\n", pen->file);
}

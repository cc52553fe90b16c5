#include "core/instrument/archive/x3p_xml.h"
#include <expat.h>
#include <stdlib.h>
#include <string.h>

const char *const X3P_PATHS[X3P_FIELDS] = {
    "Record1/FeatureType",
    "Record1/Axes/CX/AxisType",
    "Record1/Axes/CX/DataType",
    "Record1/Axes/CX/Increment",
    "Record1/Axes/CX/Offset",
    "Record1/Axes/CY/AxisType",
    "Record1/Axes/CY/DataType",
    "Record1/Axes/CY/Increment",
    "Record1/Axes/CY/Offset",
    "Record1/Axes/CZ/AxisType",
    "Record1/Axes/CZ/DataType",
    "Record1/Axes/CZ/Increment",
    "Record1/Axes/CZ/Offset",
    "Record1/Axes/Rotation/r33",
    "Record3/MatrixDimension/SizeX",
    "Record3/MatrixDimension/SizeY",
    "Record3/MatrixDimension/SizeZ",
    "Record3/ListDimension",
    "Record3/DataLink/PointDataLink",
    "Record3/DataLink/MD5ChecksumPointData",
    "Record3/DataLink/ValidPointsLink",
    "Record3/DataLink/MD5ChecksumValidPoints",
    "Record4/ChecksumFile",
};
static const char DATUM[] = "Record3/DataList/Datum";

enum {
    DEPTH_MOST = 32,
    PATH_MOST = 1024,      /* bytes of the names of open elements */
    TOKEN_MOST = 1 << 20,  /* bytes of a tag or comment */
    NAMES_MOST = 1 << 22,  /* bytes that the parser keeps of names until its end */
    A_NAME = 64,           /* of these, beside its letters */
    NO_FIELD = X3P_FIELDS, /* other values of `element` */
    A_DATUM
};

struct x3p_xml {
    XML_Parser parser;         /* owned */
    struct x3p_fields *fields; /* borrowed */
    x3p_datum *take;
    void *context;             /* borrowed */
    char path[PATH_MOST];      /* of the open elements below the root */
    size_t starts[DEPTH_MOST]; /* of each element's name in it */
    size_t depth;              /* open elements, with the root */
    int element;               /* the innermost element: an x3p_field, NO_FIELD or A_DATUM */
    bool present[X3P_FIELDS];
    char text[X3P_TEXT]; /* of the innermost element, where it is a field or a datum */
    size_t length;
    size_t names;       /* bytes, as NAMES_MOST */
    char datum[A_NAME]; /* the name of the first listed point, with its prefix */
    size_t fed;         /* bytes */
    struct error fault; /* code 0 as long as there is none */
};

/* Stops the parser at a fault, whose text the caller has set. */
static void stop(struct x3p_xml *xml) {
    XML_StopParser(xml->parser, XML_FALSE);
}

/* Returns the name without the prefix of its name space. */
static const char *local_name(const char *name) {
    const char *colon = strrchr(name, ':');
    return colon != NULL ? colon + 1 : name;
}

static int element_at(const char *path) {
    int field = 0;
    if (strcmp(path, DATUM) == 0)
        return A_DATUM;
    while (field < X3P_FIELDS && strcmp(path, X3P_PATHS[field]) != 0)
        field++;
    return field;
}

/* Appends a name to those of the open elements. */
static int path_append(struct x3p_xml *xml, const char *name, struct error *err) {
    size_t end = strlen(xml->path), length = strlen(name);
    if (xml->depth == DEPTH_MOST || end + length + 2 > PATH_MOST)
        return error_set(
            err, ERROR_INPUT,
            "elements are nested deeper than %d, or their names are longer than %d bytes",
            DEPTH_MOST, PATH_MOST);
    xml->starts[xml->depth] = end;
    if (end > 0)
        xml->path[end++] = '/';
    memcpy(xml->path + end, name, length + 1);
    return 0;
}

static int open_element(struct x3p_xml *xml, const char *name, struct error *err) {
    if (xml->depth == 0) {
        if (strncmp(name, "ISO5436", 7) != 0)
            return error_set(err, ERROR_INPUT, "the root is %.40s; allowed: ISO5436_2 and ISO5436",
                             name);
        xml->starts[xml->depth++] = 0;
        return 0;
    }
    int status = path_append(xml, name, err);
    if (status != 0)
        return status;
    xml->depth++;
    xml->element = element_at(xml->path);
    xml->length = 0;
    if (xml->element >= X3P_FIELDS)
        return 0;
    if (xml->present[xml->element])
        return error_set(err, ERROR_INPUT, "%s stands there twice", X3P_PATHS[xml->element]);
    xml->present[xml->element] = true;
    return 0;
}

/* The parser keeps each name that it meets, so that their number is limited. The points' name
 * counts once. */
static int count_names(struct x3p_xml *xml, const char *name, const char **attributes,
                       struct error *err) {
    if (xml->element == A_DATUM && *xml->datum == '\0' && strlen(name) < sizeof xml->datum)
        memcpy(xml->datum, name, strlen(name) + 1);
    if (strcmp(name, xml->datum) != 0)
        xml->names += strlen(name) + A_NAME;
    for (size_t pair = 0; attributes[pair] != NULL; pair += 2)
        xml->names += strlen(attributes[pair]) + A_NAME;
    if (xml->names <= NAMES_MOST)
        return 0;
    return error_set(err, ERROR_INPUT, "names of elements and attributes take more than %d bytes",
                     NAMES_MOST);
}

static void on_start(void *user, const XML_Char *name, const XML_Char **attributes) {
    struct x3p_xml *xml = user;
    if (xml->fault.code != 0)
        return;
    int status = open_element(xml, local_name(name), &xml->fault);
    if (status == 0)
        status = count_names(xml, name, attributes, &xml->fault);
    if (status != 0)
        stop(xml);
}

/* Removes blanks at both ends; returns where the text starts. */
static const char *trim(char *text, size_t length) {
    while (length > 0 && strchr(" \t\r\n", text[length - 1]) != NULL)
        length--;
    text[length] = '\0';
    return text + strspn(text, " \t\r\n");
}

static int close_element(struct x3p_xml *xml, struct error *err) {
    int status = 0;
    if (xml->element != NO_FIELD) {
        const char *text = trim(xml->text, xml->length);
        if (xml->element == A_DATUM)
            status = xml->take(xml->context, xml->fields, text, err);
        else
            memcpy(xml->fields->text[xml->element], text, strlen(text) + 1);
    }
    xml->element = NO_FIELD;
    xml->depth--;
    xml->path[xml->starts[xml->depth]] = '\0';
    return status;
}

static void on_end(void *user, const XML_Char *name) {
    (void)name;
    struct x3p_xml *xml = user;
    if (xml->fault.code == 0 && close_element(xml, &xml->fault) != 0)
        stop(xml);
}

static void on_text(void *user, const XML_Char *text, int length) {
    struct x3p_xml *xml = user;
    if (xml->fault.code != 0 || xml->element == NO_FIELD)
        return;
    if ((size_t)length >= X3P_TEXT - xml->length) {
        error_set(&xml->fault, ERROR_INPUT, "the text of %s is longer than %d bytes",
                  xml->element == A_DATUM ? DATUM : X3P_PATHS[xml->element], X3P_TEXT - 1);
        stop(xml);
        return;
    }
    memcpy(xml->text + xml->length, text, (size_t)length);
    xml->length += (size_t)length;
}

static void on_doctype(void *user, const XML_Char *name, const XML_Char *system,
                       const XML_Char *public, int internal) {
    (void)name;
    (void)system;
    (void)public;
    (void)internal;
    struct x3p_xml *xml = user;
    error_set(&xml->fault, ERROR_INPUT, "a document type (DOCTYPE), which no X3P file has");
    stop(xml);
}

int x3p_xml_create(struct x3p_xml **out, struct x3p_fields *fields, x3p_datum *take, void *context,
                   struct error *err) {
    struct x3p_xml *xml = array_create(1, sizeof *xml);
    if (xml != NULL)
        xml->parser = XML_ParserCreate(NULL);
    if (xml == NULL || xml->parser == NULL) {
        free(xml);
        return error_memory(err, sizeof *xml, "a reader of XML");
    }
    memset(fields, 0, sizeof *fields);
    xml->fields = fields;
    xml->take = take;
    xml->context = context;
    xml->element = NO_FIELD;
    XML_SetUserData(xml->parser, xml);
    XML_SetElementHandler(xml->parser, on_start, on_end);
    XML_SetCharacterDataHandler(xml->parser, on_text);
    XML_SetStartDoctypeDeclHandler(xml->parser, on_doctype);
    *out = xml;
    return 0;
}

void x3p_xml_destroy(struct x3p_xml **xml) {
    if (*xml == NULL)
        return;
    XML_ParserFree((*xml)->parser);
    free(*xml);
    *xml = NULL;
}

/* Reports the parser's fault, or that of a callback. */
static int refuse(const struct x3p_xml *xml, struct error *err) {
    enum XML_Error code = XML_GetErrorCode(xml->parser);
    unsigned long line = XML_GetCurrentLineNumber(xml->parser);
    if (xml->fault.code != 0) {
        if (err != NULL)
            *err = xml->fault;
        return error_context(err, "main.xml, line %lu", line);
    }
    if (code == XML_ERROR_NO_MEMORY)
        return error_set(err, ERROR_MEMORY, "cannot allocate memory for a reader of XML");
    return error_set(err, ERROR_INPUT, "main.xml, line %lu: %s", line, XML_ErrorString(code));
}

int x3p_xml_feed(struct x3p_xml *xml, const char *bytes, size_t count, bool last,
                 struct error *err) {
    enum { MOST = 1 << 16 }; /* bytes at once, which the parser takes as an int */
    do {
        size_t some = count < MOST ? count : MOST;
        bool end = last && some == count;
        if (XML_Parse(xml->parser, bytes, (int)some, end) != XML_STATUS_OK)
            return refuse(xml, err);
        xml->fed += some;
        bytes += some;
        count -= some;
        /* The parser keeps a token that does not end, and scans it again with every chunk. */
        XML_Index done = XML_GetCurrentByteIndex(xml->parser);
        if (!end && xml->fed > TOKEN_MOST && (done < 0 || xml->fed - (size_t)done > TOKEN_MOST))
            return error_set(err, ERROR_INPUT,
                             "main.xml, line %lu: a tag or comment of more than %d bytes",
                             (unsigned long)XML_GetCurrentLineNumber(xml->parser), TOKEN_MOST);
    } while (count > 0);
    return 0;
}

/* The gate in front of all JSON: what it takes prints, and the text is taken again and prints the
 * same. */
#include "schema/json/json.h"
#include "tests/support/fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    char *text = text_of(data, size);
    struct error err = {0};
    cJSON *value = NULL, *again = NULL;
    int status = json_parse(text, size, NULL, &value, &err);
    MUST(status == 0 || (status == ERROR_INPUT && *err.text != 0 && value == NULL));
    if (status == 0) {
        char *printed = json_print(value);
        MUST(printed != NULL);
        MUST(json_parse(printed, strlen(printed), NULL, &again, &err) == 0);
        char *twice = json_print(again);
        MUST(twice != NULL && strcmp(printed, twice) == 0);
        free(printed);
        free(twice);
    }
    cJSON_Delete(value);
    cJSON_Delete(again);
    free(text);
    return 0;
}

/* The page's C side (samples/web/page.h) without a browser: a stroke, its log in a fresh world, going back, and the world beside
 * that measures. With words it does what a link says, and prints the hash: wadi-test-page FOLDER VARIANT ACCURACY DRAWS STEPS LOG
 * [FILE ...], where FOLDER has level.json and the FILEs that it names, and LOG is the command log's bytes in a file. */
#include "../../samples/web/page.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int faults;

static void check(int good, const char* what) {
    if (good) return;
    fprintf(stderr, "test_page: %s: %s\n", what, page_error());
    ++faults;
}

static void must(int good, const char* what) {
    check(good, what);
    if (!good) exit(1);
}

/* A file's bytes, a zero behind them, in memory of its own. */
static char* read_file(const char* folder, const char* name, size_t* bytes) {
    char path[1024];
    snprintf(path, sizeof(path), "%s%s%s", folder, folder[0] != 0 ? "/" : "", name);
    FILE* file = fopen(path, "rb");
    if (file == NULL) {
        perror(path);
        exit(1);
    }
    fseek(file, 0, SEEK_END);
    *bytes = (size_t)ftell(file);
    rewind(file);
    char* text = malloc(*bytes + 1);
    if (text == NULL || fread(text, 1, *bytes, file) != *bytes) exit(1);
    text[*bytes] = 0;
    fclose(file);
    return text;
}

static void hand_over(const void* data, size_t bytes) {
    void* memory = page_memory(bytes);
    must(memory != NULL, "memory");
    memcpy(memory, data, bytes);
}

static int replay(char** words, int files) {
    size_t bytes = 0;
    for (int n = 0; n < files; ++n) {
        char* map = read_file(words[0], words[6 + n], &bytes);
        hand_over(map, bytes);
        must(page_add_file(words[6 + n], bytes) == 0, words[6 + n]);
        free(map);
    }
    char* level = read_file(words[0], "level.json", &bytes);
    must(page_open(0, level, words[1], words[2], atoi(words[3]), 0) == 0, "opening the level");
    free(level);
    char* log = read_file("", words[5], &bytes);
    if (bytes > 0) {
        hand_over(log, bytes);
        must(page_play(bytes) == 0, "playing the log");
    }
    free(log);
    must(page_step(0, atoi(words[4])) == 0, "stepping");
    printf("hash %s\n", page_hash(0));
    return 0;
}

static const char level[] = "{ 'format_version': 1, 'name': 'box', 'grid': { 'nx': 48, 'ny': 40, 'dx': 0.1 }, 'dt': 0.01,"
                            "  'sand': [{ 'shape': 'plane', 'height': 0.4 }], 'water': [{ 'shape': 'plane', 'wet': 0.2 }],"
                            "  'material': { 'young_modulus': 2e5, 'cohesion_wet': 4e3, 'exchange_rate': 1e5 },"
                            "  'variants': { 'dry': { 'description': 'No water.', 'water': [] } } }";

/* A level's text has double quotes. */
static const char* text_of_level(void) {
    static char text[sizeof(level)];
    for (size_t n = 0; n < sizeof(level); ++n) text[n] = level[n] == '\'' ? '"' : level[n];
    return text;
}

static void stroke(void) {
    float castle[16 * 16];
    for (int n = 0; n < 16 * 16; ++n) castle[n] = n % 16 < 8 ? 0.5f : 0.25f;
    check(page_brush(1, 1, 2, 3, 2, 0.3, 1, -0.2) == 0, "digging");
    check(page_brush(2, 3, 3, 3, 3, 0.5, 1, 0.3) == 0, "pouring");
    check(page_step(0, 5) == 0, "stepping");
    hand_over(castle, sizeof(castle));
    const int stamp = page_make_stamp(16, 16);
    check(stamp > 0 && page_press(stamp, 1, 1, 1, 2.6, 2.6, 0.4) == 0, "a castle");
    check(page_set_material(0, "exchange_rate", 5e4) == 0, "another material");
    check(page_advance(0.0501, 8) == 5, "five steps of the clock");
}

int main(int count, char** words) {
    if (count > 6) return replay(words + 1, count - 7);
    char before[17], after[17];
    must(page_open(0, text_of_level(), "", "balanced", 7, 2) == 0, "opening");
    const double* numbers = page_numbers();
    check(numbers != NULL && numbers[PAGE_NX] == 48 && numbers[PAGE_NY] == 40 && numbers[PAGE_DT] == 0.01 &&
              numbers[PAGE_STEPS] == 0,
          "numbers");
    check(page_material("young_modulus") == 2e5, "a number of the material");
    check(page_material("no_such_number") != page_material("no_such_number"), "NaN for none"); /* NaN alone is not itself */
    stroke();
    const float *sand = page_output(PAGE_SAND_DEPTH), *dug = sand + 20 * page_row_floats(PAGE_SAND_DEPTH) + 22;
    check(sand != NULL && *dug < 0.35f, "what was dug away is gone from the output");
    strcpy(before, page_hash(0));

    const int bytes = page_log();
    check(bytes > 0, "the log");
    void* log = malloc((size_t)bytes);
    must(log != NULL, "memory");
    memcpy(log, page_memory((size_t)bytes), (size_t)bytes);

    /* Going back, and a world beside that leaves this one as it is. */
    check(page_keep(0) == 0 && page_step(0, 7) == 0, "keeping");
    strcpy(after, page_hash(0));
    check(strcmp(before, after) != 0, "steps change the state");
    check(page_open(1, text_of_level(), "", "balanced", 7, 2) == 0 && page_back(1, 0) == 0, "the world beside");
    check(strcmp(page_hash(1), before) == 0, "the kept state in the world beside");
    check(page_set_material(1, "young_modulus", 0) == 0 && page_step(1, 3) == 0, "another material beside");
    check(strcmp(page_hash(0), after) == 0, "this world is as it was");
    check(page_close(1) == 0 && page_back(0, 0) == 0 && strcmp(page_hash(0), before) == 0, "going back");

    must(page_open(0, text_of_level(), "", "balanced", 7, 1) == 0, "opening anew");
    hand_over(log, (size_t)bytes);
    check(page_play((size_t)bytes) == 0 && page_step(0, 10) == 0 && strcmp(page_hash(0), before) == 0,
          "the log gives the same state");
    /* Controls: a damaged log is refused, and without the log the state is another. */
    must(page_open(0, text_of_level(), "", "balanced", 7, 1) == 0, "opening anew");
    ((unsigned char*)log)[bytes / 2] ^= 1;
    hand_over(log, (size_t)bytes);
    check(page_play((size_t)bytes) == -1 && page_error()[0] != 0, "a damaged log is refused");
    check(page_step(0, 10) == 0 && strcmp(page_hash(0), before) != 0, "without the log");
    free(log);
    check(page_open(0, text_of_level(), "no_such", "balanced", 7, 1) == -1 && strstr(page_error(), "no_such") != NULL,
          "no such variant");
    check(page_open(0, text_of_level(), "dry", "draft", 0, 1) == 0 && page_numbers()[PAGE_NX] == 24, "a variant, half the cells");
    check(page_close(0) == 0, "closing");
    if (faults == 0) puts("test_page: all held");
    return faults != 0;
}

/* What the page's worker calls: two worlds of one level over wadi.h, in numbers, texts and one shared piece of memory, which is
 * all that JavaScript and WebAssembly have in common. World 0 is the one that is seen; world 1 measures what its effects cost. A
 * call that fails returns -1, and page_error says why. */
#ifndef PAGE_H
#define PAGE_H
#include <stddef.h>
#include <stdint.h>

/** One line about the last call that failed. */
const char* page_error(void);
/** Memory to hand over texts, files, logs and stamps, of at least so many bytes; the next call may move it. NULL where there is
 * none left. */
void* page_memory(size_t bytes);
/** The `bytes` in page_memory are the level's file of this name (for page_open); a new level forgets them. */
int page_add_file(const char* name, size_t bytes);
void page_forget_files(void);
/** Makes a world from the text of a level. variant: one of the level's, "" = none. accuracy: a preset's name. draws: a sum of 1 =
 * foam, 2 = wet ground, 4 = muddy water. threads: of the CPU backend. */
int page_open(int which, const char* json, const char* variant, const char* accuracy, int draws, int threads);
int page_close(int which);

/** What world 0 is: columns and rows, side of a cell [m], time step [s], the level's length [s], steps so far, time so far [s].
 */
enum { PAGE_NX, PAGE_NY, PAGE_DX, PAGE_DT, PAGE_DURATION, PAGE_STEPS, PAGE_TIME, PAGE_NUMBERS };
const double* page_numbers(void);
/** Takes host time [s] like wadi_world_update, at most `most` steps, and waits for them. Returns the steps that were taken. */
int page_advance(double seconds, int most);
/** Takes so many steps and waits for them. */
int page_step(int which, int steps);

/** The outputs that a picture is drawn from, in this order. */
enum {
    PAGE_SAND_SURFACE,
    PAGE_SAND_DEPTH,
    PAGE_WATER_DEPTH,
    PAGE_SATURATION,
    PAGE_FOAM,
    PAGE_FLOW,
    PAGE_SAND_VELOCITY,
    PAGE_WETNESS,
    PAGE_SILT,
    PAGE_OUTPUTS
};
/** Where output n of world 0 lies: its first cell; *floats: of a row, padding included. NULL = none yet. */
const float* page_output(int n);
int page_row_floats(int n);

/** A brush or capsule on a layer of wadi.h ahead of the next step. */
int page_brush(int layer, double x0, double y0, double x1, double y1, double radius, double softness, double amount);
/** A stamp of nx * ny floats in page_memory; returns its number. */
int page_make_stamp(int nx, int ny);
int page_press(int stamp, int layer, double x0, double y0, double x1, double y1, double amount);
/** A number of the material, as level files name it; NaN where there is none of this name. */
double page_material(const char* name);
int page_set_material(int which, const char* name, double value);

/** The state's hash as 16 hexadecimal digits; NULL on failure. */
const char* page_hash(int which);
/** The command log of world 0 in page_memory; returns its bytes. */
int page_log(void);
/** Plays the log of so many bytes in page_memory in a fresh world 0. */
int page_play(size_t bytes);

/** Keeps the state of world 0 as number `slot`, 0 ... PAGE_SLOTS - 1, and brings a world to a kept one. */
enum { PAGE_SLOTS = 9 };
int page_keep(int slot);
int page_back(int which, int slot);
#endif

/* The plugin's headers alone, as C99. */
#include <wadi/wadi.h>
#include <wadi/wadi_cuda.h>
int wadi_header_is_c99(void) { return (int)wadi_default_world_info().struct_size; }

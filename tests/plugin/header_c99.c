/* The plugin's header alone, as C99. */
#include <wadi/wadi.h>
int wadi_header_is_c99(void) { return (int)wadi_default_world_info().struct_size; }

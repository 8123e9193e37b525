// volk's implementation, compiled into this target alone and hidden: its data symbols share their names with libvulkan's
// functions and must not be seen by anyone else in the process.
#define VOLK_IMPLEMENTATION
#include <volk.h>

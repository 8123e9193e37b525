/* Stands for the library of NVIDIA's driver that tells clocks: GPUs named FAKE_GPUS (separated by |), whose clock falls by
   10 MHz from 1980 with every reading. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char* name_of(unsigned index) {
    const char* names = getenv("FAKE_GPUS");
    while (names != NULL && index-- > 0) {
        names = strchr(names, '|');
        if (names != NULL) ++names;
    }
    return names;
}

int nvmlInit_v2(void) { return 0; }
int nvmlShutdown(void) { return 0; }

int nvmlDeviceGetCount_v2(unsigned* count) {
    for (*count = 0; name_of(*count) != NULL;) ++*count;
    return 0;
}

int nvmlDeviceGetHandleByIndex_v2(unsigned index, void** gpu) {
    *gpu = (void*)name_of(index);
    return *gpu == NULL;
}

int nvmlDeviceGetName(void* gpu, char* name, unsigned bytes) {
    return snprintf(name, bytes, "%.*s", (int)strcspn(gpu, "|"), (const char*)gpu) >= (int)bytes;
}

int nvmlDeviceGetClockInfo(void* gpu, int type, unsigned* clock) {
    static unsigned readings = 0;
    *clock = 1980 - 10 * readings++;
    return gpu == NULL || type != 1;
}

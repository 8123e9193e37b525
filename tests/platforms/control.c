/* Controls of the lanes' judgement: `control HASH STATUS` prints HASH as the smallest host does and ends with STATUS, `control
   HASH hang` does not end. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int main(int argc, char** argv) {
    if (argc != 3) {
        fprintf(stderr, "Usage: control HASH STATUS, or control HASH hang\n");
        return 2;
    }
    printf("hash %s\n", argv[1]);
    fflush(stdout);
    volatile int hangs = strcmp(argv[2], "hang") == 0;
    while (hangs) continue;
    return atoi(argv[2]);
}

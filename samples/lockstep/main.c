/* Two players in two processes, each with a world of its own, one on the CPU and one on a Vulkan device. They send each other
 * what they do, never what the worlds hold, and compare hashes of every step. README.md says how. */
#define _POSIX_C_SOURCE 200809L
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#include <wadi/wadi.h>

enum { STEPS_PER_TURN = 10, TURNS = 12, EDITS_PER_TURN = 3, IN_STEP = 0, FAILED = 1, DESYNC = 3, NO_DEVICE = 77 };

static void check(wadi_result result) {
    if (result == WADI_OK) return;
    fprintf(stderr, "%s\n", wadi_get_last_error());
    exit(result == WADI_ERROR_NOT_FOUND ? NO_DEVICE : FAILED);
}

/* A message goes through a stream socket in parts. 0: the other player is gone, and has said why. */
static int transfer(int socket, void* data, size_t size, int out) {
    char* at = data;
    while (size > 0) {
        const ssize_t done = out ? write(socket, at, size) : read(socket, at, size);
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) return 0;
        at += done;
        size -= (size_t)done;
    }
    return 1;
}
static void* bytes(size_t size) {
    void* const made = malloc(size);
    if (!made) exit(FAILED);
    return made;
}

/* What a player says after each turn. The commands come behind it. */
typedef struct turn_message {
    uint64_t hashes[STEPS_PER_TURN]; /* after each step of the turn that is over */
    uint64_t command_bytes;
} turn_message;

static double chance(uint32_t* seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / 16777216.0;
}

/* One digs where the other heaps, in the same steps: what comes first decides how much there is to dig. Each moves a tap, too. */
static void command(wadi_world_id world, uint64_t player, uint64_t first_step, uint32_t* seed, int with_players) {
    wadi_edit edits[EDITS_PER_TURN];
    for (int n = 0; n < EDITS_PER_TURN; ++n) {
        edits[n] = wadi_default_edit();
        edits[n].layer = WADI_LAYER_SAND;
        edits[n].x0 = 8.0 + chance(seed);
        edits[n].y0 = 6.0 + chance(seed);
        edits[n].radius = 2.0;
        edits[n].amount = player == 1 ? -1.5 : 0.5;
        edits[n].step = first_step + (uint64_t)(2 * n);
        edits[n].player = with_players ? player : 0;
    }
    check(wadi_world_edit(world, edits, EDITS_PER_TURN));
    wadi_source tap = wadi_default_source();
    const wadi_sample rate = {0.0, 0.5 * chance(seed)};
    tap.center[0] = 4.0 + 8.0 * chance(seed);
    tap.center[1] = 3.0;
    tap.rate = &rate;
    tap.rate_count = 1;
    tap.step = first_step;
    tap.player = edits[0].player;
    check(wadi_world_set_source(world, 0, &tap)); /* one tap for both: the higher player's order holds */
}

static wadi_world_id make_world(const char* backend) {
    static float ground[64 * 48], sand[64 * 48];
    for (int j = 0; j < 48; ++j)
        for (int i = 0; i < 64; ++i) {
            ground[64 * j + i] = 0.01f * (float)(i > 32 ? i - 32 : 32 - i);
            sand[64 * j + i] = 0.25f;
        }
    wadi_world_arrays arrays = wadi_default_world_arrays();
    arrays.settings_json = "{'format_version': 1, 'name': 'lockstep', 'grid': {'nx': 64, 'ny': 48, 'dx': 0.25}, 'dt': 0.01}";
    arrays.nx = 64;
    arrays.ny = 48;
    arrays.terrain = ground;
    arrays.sand = sand;
    wadi_device_options options = wadi_default_device_options();
    options.backend = backend;
    wadi_world_id world;
    check(wadi_create_world_from_arrays(&arrays, &options, &world));
    check(wadi_world_set_command_log(world, 1));
    return world;
}

static int play(uint64_t player, const char* backend, int socket, int with_players) {
    const wadi_world_id world = make_world(backend);
    uint32_t seed = (uint32_t)player;
    turn_message mine, theirs;
    for (uint64_t turn = 0; turn < TURNS; ++turn) {
        for (int n = 0; n < STEPS_PER_TURN; ++n) { /* a game takes these in frames, and compares seldom */
            check(wadi_world_step(world, 1));
            check(wadi_world_get_hash(world, &mine.hashes[n]));
        }
        const uint64_t next = (turn + 1) * STEPS_PER_TURN; /* this turn's commands are for the steps of the next */
        command(world, player, next, &seed, with_players);
        size_t size = 0;
        check(wadi_world_get_commands_since(world, next, with_players ? player : 0, NULL, &size));
        void* const commands = bytes(size);
        check(wadi_world_get_commands_since(world, next, with_players ? player : 0, commands, &size));
        mine.command_bytes = size;
        if (!transfer(socket, &mine, sizeof mine, 1) || !transfer(socket, commands, size, 1)) return FAILED;
        if (!transfer(socket, &theirs, sizeof theirs, 0)) return FAILED;
        void* const received = bytes((size_t)theirs.command_bytes);
        if (!transfer(socket, received, (size_t)theirs.command_bytes, 0)) return FAILED;
        for (int n = 0; n < STEPS_PER_TURN; ++n) {
            if (mine.hashes[n] == theirs.hashes[n]) continue;
            if (player == 1)
                printf("desync at step %llu: %016llx here, %016llx there\n",
                       (unsigned long long)(turn * STEPS_PER_TURN + (uint64_t)n + 1), (unsigned long long)mine.hashes[n],
                       (unsigned long long)theirs.hashes[n]);
            return DESYNC;
        }
        check(wadi_world_play_commands(world, received, (size_t)theirs.command_bytes));
        free(received);
        free(commands);
    }
    wadi_world_stats stats = wadi_default_world_stats();
    check(wadi_world_get_stats(world, &stats));
    if (player == 1)
        printf("in step for %d steps: hash %016llx, %.2f m3 of sand moved in, %.2f m3 of water\n", TURNS * STEPS_PER_TURN,
               (unsigned long long)mine.hashes[STEPS_PER_TURN - 1], stats.sand_in, stats.water_in);
    check(wadi_destroy_world(world));
    return IN_STEP;
}

int main(int argc, char** argv) {
    const int with_players = argc < 4 || strcmp(argv[3], "--without-players") != 0;
    if (argc < 3) {
        fprintf(stderr, "usage: wadi-lockstep BACKEND BACKEND [--without-players], for example cpu vulkan; --without-players: "
                        "edits name no player\n");
        return FAILED;
    }
    signal(SIGPIPE, SIG_IGN);
    int sockets[2];
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, sockets) != 0) return FAILED;
    const pid_t child = fork(); /* ahead of every call of the library */
    if (child < 0) return FAILED;
    close(sockets[child == 0 ? 0 : 1]);
    if (child == 0) return play(2, argv[2], sockets[1], with_players);
    const int result = play(1, argv[1], sockets[0], with_players);
    close(sockets[0]);
    int status = 0;
    if (waitpid(child, &status, 0) != child || !WIFEXITED(status)) return FAILED;
    return result == IN_STEP || result == FAILED ? WEXITSTATUS(status) : result; /* of the one who knows why */
}

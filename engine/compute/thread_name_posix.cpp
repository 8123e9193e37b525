#include "engine/compute/thread_name.hpp"
#if defined(__linux__) || defined(__APPLE__)
#include <cstdio>
#include <pthread.h>
#endif

namespace wadi::compute {

void name_this_thread([[maybe_unused]] const char* name) {
#if defined(__linux__)
    char most[16]; // Linux refuses more
    std::snprintf(most, sizeof most, "%s", name);
    pthread_setname_np(pthread_self(), most);
#elif defined(__APPLE__)
    pthread_setname_np(name);
#endif
}

} // namespace wadi::compute

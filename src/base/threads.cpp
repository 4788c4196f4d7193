#include "base/threads.h"

#include <pthread.h>

namespace lumulus {
namespace {

/// A thread that is started to be there: it waits for the gate, which its starter holds.
extern "C" void* waitAtTheGate(void* gate) {
    auto* mutex = static_cast<pthread_mutex_t*>(gate);
    pthread_mutex_lock(mutex);
    pthread_mutex_unlock(mutex);
    return nullptr;
}

}  // namespace

int startableThreads(int wanted) noexcept {
    constexpr int most = 4096;
    static_assert(sizeof(pthread_t) * most <= 64 * 1024, "they lie on the stack");
    pthread_t threads[most];
    pthread_mutex_t gate = PTHREAD_MUTEX_INITIALIZER;
    pthread_attr_t attributes;
    if (pthread_attr_init(&attributes) != 0) return 0;
    pthread_attr_setstacksize(&attributes, 64 * 1024);  // they do nothing
    pthread_mutex_lock(&gate);
    int count = 0;
    while (count < wanted && count < most && pthread_create(&threads[count], &attributes, waitAtTheGate, &gate) == 0)
        ++count;
    pthread_mutex_unlock(&gate);
    for (int i = 0; i < count; ++i) pthread_join(threads[i], nullptr);
    pthread_attr_destroy(&attributes);
    return count;
}

}  // namespace lumulus

#include "threads.h"

#include <omp.h>

namespace replay {

int useThreads(int n) {
    if (n > 0) omp_set_num_threads(n);
    return omp_get_max_threads();
}

}  // namespace replay

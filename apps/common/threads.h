#pragma once

namespace replay {

/// Lets all parallel stages use n threads, or one per core if n is 0. Returns their number.
int useThreads(int n);

}  // namespace replay

#pragma once
#include "free_space.h"

namespace planner {

/// Bends a path so that it is short, smooth and away from surfaces, by the gradient of the
/// map's distance: covariant descent as in CHOMP (Zucker et al., IJRR 2013). The swept
/// robot stays free with each step, so that a free path remains one. Its ends stay.
Path smoothed(const FreeSpace& space, const Path& path_map);

}  // namespace planner

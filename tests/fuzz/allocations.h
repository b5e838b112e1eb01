#pragma once
#include <cstddef>

namespace hgmm::fuzz {

/// Memory that `new` has given out in this program since this object was made, at most at a
/// time [bytes]. For one thread; one object at a time.
class PeakOfAllocations {
 public:
    PeakOfAllocations();
    std::size_t bytes() const;

 private:
    std::size_t before_;
};

}  // namespace hgmm::fuzz

#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hgmm/mixture.h"
#include "hgmm/view_directions.h"

namespace hgmm {

/// What became of rows since the last time: all that an index or a cache has to follow. It
/// drops its rows from `size` on, then enters the updated ones anew.
struct Changes {
    std::size_t size = 0;  ///< rows that there are now
    /// Rows that were altered, added, or took the place of a removed one; rising.
    std::vector<std::uint32_t> updated;
};

/// The one owner of everything that has one row for each surface component: its Gaussian
/// and its view direction. It alone adds, alters and removes rows, and notes what it did.
/// Insert and merge pass takeChanges() to QueryCache::apply, which updates all indices.
class ComponentStore {
 public:
    ComponentStore() = default;
    /// Rows of a saved map; they count as no changes. Both have one row a component.
    ComponentStore(Mixture<3> surfaces, ViewDirections viewDirections);

    const Mixture<3>& surfaces() const { return surfaces_; }
    const ViewDirections& viewDirections() const { return viewDirections_; }
    std::size_t size() const { return surfaces_.size(); }
    bool empty() const { return surfaces_.empty(); }

    /// Returns the row.
    std::uint32_t add(const Gaussian<3>& component, const ViewDirection& view);
    /// @param i < size()
    void set(std::uint32_t i, const Gaussian<3>& component, const ViewDirection& view);
    /// @param i < size()
    void setSupport(std::uint32_t i, float support);
    /// The last row takes the place of row i < size().
    void remove(std::uint32_t i);

    /// What happened since the last call.
    Changes takeChanges();

    /// Heap held [bytes].
    std::size_t liveBytes() const;
    bool operator==(const ComponentStore& o) const {
        return surfaces_ == o.surfaces_ && viewDirections_ == o.viewDirections_;
    }

 private:
    Mixture<3> surfaces_;
    ViewDirections viewDirections_;
    std::vector<std::uint32_t> updated_;
};

}  // namespace hgmm

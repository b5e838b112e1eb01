#pragma once
#include <memory>
#include <string>
#include <vector>

#include "hgmm/evaluation/baseline.h"
#include "hgmm/map.h"

namespace hgmm::evaluation {

/// Size of a map of mixtures.
struct ComponentCount {
    std::size_t surface = 0;  ///< Gaussians of surfaces [1]
    std::size_t free = 0;     ///< Gaussians of free space [1]
};

/// Our map or another one, given scans one by one and asked between them.
class MapUnderTest {
 public:
    virtual ~MapUnderTest() = default;

    virtual const std::string& name() const = 0;
    /// Inserts a scan; its time is remembered.
    void insert(const Scan& scan);
    /// What the map says of each point [m, map frame]. Other maps know a point altogether
    /// or not at all.
    virtual std::vector<Occupancy> occupancy(const Points& points_map) const = 0;
    /// Gaussians of surfaces, and of free space; none for other maps.
    virtual ComponentCount components() const { return {}; }
    /// Size of the saved map [bytes]; 0 for other maps.
    virtual std::size_t savedBytes() const { return 0; }

    /// Times of all insertions so far [ms].
    const std::vector<double>& insert_ms() const { return insert_ms_; }

 protected:
    virtual void insertScan(const Scan& scan) = 0;

 private:
    std::vector<double> insert_ms_;
};

/// An empty map of ours, named "hgmm".
std::unique_ptr<MapUnderTest> oursUnderTest(const MapParams& params);

/// An empty map of another kind, as makeBaseline() takes it. Throws what that throws.
std::unique_ptr<MapUnderTest> baselineUnderTest(const std::string& specification,
                                                SensorKind sensor);

/// Share of the answers that are as `isSo` wants them; 0 for none.
template <class IsSo>
double shareOf(const std::vector<Occupancy>& answers, const IsSo& isSo) {
    std::size_t so = 0;
    for (const Occupancy& answer : answers) so += isSo(answer) ? 1 : 0;
    return answers.empty() ? 0.0
                           : static_cast<double>(so) / static_cast<double>(answers.size());
}

/// P > 0.5 and P < 0.5 of the map's one number, in which unknown counts half.
inline bool saysOccupied(const Occupancy& answer) {
    return answer.probability() > 0.5F;
}
inline bool saysFree(const Occupancy& answer) {
    return answer.probability() < 0.5F;
}

}  // namespace hgmm::evaluation

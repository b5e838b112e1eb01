#include "options/option_tables.h"

#include "hgmm/mrpt_bridge/likelihood_params.h"
#include "hgmm/mrpt_bridge/reading_params.h"
#include "hgmm/mrpt_bridge/render_params.h"
#include "hgmm/params.h"

namespace hgmm::mrpt_bridge {

const OptionTable<ReadingParams>& ReadingParams::options() {
    using P = ReadingParams;
    static const OptionTable<P> table = {
        {"considerInvalidRangesAsFreeSpace", &P::considerInvalidRangesAsFreeSpace,
         "planar lasers: rays flagged invalid, or without range, clear space"},
        {"considerNoReturnsAsFreeSpace", &P::considerNoReturnsAsFreeSpace,
         "rotating lidars: rays without return clear space"},
        {"clearedShareOfRange", &P::clearedShareOfRange, "1", 0, 1,
         "how far such rays clear space, as a share of the range seen beside them"},
        Option<P>("intensityScale", &P::intensityScale, "counts", 1e-6, 1e9,
                  "what intensities of point clouds are divided by; 0: 1, 255 or 65535, as "
                  "the first scan of a map tells")
            .orZero()};
    return table;
}

const OptionTable<LikelihoodParams>& LikelihoodParams::options() {
    using P = LikelihoodParams;
    static const OptionTable<P> table = {
        Option<P>("kernelWidth_m", &P::kernelWidth_m, "m", 0, 10,
                  "standard deviation added to all surfaces; wider finds the pose from "
                  "farther away, narrower is more exact; 0 here and in outlierRatio and "
                  "independentPoints: all three follow the spread of the poses asked about "
                  "before; one that is set fixes all, those left at 0 at 0.02 m, 0.05, 60")
            .basic()
            .formerly("softening_m"),
        Option<P>("outlierRatio", &P::outlierRatio, "1", 1e-9, 1.0 - 1e-9,
                  "share of points that the map need not explain; 0: see kernelWidth_m")
            .orZero(),
        Option<P>("maxPoints", &P::maxPoints, "count", 1, kMaxPoints,
                  "points of a scan that are compared with the map; 0: 60 of a planar "
                  "laser's, 1000 of other scans")
            .basic()
            .orZero(),
        Option<P>("independentPoints", &P::independentPoints, "count", 1, kMaxPoints,
                  "more points count together as this many: errors of neighbours are "
                  "alike; 0: see kernelWidth_m")
            .orZero(),
        {"minRange_m", &P::minRange_m, "m", 0, 1e6, "nearer points are left out"},
        Option<P>("maxRange_m", &P::maxRange_m, "m", 0, 1e6, "farther points are left out")
            .notBelow("minRange_m")};
    return table;
}

const OptionTable<RenderParams>& RenderParams::options() {
    using P = RenderParams;
    static const OptionTable<P> table = {
        {"level", &P::level, "count", 0, 1000, "level of the hierarchy, 0 the finest"},
        {"drawEllipsoids", &P::drawEllipsoids, "the surface components"},
        {"drawFreeSpace", &P::drawFreeSpace,
         "free-space components, as translucent ellipsoids"},
        {"drawVoxels", &P::drawVoxels, "cubes"},
        {"sigmas", &P::sigmas, "sigma", 0.01, 10, "size of the ellipsoids"},
        {"maxEllipsoids", &P::maxEllipsoids, "count", 1, 1e7,
         "only the components with most support are drawn"},
        Option<P>(
            "colour", &P::colour, "1", 0, static_cast<int>(EllipsoidColour::kModality),
            "what colours show: 0 height, 1 weight, 2 P(occ), 3 deviation, 4 modality")
            .formerly("colourByWeight"),
        {"modality", &P::modality,
         "shown if colour is 4: rgb or a name; empty: rgb if the map has it, else its "
         "first"},
        Option<P>("voxelResolution_m", &P::voxelResolution_m, "m", 1e-4, 1e4,
                  "edge of the voxels; 0: derived from the map")
            .orZero(),
        {"minOccupied", &P::minOccupied, "1", 0.01, 0.99, "P(occ) of an occupied voxel"},
        {"generateOccupiedVoxels", &P::generateOccupiedVoxels, "make occupied voxels"},
        {"visibleOccupiedVoxels", &P::visibleOccupiedVoxels, "show occupied voxels"},
        {"generateFreeVoxels", &P::generateFreeVoxels, "make free voxels"},
        {"visibleFreeVoxels", &P::visibleFreeVoxels, "show free voxels"},
        {"generateGridLines", &P::generateGridLines, "edges of all voxels"}};
    return table;
}

const OptionTable<CreationOptions>& CreationOptions::options() {
    using P = CreationOptions;
    static const OptionTable<P> table = {
        Option<P>("load_file", &P::load_file,
                  "saved map (.hgmm) to start from; looked for in the working folder, then "
                  "beside the configuration")
            .basic(),
        {"enableSaveAs3DObject", &P::enableSaveAs3DObject,
         "MRPT's: the map appears in 3D scenes"},
        {"enableObservationLikelihood", &P::enableObservationLikelihood,
         "MRPT's: the map takes part in the likelihood of observations"},
        {"enableObservationInsertion", &P::enableObservationInsertion,
         "MRPT's: observations are inserted"}};
    return table;
}

void ReadingParams::validate() const {
    requireOptionsInRange(*this);
}
bool ReadingParams::operator==(const ReadingParams& o) const {
    return sameOptions(*this, o);
}

void LikelihoodParams::validate() const {
    requireOptionsInRange(*this);
}
bool LikelihoodParams::operator==(const LikelihoodParams& o) const {
    return sameOptions(*this, o);
}

void RenderParams::validate() const {
    requireOptionsInRange(*this);
}
bool RenderParams::operator==(const RenderParams& o) const {
    return sameOptions(*this, o);
}

namespace {

template <typename Struct>
std::vector<const OptionRow*> rowsOf() {
    std::vector<const OptionRow*> rows;
    for (const OptionRow& row : Struct::options()) rows.push_back(&row);
    return rows;
}

std::vector<const OptionRow*> insertionRows() {
    std::vector<const OptionRow*> rows;
    const MapParams params;
    forEachOption(params, [&](const OptionRow& row, const auto&) { rows.push_back(&row); });
    for (const OptionRow& row : ReadingParams::options()) rows.push_back(&row);
    return rows;
}

}  // namespace

const std::vector<SectionRows>& allSections() {
    static const std::vector<SectionRows> sections = {
        {"insertOpts", insertionRows()},
        {"likelihoodOpts", rowsOf<LikelihoodParams>()},
        {"renderOpts", rowsOf<RenderParams>()},
        {"creationOpts", rowsOf<CreationOptions>()}};
    return sections;
}

}  // namespace hgmm::mrpt_bridge

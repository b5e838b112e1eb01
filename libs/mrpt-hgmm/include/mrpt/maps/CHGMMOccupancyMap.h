#pragma once
#include <mrpt/config/CLoadableOptions.h>
#include <mrpt/maps/CMetricMap.h>
#include <mrpt/math/TBoundingBox.h>
#include <mrpt/math/TPoint3D.h>
#include <mrpt/opengl/COctoMapVoxels.h>

#include <memory>
#include <string>

#include "hgmm/map.h"
#include "hgmm/mrpt_bridge/likelihood_params.h"
#include "hgmm/mrpt_bridge/mrpt_compat.h"
#include "hgmm/mrpt_bridge/nearest_neighbours.h"
#include "hgmm/mrpt_bridge/reading_params.h"
#include "hgmm/mrpt_bridge/render_params.h"

namespace hgmm::mrpt_bridge {
class ObservationLikelihood;
class SurfaceMatching;
}  // namespace hgmm::mrpt_bridge

namespace mrpt::maps {

/// A hierarchical Gaussian mixture map (::hgmm::Map) as an MRPT metric map, known as
/// `hgmmMap` in configuration files.
///
/// In sections `<prefix>_hgmmMap_00_{creationOpts,insertOpts,likelihoodOpts,renderOpts}`,
/// keys are the names of the fields below. A key that is not one is reported on stderr with
/// the one that was probably meant; a value that is not a number or out of range throws.
///
/// Observations of the types listed at ::hgmm::mrpt_bridge::observationToScan can be
/// inserted and have a likelihood. Const member functions may be called from several
/// threads at once.
class CHGMMOccupancyMap : public CMetricMap, public ::hgmm::mrpt_bridge::NearestNeighbours {
    DEFINE_SERIALIZABLE(CHGMMOccupancyMap, mrpt::maps)

 public:
    /// Section `_insertOpts`: all fields of ::hgmm::MapParams, flattened, and those of
    /// ::hgmm::mrpt_bridge::ReadingParams. `modalities` are
    /// names separated by commas, where `rgb` is short for `r, g, b`; a map forgets what it
    /// knows of modalities that are not among them any more.
    struct TInsertionOptions : public mrpt::config::CLoadableOptions {
        ::hgmm::MapParams params;
        ::hgmm::mrpt_bridge::ReadingParams reading;

        /// @throws std::invalid_argument naming section, key and value; nothing is changed
        /// then.
        void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                                const std::string& section) override;
        void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                              const std::string& section) const override;
        void dumpToTextStream(std::ostream& out) const override;
    };

    /// Section `_likelihoodOpts`.
    struct TLikelihoodOptions : public mrpt::config::CLoadableOptions,
                                public ::hgmm::mrpt_bridge::LikelihoodParams {
        /// @throws std::invalid_argument naming section, key and value; nothing is changed
        /// then.
        void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                                const std::string& section) override;
        void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                              const std::string& section) const override;
        void dumpToTextStream(std::ostream& out) const override;
    };

    /// Section `_renderOpts`.
    struct TRenderOptions : public mrpt::config::CLoadableOptions,
                            public ::hgmm::mrpt_bridge::RenderParams {
        /// @throws std::invalid_argument naming section, key and value; nothing is changed
        /// then.
        void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                                const std::string& section) override;
        void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                              const std::string& section) const override;
        void dumpToTextStream(std::ostream& out) const override;
    };

    CHGMMOccupancyMap() = default;

    TInsertionOptions insertionOptions;
    TLikelihoodOptions likelihoodOptions;
    TRenderOptions renderOptions;

    /// @name Access to the model
    /// @{

    const ::hgmm::Map& model() const { return model_; }
    /// For changing the model: what was derived from it is dropped by this call, so call it
    /// again before each change. The next inserted observation applies insertionOptions.
    ::hgmm::Map& model();

    /// Inserts a scan that did not come from an MRPT observation.
    /// @throws std::invalid_argument for a malformed scan or insertionOptions out of range.
    ::hgmm::InsertReport insertScan(const ::hgmm::Scan& scan);

    /// Removes the surfaces in a box, as ::hgmm::Map::forget does: for what is known to be
    /// gone.
    /// @param box_map in the map frame [m]
    /// @return how many components were removed
    /// @throws std::invalid_argument for a box that is empty or not finite.
    std::size_t forget(const mrpt::math::TBoundingBox& box_map);
    /// @}

    /// To be called when a filter starts anew in the same map: the likelihood of the next
    /// observation is the one for poses of unknown spread. Clearing and loading do this.
    void forgetPoses();

    /// @name Files: the serialised object in a gz stream, usually `*.hgmm`
    /// @{

    /// Writes a temporary file beside `fileName` and renames it: no reader ever sees half a
    /// map. Follows symbolic links; writes devices and pipes directly.
    /// @param replaceAnyKind whether an existing file that is no map is replaced, too
    /// @throws std::runtime_error if it cannot be written, or if something is in its place
    /// that must not be replaced.
    void saveToFile(const std::string& fileName, bool replaceAnyKind = false) const;
    /// Replaces model and options.
    /// @throws std::runtime_error if the file is missing, truncated, damaged or something
    /// else; the map is unchanged then.
    void loadFromFile(const std::string& fileName);
    /// @}

    /// @name Occupancy, with the signatures of mrpt::maps::COctoMap, at the finest level
    /// @{

    /// P(occ) at a point [m], in [0, 1], where the share that is unknown counts half.
    /// @return false if P(unknown) > 0.5; `prob_occupancy` is 0.5 then.
    bool getPointOccupancy(float x, float y, float z, double& prob_occupancy) const;

    /// Whether a point [m] was seen to be free or occupied: P(unknown) <= 0.5.
    bool isPointWithinOctoMap(float x, float y, float z) const;

    /// The first occupied point, P(occ) >= renderOptions.minOccupied, along a ray.
    /// @param origin where the ray starts [m]
    /// @param direction of any length
    /// @param end where the surface begins [m]; unchanged if there is none. Not the centre
    /// of a cell, as there are no cells.
    /// @param ignoreUnknownCells if false, a ray ends without a hit where P(unknown) > 0.5
    /// @param maxRange [m]; no limit if not positive
    /// @return whether there is an occupied point
    /// @throws std::invalid_argument for an origin or a direction that is not finite, or a
    /// direction of length 0.
    bool castRay(const mrpt::math::TPoint3D& origin, const mrpt::math::TPoint3D& direction,
                 mrpt::math::TPoint3D& end, bool ignoreUnknownCells = false,
                 double maxRange = -1.0) const;

    /// The way to the nearest surface (::hgmm::Map::distance).
    /// @param point in the map frame [m]
    /// @param distance Euclidean [m]; maxDistance if no surface is as near
    /// @param gradient of the distance: the unit vector away from the surface; zero on it,
    /// and if no surface is near
    /// @param stdDev standard deviation of the distance [m]; 0 if no surface is near
    /// @param maxDistance how far to look [m], in [1e-3, 1e6]
    /// @return whether there is a surface within maxDistance and enough hits are behind it
    /// @throws std::invalid_argument for maxDistance out of range.
    bool getDistanceToSurface(const mrpt::math::TPoint3D& point, double& distance,
                              mrpt::math::TVector3D& gradient, double& stdDev,
                              double maxDistance = 5.0) const;
    /// The same without gradient and standard deviation.
    bool getDistanceToSurface(const mrpt::math::TPoint3D& point, double& distance,
                              double maxDistance = 5.0) const;

    /// Replaces the content of `gl_obj` by cubes of one size: set VOXEL_SET_OCCUPIED where
    /// P(occ) >= renderOptions.minOccupied and VOXEL_SET_FREESPACE where P(free) > 0.5, as
    /// renderOptions say. Colours follow gl_obj's colour and visualisation mode, as with
    /// COctoMap; with renderOptions.colour = 4, the mode (usually FIXED) modulates the
    /// modality's colour in occupied voxels. Voxels are made at level renderOptions.level.
    /// @throws std::invalid_argument for options out of range, and for a resolution at
    /// which there would be more than 2^24 voxels.
    void getAsOctoMapVoxels(mrpt::opengl::COctoMapVoxels& gl_obj) const;
    /// @}

    /// @name CMetricMap
    /// @{
    bool isEmpty() const override { return model_.empty(); }
    std::string asString() const override;
    /// Writes `<prefix>.hgmm`, and `<prefix>.3Dscene` unless enableSaveAs3DObject is false.
    void saveMetricMapRepresentationToFile(const std::string& prefix) const override;
    /// Appends what renderOptions ask for, ellipsoids if nothing else, unless
    /// enableSaveAs3DObject is false.
    void getVisualizationInto(mrpt::opengl::CSetOfObjects& objects) const override;
    /// Frees what is kept of the last observations, for all maps of the process.
    void auxParticleFilterCleanUp() override;

    /// Pairs the points of another map with this map's surfaces, as
    /// ::hgmm::mrpt_bridge::SurfaceMatching says, in the horizontal plane: for maps of
    /// planar lasers. mrpt::slam::CICP aligns scans with icpClassic by it (its
    /// Levenberg-Marquardt demands a points map).
    /// @param otherMap a CPointsMap, a map that holds exactly one CSimplePointsMap, or
    /// another CHGMMOccupancyMap, which is matched by its components' means
    /// @param otherMapPose pose of the other map in this one's frame
    /// @throws std::runtime_error for maps of other classes and nullptr
    /// @throws std::invalid_argument if decimation_other_map_points is 0 or not above
    /// offset_other_map_points.
    void determineMatching2D(const CMetricMap* otherMap,
                             const mrpt::poses::CPose2D& otherMapPose,
                             mrpt::tfest::TMatchingPairList& correspondences,
                             const TMatchingParams& params,
                             TMatchingExtraResults& extraResults) const override;
    /// As determineMatching2D, in space.
    void determineMatching3D(const CMetricMap* otherMap,
                             const mrpt::poses::CPose3D& otherMapPose,
                             mrpt::tfest::TMatchingPairList& correspondences,
                             const TMatchingParams& params,
                             TMatchingExtraResults& extraResults) const override;
    /// Share of the other map's points, in [0, 1], that are less than params.maxDistForCorr
    /// from a surface; otherwise as determineMatching3D.
    float compute3DMatchingRatio(const CMetricMap* otherMap,
                                 const mrpt::poses::CPose3D& otherMapPose,
                                 const TMatchingRatioParams& params) const override;
    /// Squared horizontal distance to the nearest surface [m^2]
    /// (::hgmm::Map::horizontalDistance), infinity if the map is empty or the point not
    /// finite.
    float squareDistanceToClosestCorrespondence(float x0, float y0) const override;
    /// The box [m] around all surfaces, with their thickness: 2.4 standard deviations from
    /// the components' means along each principal axis. It holds all points that nn_*
    /// functions return; all 0 if the map is empty.
    auto boundingBox() const -> mrpt::math::TBoundingBoxf HGMM_OVERRIDE_SINCE_2_11_3;
    /// @}

 private:
    const ::hgmm::Map& neighboursModel() const override { return model_; }
    const ::hgmm::mrpt_bridge::SurfaceMatching& neighboursSurfaces() const override;
    void internal_clear() override;
    bool internal_insertObservation(
        const mrpt::obs::CObservation& observation,
        const std::optional<const mrpt::poses::CPose3D>& robotPose) override;
    double internal_computeObservationLikelihood(
        const mrpt::obs::CObservation& observation,
        const mrpt::poses::CPose3D& takenFrom) const override;
    bool internal_canComputeObservationLikelihood(
        const mrpt::obs::CObservation& observation) const override;
    void applyInsertionOptions();
    void OnPostSuccesfulInsertObs(const mrpt::obs::CObservation& observation) override;

    ::hgmm::Map model_;
    /// Of serialisation: copies made through archives (CMultiMetricMap's) lose nothing,
    /// files are small.
    ::hgmm::Encoding encoding_ = ::hgmm::Encoding::exact;
    /// What is made of the model for likelihoods and matching. Copies share it.
    class Caches {
     public:
        Caches();
        Caches(const Caches& o);
        Caches& operator=(const Caches& o);
        ~Caches();

        /// To be called when the model has changed.
        void invalidate();
        const ::hgmm::mrpt_bridge::ObservationLikelihood& likelihood() const;
        ::hgmm::mrpt_bridge::ObservationLikelihood& likelihood();
        const ::hgmm::mrpt_bridge::SurfaceMatching& matching() const;

     private:
        struct Impl;
        std::unique_ptr<Impl> impl_;
    };
    Caches caches_;

    MAP_DEFINITION_START(CHGMMOccupancyMap)
    /// Saved map to start from, if not empty. The model comes from this file, all options
    /// from the configuration (their defaults where it is silent; modalities are those of
    /// the file if the configuration names none). A relative name is looked for in the
    /// working folder, then beside the configuration file.
    std::string load_file;
    TInsertionOptions insertionOpts;
    TLikelihoodOptions likelihoodOpts;
    TRenderOptions renderOpts;
    MAP_DEFINITION_END(CHGMMOccupancyMap)
};

}  // namespace mrpt::maps

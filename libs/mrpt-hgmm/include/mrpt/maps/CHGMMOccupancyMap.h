#pragma once
#include <mrpt/config/CLoadableOptions.h>
#include <mrpt/maps/CMetricMap.h>

#include <string>

#include "hgmm/map.h"
#include "hgmm/mrpt_bridge/ellipsoids.h"
#include "hgmm/mrpt_bridge/likelihood.h"
#include "hgmm/mrpt_bridge/mrpt_compat.h"

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
/// threads at once. Matching against other maps is not available yet.
class CHGMMOccupancyMap : public CMetricMap {
    DEFINE_SERIALIZABLE(CHGMMOccupancyMap, mrpt::maps)

 public:
    /// Section `_insertOpts`: all fields of ::hgmm::MapParams, flattened.
    struct TInsertionOptions : public mrpt::config::CLoadableOptions {
        ::hgmm::MapParams params;

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
    /// @}

    /// @name Files: the serialised object in a gz stream, usually `*.hgmm`
    /// @{

    /// Writes a temporary file beside `fileName` and renames it: no reader ever sees half a
    /// map.
    /// @throws std::runtime_error if it cannot be written.
    void saveToFile(const std::string& fileName) const;
    /// Replaces model and options.
    /// @throws std::runtime_error if the file is missing, truncated, damaged or something
    /// else; the map is unchanged then.
    void loadFromFile(const std::string& fileName);
    /// @}

    /// @name CMetricMap
    /// @{
    bool isEmpty() const override { return model_.empty(); }
    std::string asString() const override;
    /// Writes `<prefix>.hgmm`, and `<prefix>.3Dscene` unless enableSaveAs3DObject is false.
    void saveMetricMapRepresentationToFile(const std::string& prefix) const override;
    /// Appends the ellipsoids of one level, unless enableSaveAs3DObject is false.
    void getVisualizationInto(mrpt::opengl::CSetOfObjects& objects) const override;
    /// Frees the points kept of the last observations.
    void auxParticleFilterCleanUp() override;

    /// Not yet available: throws std::runtime_error.
    void determineMatching2D(const CMetricMap* otherMap,
                             const mrpt::poses::CPose2D& otherMapPose,
                             mrpt::tfest::TMatchingPairList& correspondences,
                             const TMatchingParams& params,
                             TMatchingExtraResults& extraResults) const override;
    /// Not yet available: throws std::runtime_error.
    void determineMatching3D(const CMetricMap* otherMap,
                             const mrpt::poses::CPose3D& otherMapPose,
                             mrpt::tfest::TMatchingPairList& correspondences,
                             const TMatchingParams& params,
                             TMatchingExtraResults& extraResults) const override;
    /// Not yet available: throws std::runtime_error.
    float compute3DMatchingRatio(const CMetricMap* otherMap,
                                 const mrpt::poses::CPose3D& otherMapPose,
                                 const TMatchingRatioParams& params) const override;
    /// Not yet available: throws std::runtime_error.
    float squareDistanceToClosestCorrespondence(float x0, float y0) const override;
    /// @}

 private:
    void internal_clear() override;
    bool internal_insertObservation(
        const mrpt::obs::CObservation& observation,
        const std::optional<const mrpt::poses::CPose3D>& robotPose) override;
    double internal_computeObservationLikelihood(
        const mrpt::obs::CObservation& observation,
        const mrpt::poses::CPose3D& takenFrom) const override;
    bool internal_canComputeObservationLikelihood(
        const mrpt::obs::CObservation& observation) const override;
    void OnPostSuccesfulInsertObs(const mrpt::obs::CObservation& observation) override;

    ::hgmm::Map model_;
    ::hgmm::mrpt_bridge::ObservationLikelihood likelihood_;

    MAP_DEFINITION_START(CHGMMOccupancyMap)
    /// Saved map to start from, if not empty. The model comes from this file, all options
    /// from the configuration (their defaults where it is silent). A relative name is
    /// looked for in the working folder, then beside the configuration file.
    std::string load_file;
    TInsertionOptions insertionOpts;
    TLikelihoodOptions likelihoodOpts;
    TRenderOptions renderOpts;
    MAP_DEFINITION_END(CHGMMOccupancyMap)
};

}  // namespace mrpt::maps

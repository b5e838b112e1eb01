#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/serialization/CArchive.h>

#include <sstream>

#include "display/ellipsoids.h"
#include "display/octomap_voxels.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "hgmm/mrpt_bridge/output_file.h"
#include "localisation/observation_likelihood.h"
#include "localisation/written_maps.h"
#include "map/map_archive.h"
#include "observation/shared_samples.h"
#include "options/modality_warnings.h"
#include "options/point_warnings.h"

namespace bridge = ::hgmm::mrpt_bridge;

namespace mrpt::maps {

IMPLEMENTS_SERIALIZABLE(CHGMMOccupancyMap, CMetricMap, mrpt::maps)

namespace {
/// Comes after runtimeClassId. MRPT_INITIALIZER runs before it where clang compiled it, and
/// would register a class without a name.
[[maybe_unused]] const bool kIsRegistered =
    (mrpt::rtti::registerClass(CLASS_ID(mrpt::maps::CHGMMOccupancyMap)), true);
}  // namespace

::hgmm::Map& CHGMMOccupancyMap::model() {
    caches_.invalidate();
    return model_;
}

void CHGMMOccupancyMap::applyInsertionOptions() {
    // setParams drops derived data, so it is for parameters that did change.
    if (model_.params() != insertionOptions.params)
        model_.setParams(insertionOptions.params);
}

::hgmm::InsertReport CHGMMOccupancyMap::insertScan(const ::hgmm::Scan& scan) {
    applyInsertionOptions();
    bridge::warnOfAbsentModalities(model_, scan);
    const auto report = model().insert(scan);
    bridge::warnOfPoints(report.points, model_.params().filter);
    return report;
}

std::size_t CHGMMOccupancyMap::forget(const mrpt::math::TBoundingBox& box_map) {
    const auto &low = box_map.min, &high = box_map.max;
    return model().forget(
        {Eigen::Vector3d(low.x, low.y, low.z), Eigen::Vector3d(high.x, high.y, high.z)});
}

void CHGMMOccupancyMap::saveToFile(const std::string& fileName, bool replaceAnyKind) const {
    CHGMMOccupancyMap compact(*this);
    compact.encoding_ = ::hgmm::Encoding::compact;
    bridge::saveMapFile(
        compact, fileName,
        replaceAnyKind ? bridge::Replace::anyKind : bridge::Replace::sameKind);
}

void CHGMMOccupancyMap::loadFromFile(const std::string& fileName) {
    // Not an assignment of the whole: observers of this map stay with it.
    CHGMMOccupancyMap loaded = bridge::loadMapFile(fileName);
    model() = std::move(loaded.model_);
    insertionOptions = loaded.insertionOptions;
    likelihoodOptions = loaded.likelihoodOptions;
    renderOptions = loaded.renderOptions;
    genericMapParams = loaded.genericMapParams;
    forgetPoses();
}

void CHGMMOccupancyMap::forgetPoses() {
    caches_.likelihood().forgetPoses();
}

std::string CHGMMOccupancyMap::asString() const {
    std::ostringstream text;
    text << "HGMM map, " << model_.mixture().size() << " components, "
         << model_.levelCount() << " levels";
    return text.str();
}

void CHGMMOccupancyMap::saveMetricMapRepresentationToFile(const std::string& prefix) const {
    saveToFile(prefix + ".hgmm");
    if (!genericMapParams.enableSaveAs3DObject) return;
    mrpt::opengl::COpenGLScene scene;
    scene.insert(getVisualization());
    bridge::OutputFile file({prefix + ".3Dscene", bridge::FileKind::scene});
    bridge::writeObject(file, scene);
    file.commit();
}

void CHGMMOccupancyMap::getVisualizationInto(mrpt::opengl::CSetOfObjects& objects) const {
    if (!genericMapParams.enableSaveAs3DObject) return;
    bridge::appendEllipsoids(model_, renderOptions, objects);
    // After what they would hide: OpenGL blends with what is there already.
    bridge::appendVoxels(model_, renderOptions, objects);
    bridge::appendFreeSpace(model_, renderOptions, objects);
}

void CHGMMOccupancyMap::getAsOctoMapVoxels(mrpt::opengl::COctoMapVoxels& gl_obj) const {
    bridge::fillOctoMapVoxels(model_, renderOptions, gl_obj);
}

void CHGMMOccupancyMap::auxParticleFilterCleanUp() {
    bridge::ObservationLikelihood::forgetObservations();
    bridge::forgetSharedSamples();
}

uint8_t CHGMMOccupancyMap::serializeGetVersion() const {
    return bridge::kArchiveVersion;
}

void CHGMMOccupancyMap::serializeTo(mrpt::serialization::CArchive& out) const {
    const std::uint64_t digest = bridge::writeMap(out, *this, encoding_);
    bridge::WrittenMaps::ofProcess().remember(digest, caches_.likelihood().heritage());
}

void CHGMMOccupancyMap::serializeFrom(mrpt::serialization::CArchive& in, uint8_t version) {
    const std::uint64_t digest = bridge::readMap(in, version, *this);
    const auto original = bridge::WrittenMaps::ofProcess().heritageOf(digest);
    if (original)
        caches_.likelihood().inherit(*original);
    else
        caches_.likelihood().forgetPoses();
}

void CHGMMOccupancyMap::internal_clear() {
    model().clear();
    forgetPoses();
}

bool CHGMMOccupancyMap::internal_insertObservation(
    const mrpt::obs::CObservation& observation,
    const std::optional<const mrpt::poses::CPose3D>& robotPose) {
    if (!bridge::isSupported(observation)) return false;
    bridge::ReadingParams& reading = insertionOptions.reading;
    reading.validate();
    if (!insertionOptions.params.modalities.empty()) {
        bridge::settleIntensityScale(observation, reading);
        const auto scan = bridge::observationToScan(observation, robotPose,
                                                    bridge::Channels::all, reading);
        if (!scan) return false;
        const auto points = insertScan(*scan).points;
        return points.used + points.cut + scan->clearedRays.size() > 0;
    }
    applyInsertionOptions();
    const auto samples = bridge::sharedSamplesOf(observation, model_.params(), reading);
    if (!samples) return false;
    const ::hgmm::Pose T_map_sensor = bridge::sensorPoseInMap(observation, robotPose);
    model().insert(*samples, T_map_sensor);
    bridge::warnOfPoints(samples->points, model_.params().filter);
    return samples->samples_sensor.size() + samples->clearedRays_sensor.size() > 0;
}

double CHGMMOccupancyMap::internal_computeObservationLikelihood(
    const mrpt::obs::CObservation& observation,
    const mrpt::poses::CPose3D& takenFrom) const {
    return caches_.likelihood()(model_, likelihoodOptions, observation, takenFrom);
}

bool CHGMMOccupancyMap::internal_canComputeObservationLikelihood(
    const mrpt::obs::CObservation& observation) const {
    return bridge::isSupported(observation);
}

void CHGMMOccupancyMap::OnPostSuccesfulInsertObs(const mrpt::obs::CObservation&) {
    caches_.invalidate();
}

}  // namespace mrpt::maps

// Recordings that hgmm-import reads: the bytes are the files of a folder
// (RecordingFolder). The files that are there say of which format it is.
#include <memory>
#include <stdexcept>

#include "harness.h"
#include "maps/octree_file.h"
#include "maps/ros_map.h"
#include "pcd_reader.h"
#include "ply_reader.h"
#include "pose_file.h"
#include "recording_folder.h"
#include "sources/kitti.h"
#include "sources/seven_scenes.h"
#include "sources/tum.h"

namespace hgmm::fuzz {

namespace {

using namespace importer;
namespace fs = std::filesystem;

/// Runs what may refuse its input.
template <typename Read>
void tried(Read&& read) {
    try {
        read();
    } catch (const std::runtime_error&) {
    }
}

}  // namespace

void runOne(const std::uint8_t* data, std::size_t size) {
    const RecordingFolder folder(data, size);
    RgbdOptions camera;
    camera.intrinsics = Intrinsics{500, 500, 320, 240};
    if (fs::exists(folder.path("a.pcd"))) tried([&] { readPcd(folder.path("a.pcd")); });
    if (fs::exists(folder.path("a.ply"))) tried([&] { readPly(folder.path("a.ply")); });
    if (fs::exists(folder.path("a.bt"))) tried([&] { readOctree(folder.path("a.bt")); });
    if (fs::exists(folder.path("a.yaml")))
        tried([&] { readRosMap(folder.path("a.yaml"), 0); });
    if (fs::exists(folder.path("poses.txt")))
        tried([&] { readPoseFile(folder.path("poses.txt")); });
    if (fs::exists(folder.path("calib.txt")))
        tried([&] {
            const KittiSource kitti(folder.path(), folder.path("poses.txt"), {}, {});
            for (std::size_t i = 0; i < kitti.size(); ++i) kitti.load(i);
        });
    // Images are MRPT's to read: here are only the lists and poses.
    if (fs::exists(folder.path("depth.txt")))
        tried([&] { const TumSource tum(folder.path(), camera); });
    if (fs::exists(folder.path("0.pose.txt")))
        tried([&] { const SevenScenesSource scenes(folder.path(), {}); });
}

}  // namespace hgmm::fuzz

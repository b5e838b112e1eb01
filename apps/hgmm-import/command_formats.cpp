#include <cmath>
#include <map>

#include "command_line.h"
#include "mrpt_pose.h"
#include "sources/cloud_files.h"
#include "sources/kitti.h"
#include "sources/rawlog.h"
#include "sources/seven_scenes.h"
#include "sources/simplemap.h"
#include "sources/tum.h"

namespace hgmm::importer {
namespace {

Pose toPose(const std::vector<double>& v) {
    if (v.empty()) return {};
    return fromMrpt(mrpt::poses::CPose3D(v[0], v[1], v[2], mrpt::DEG2RAD(v[3]),
                                         mrpt::DEG2RAD(v[4]), mrpt::DEG2RAD(v[5])));
}

void addIntrinsics(CLI::App& command, Arguments& arguments, const std::string& otherwise) {
    command
        .add_option("--intrinsics", arguments.intrinsics,
                    "Pinhole camera of the depth images [pixels]; otherwise " + otherwise)
        ->delimiter(',')
        ->expected(4)
        ->type_name("FX,FY,CX,CY")
        ->check(numbersAbove(0));
}

void addDepthScale(CLI::App& command, Arguments& arguments, const std::string& usual) {
    command
        .add_option(
            "--depth-scale", arguments.unitsPerMetre,
            "Units of the depth images a metre, 1000 for millimetres; otherwise " + usual)
        ->type_name("UNITS_PER_M")
        ->check(numbersAbove(0));
}

void addTolerance(CLI::App& command, Arguments& arguments) {
    command
        .add_option("--tolerance", arguments.match.tolerance_s,
                    "Most between the stamps of a scan and of a pose [s]")
        ->type_name("S")
        ->capture_default_str()
        ->check(CLI::NonNegativeNumber);
}

/// How poses are matched, without the file.
void addMatch(CLI::App& command, Arguments& arguments) {
    const std::map<std::string, MatchBy> ways{{"auto", MatchBy::automatic},
                                              {"stamp", MatchBy::stamp},
                                              {"number", MatchBy::number},
                                              {"order", MatchBy::order}};
    command
        .add_option("--match", arguments.match.by,
                    "What tells the pose of a scan: auto (by stamp or number, and refused "
                    "if in doubt), stamp, number, or order (pose i for file i)")
        ->type_name("HOW")
        ->transform(CLI::CheckedTransformer(ways).description(""));
    command
        .add_option("--first-number", arguments.match.firstNumber,
                    "Number of the file that the first pose belongs to, for pose files "
                    "without numbers or stamps; otherwise told by names and counts")
        ->type_name("N")
        ->check(CLI::NonNegativeNumber);
    addTolerance(command, arguments);
}

/// How clouds are read.
void addCloudOptions(CLI::App& command, Arguments& arguments) {
    command
        .add_option("--units-per-metre", arguments.unitsPerMetre,
                    "Units of the coordinates a metre, 1000 for millimetres; otherwise 1, "
                    "and doubted if ranges are not credible")
        ->type_name("U")
        ->check(numbersAbove(0));
    command
        .add_option("--intensity-scale", arguments.cloud.intensityScale,
                    "What intensities are divided by; otherwise 1, 255 or 65535, told by "
                    "the largest of the recording")
        ->type_name("S")
        ->check(numbersAbove(0));
    const std::map<std::string, CloudChannel> channels{
        {"rgb", CloudChannel::color}, {"intensity", CloudChannel::intensity}};
    command
        .add_option("--channel", arguments.cloud.channel,
                    "Which is kept of clouds that have both: rgb (default) or intensity")
        ->type_name("NAME")
        ->transform(CLI::CheckedTransformer(channels).description(""));
}

CLI::Option* addSensorPose(CLI::App& command, Arguments& arguments) {
    return command
        .add_option("--sensor-pose", arguments.sensorPose,
                    "Where the sensor, the ray origin, sits in that frame "
                    "[m, deg]; otherwise in its origin")
        ->delimiter(',')
        ->expected(6)
        ->type_name("X,Y,Z,YAW,PITCH,ROLL")
        ->check(numbersAbove(-INFINITY));
}

std::unique_ptr<Source> makeCloudFiles(const std::string& suffix,
                                       const Arguments& arguments) {
    return std::make_unique<CloudFilesSource>(arguments.input, suffix, arguments.poses,
                                              arguments.match, toPose(arguments.sensorPose),
                                              arguments.clouds());
}

constexpr const char* kPosesHelp =
    "Poses of the frame that the points are given in, matched by stamp or number: TUM "
    "lines, KITTI lines, g2o vertices, or lines that start with the number of the scan";

}  // namespace

RgbdOptions Arguments::rgbd() const {
    RgbdOptions options;
    if (!intrinsics.empty())
        options.intrinsics =
            Intrinsics{intrinsics[0], intrinsics[1], intrinsics[2], intrinsics[3]};
    options.unitsPerMetre = unitsPerMetre;
    options.tolerance_s = match.tolerance_s;
    return options;
}

CloudOptions Arguments::clouds() const {
    CloudOptions options = cloud;
    options.unitsPerMetre = unitsPerMetre;
    return options;
}

MakeSource addTum(CLI::App& app, Arguments& arguments) {
    auto* command =
        app.add_subcommand("tum",
                           "TUM RGB-D sequence: depth.txt, rgb.txt, groundtruth.txt and "
                           "the PNGs they name. Poses are of the camera's optical frame");
    addOutputs(*command, arguments);
    addIntrinsics(*command, arguments, "told by fr1, fr2 or fr3 in the folder's name");
    addDepthScale(*command, arguments, "5000");
    addTolerance(*command, arguments);
    return [&] { return std::make_unique<TumSource>(arguments.input, arguments.rgbd()); };
}

MakeSource addSevenScenes(CLI::App& app, Arguments& arguments) {
    auto* command = app.add_subcommand(
        "7scenes",
        "7-Scenes sequence: frame-N.depth.png, frame-N.pose.txt, optionally "
        "frame-N.color.jpg and camera-intrinsics.txt. Poses are of the camera's optical "
        "frame; "
        "frame N is stamped N/30 s");
    addOutputs(*command, arguments);
    addIntrinsics(*command, arguments, "camera-intrinsics.txt, or 585,585,320,240");
    addDepthScale(*command, arguments, "1000");
    return [&] {
        return std::make_unique<SevenScenesSource>(arguments.input, arguments.rgbd());
    };
}

MakeSource addKitti(CLI::App& app, Arguments& arguments) {
    auto* command =
        app.add_subcommand("kitti",
                           "KITTI odometry sequence: velodyne/N.bin, calib.txt, optionally "
                           "times.txt. Poses written "
                           "are of the Velodyne, in the world frame of the pose file");
    addOutputs(*command, arguments);
    command
        ->add_option(
            "--poses", arguments.poses,
            "Poses of the left camera, 12 numbers a line, line N (from 0) for N.bin")
        ->required()
        ->type_name("FILE");
    addMatch(*command, arguments);
    addCloudOptions(*command, arguments);
    return [&] {
        return std::make_unique<KittiSource>(arguments.input, arguments.poses,
                                             arguments.match, arguments.clouds());
    };
}

MakeSource addPcd(CLI::App& app, Arguments& arguments) {
    auto* command = app.add_subcommand(
        "pcd",
        "Folder of .pcd files (ascii, binary or binary_compressed; x y z, optionally "
        "intensity and colours). Points that are all zero or not finite are left out");
    addOutputs(*command, arguments);
    auto* poses =
        command->add_option("--poses", arguments.poses, kPosesHelp)->type_name("FILE");
    auto* sensor = addSensorPose(*command, arguments)->needs(poses);
    addMatch(*command, arguments);
    addCloudOptions(*command, arguments);
    command
        ->add_flag("--world-frame", arguments.worldFrame,
                   "Points are in the world frame already, and VIEWPOINT in each file is "
                   "the ray origin; stamped 0.1 s apart")
        ->excludes(poses)
        ->excludes(sensor);
    command->callback([&arguments] {
        if (arguments.poses.empty() && !arguments.worldFrame)
            throw CLI::RequiredError("--poses or --world-frame");
    });
    return [&]() -> std::unique_ptr<Source> {
        if (arguments.worldFrame)
            return std::make_unique<WorldFramePcdSource>(arguments.input,
                                                         arguments.clouds());
        return makeCloudFiles(".pcd", arguments);
    };
}

MakeSource addPly(CLI::App& app, Arguments& arguments) {
    auto* command = app.add_subcommand(
        "ply",
        "Folder of .ply files (ascii or binary; vertices with x y z, optionally intensity "
        "and colours), one for each scan");
    addOutputs(*command, arguments);
    command->add_option("--poses", arguments.poses, kPosesHelp)
        ->required()
        ->type_name("FILE");
    addSensorPose(*command, arguments);
    addMatch(*command, arguments);
    addCloudOptions(*command, arguments);
    return [&] { return makeCloudFiles(".ply", arguments); };
}

MakeSource addSimpleMap(CLI::App& app, Arguments& arguments) {
    auto* command = app.add_subcommand(
        "simplemap",
        "Simple map of MRPT (.simplemap, .simplemap.gz): its scans, and the means of their "
        "poses");
    addOutputs(*command, arguments);
    return [&] { return std::make_unique<SimpleMapSource>(arguments.input); };
}

MakeSource addRawlog(CLI::App& app, Arguments& arguments) {
    auto* command = app.add_subcommand(
        "rawlog",
        "Rawlog of MRPT, in either format: its range scans (planar lasers, depth cameras, "
        "clouds, lidars), with its odometry as poses");
    addOutputs(*command, arguments);
    command->add_option("--poses", arguments.poses, "TUM lines of the robot, not odometry")
        ->type_name("FILE");
    command
        ->add_option(
            "--aperture", arguments.aperture_deg,
            "2D scans: angle from the first ray to the last [deg], where the log is wrong")
        ->type_name("DEG")
        ->check(CLI::Range(0.1, 360.0));
    return [&] {
        return std::make_unique<RawlogSource>(arguments.input, arguments.poses,
                                              arguments.aperture_deg);
    };
}

}  // namespace hgmm::importer

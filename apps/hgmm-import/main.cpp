#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <memory>

#include "import_recording.h"
#include "mrpt_pose.h"
#include "sources/kitti.h"
#include "sources/pcd.h"
#include "sources/rawlog.h"
#include "sources/seven_scenes.h"
#include "sources/simplemap.h"
#include "sources/tum.h"

namespace {

using namespace hgmm::importer;

constexpr int kDone = 0;
constexpr int kBadInput = 1;
constexpr int kWrongUsage = 2;

/// What the command line says.
struct Arguments {
    std::string input, poses;
    std::vector<double> intrinsics, sensorPose, noise;
    bool worldFrame = false;
    std::optional<double> aperture_deg;
    std::size_t step = 1;
    RecordingOutputs outputs;
};

std::optional<Intrinsics> toIntrinsics(const std::vector<double>& v) {
    if (v.empty()) return std::nullopt;
    return Intrinsics{v[0], v[1], v[2], v[3]};
}

hgmm::Pose toPose(const std::vector<double>& v) {
    if (v.empty()) return {};
    return fromMrpt(mrpt::poses::CPose3D(v[0], v[1], v[2], mrpt::DEG2RAD(v[3]),
                                         mrpt::DEG2RAD(v[4]), mrpt::DEG2RAD(v[5])));
}

/// The check of an option: every number finite, and more than above.
CLI::Validator numbersAbove(double above) {
    const auto check = [above](std::string& word) -> std::string {
        double value = NAN;
        const bool isNumber =
            CLI::detail::lexical_cast(word, value) && std::isfinite(value);
        if (isNumber && value > above) return {};
        return "'" + word + "' must be a finite number" +
               (std::isfinite(above) ? " above " + CLI::detail::to_string(above) : "");
    };
    return CLI::Validator(check, "");
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

void addOutputs(CLI::App& command, Arguments& arguments) {
    auto& outputs = arguments.outputs;
    command.add_option("input", arguments.input, "Folder or file of the recording")
        ->required();
    command
        .add_option("-o,--output", outputs.rawlog,
                    "Rawlog to write; needs no files besides it")
        ->required()
        ->type_name("FILE.rawlog");
    command
        .add_option(
            "--poses-out", outputs.poses,
            "Ground truth to write: TUM lines, the robot's pose at each observation")
        ->required()
        ->type_name("FILE.tum");
    command.add_option("--step", arguments.step, "Import every N-th scan only")
        ->type_name("N")
        ->capture_default_str()
        ->check(CLI::Range(std::size_t{1}, std::size_t{1000000}));
    command
        .add_option(
            "--simplemap", outputs.simplemap,
            "Also write poses and scans as an MRPT simple map (held in memory meanwhile)")
        ->type_name("FILE.simplemap");
    command
        .add_option("--cloud", outputs.cloud,
                    "Also write all points as one cloud, in the world frame, for MRPT's "
                    "points maps, which ignore robot poses of point clouds")
        ->type_name("FILE.simplemap");
    auto* actions = command.add_flag(
        "--actions", outputs.actions,
        "Write pairs of movement (from the poses; in 2D for 2D range scans) and sensory "
        "frame, not observations");
    auto* noise =
        command
            .add_option("--odometry-noise", arguments.noise,
                        "Standard deviations of noise added to each movement: of x, y, "
                        "z [m] and of yaw, pitch, roll [deg]; otherwise none")
            ->delimiter(',')
            ->expected(2)
            ->type_name("SIGMA_M,SIGMA_DEG")
            ->check(CLI::NonNegativeNumber)
            ->needs(actions);
    command
        .add_option("--turn-error", outputs.turnErrorPerMetre_deg,
                    "What filters are told of 2D movements: the deviation of the heading "
                    "[deg] per metre")
        ->type_name("DEG_PER_M")
        ->capture_default_str()
        ->check(CLI::NonNegativeNumber)
        ->needs(actions);
    command.add_option("--seed", outputs.seed, "Seed of that noise")
        ->type_name("S")
        ->capture_default_str()
        ->needs(noise);
}

/// Throws CLI::ValidationError if two outputs would overwrite each other.
void requireDistinct(const RecordingOutputs& outputs) {
    const std::vector<std::string> names{outputs.rawlog, outputs.poses, outputs.simplemap,
                                         outputs.cloud};
    for (std::size_t i = 0; i < names.size(); ++i)
        if (!names[i].empty() && std::count(names.begin(), names.end(), names[i]) > 1)
            throw CLI::ValidationError("output", "two outputs have the same name");
}

using MakeSource = std::function<std::unique_ptr<Source>()>;

MakeSource addTum(CLI::App& app, Arguments& arguments) {
    auto* command =
        app.add_subcommand("tum",
                           "TUM RGB-D sequence: depth.txt, rgb.txt, groundtruth.txt and "
                           "the PNGs they name (5000 "
                           "units a metre). Poses are of the camera's optical frame");
    addOutputs(*command, arguments);
    addIntrinsics(*command, arguments, "told by fr1, fr2 or fr3 in the folder's name");
    return [&] {
        return std::make_unique<TumSource>(arguments.input,
                                           toIntrinsics(arguments.intrinsics));
    };
}

MakeSource addSevenScenes(CLI::App& app, Arguments& arguments) {
    auto* command = app.add_subcommand(
        "7scenes",
        "7-Scenes sequence: frame-N.depth.png (mm), frame-N.pose.txt, optionally "
        "frame-N.color.jpg and camera-intrinsics.txt. Poses are of the camera's optical "
        "frame; "
        "frame N is stamped N/30 s");
    addOutputs(*command, arguments);
    addIntrinsics(*command, arguments, "camera-intrinsics.txt, or 585,585,320,240");
    return [&] {
        return std::make_unique<SevenScenesSource>(arguments.input,
                                                   toIntrinsics(arguments.intrinsics));
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
    return [&] { return std::make_unique<KittiSource>(arguments.input, arguments.poses); };
}

MakeSource addPcd(CLI::App& app, Arguments& arguments) {
    auto* command = app.add_subcommand(
        "pcd",
        "Folder of .pcd files in numeric order (ascii, binary or binary_compressed; x y z, "
        "optionally intensity or rgb). Points that are all zero or not finite are left "
        "out");
    addOutputs(*command, arguments);
    auto* poses = command->add_option(
        "--poses", arguments.poses,
        "TUM lines (t x y z qx qy qz qw) or KITTI lines (12 numbers, stamped 0.1 s apart), "
        "pose i "
        "for file i: the pose of the frame that the points are given in");
    poses->type_name("FILE");
    auto* sensor =
        command->add_option("--sensor-pose", arguments.sensorPose,
                            "Where the sensor, the ray origin, sits in that frame "
                            "[m, deg]; otherwise in its origin");
    sensor->delimiter(',')
        ->expected(6)
        ->type_name("X,Y,Z,YAW,PITCH,ROLL")
        ->check(numbersAbove(-INFINITY))
        ->needs(poses);
    auto* world =
        command->add_flag("--world-frame", arguments.worldFrame,
                          "Points are in the world frame already, and VIEWPOINT in each "
                          "file is the ray origin; stamped 0.1 s apart");
    world->excludes(poses)->excludes(sensor);
    command->callback([&arguments] {
        if (arguments.poses.empty() && !arguments.worldFrame)
            throw CLI::RequiredError("--poses or --world-frame");
    });
    return [&]() -> std::unique_ptr<Source> {
        if (arguments.worldFrame)
            return std::make_unique<WorldFramePcdSource>(arguments.input);
        return std::make_unique<PcdSource>(arguments.input, arguments.poses,
                                           toPose(arguments.sensorPose));
    };
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
        "Rawlog of MRPT, in either format: its 2D range scans, with its odometry as poses");
    addOutputs(*command, arguments);
    command->add_option("--poses", arguments.poses, "TUM lines of the robot, not odometry")
        ->type_name("FILE");
    command
        ->add_option("--aperture", arguments.aperture_deg,
                     "Angle from the first ray to the last [deg], where the log is wrong")
        ->type_name("DEG")
        ->check(CLI::Range(0.1, 360.0));
    return [&] {
        return std::make_unique<RawlogSource>(arguments.input, arguments.poses,
                                              arguments.aperture_deg);
    };
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app(
        "Turns recordings of depth cameras and lidars into MRPT rawlogs, with their poses "
        "as ground truth. Exit codes: 0 done, 1 bad input, 2 wrong usage.",
        "hgmm-import");
    app.require_subcommand(1);
    Arguments arguments;
    const std::vector<std::pair<std::string, MakeSource>> formats{
        {"tum", addTum(app, arguments)},
        {"7scenes", addSevenScenes(app, arguments)},
        {"kitti", addKitti(app, arguments)},
        {"pcd", addPcd(app, arguments)},
        {"simplemap", addSimpleMap(app, arguments)},
        {"rawlog", addRawlog(app, arguments)}};
    try {
        app.parse(argc, argv);
        requireDistinct(arguments.outputs);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? kDone : kWrongUsage;
    }
    if (!arguments.noise.empty())
        arguments.outputs.noise = {arguments.noise[0], arguments.noise[1]};
    try {
        for (const auto& [name, makeSource] : formats)
            if (app.got_subcommand(name))
                importRecording(*makeSource(), arguments.outputs, arguments.step);
        return kDone;
    } catch (const std::exception& e) {
        std::cerr << "hgmm-import: " << e.what() << std::endl;
        return kBadInput;
    }
}

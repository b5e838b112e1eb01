#include <cmath>

#include "command_line.h"

namespace hgmm::importer {

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
    command.add_flag("--force", arguments.force,
                     "Replace existing files of other kinds, too");
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

}  // namespace hgmm::importer

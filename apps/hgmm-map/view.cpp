#include <filesystem>

#include "commands.h"
#include "load.h"
#include "made_by_python.h"

namespace maptool {

void view(const ViewOptions& options) {
    using hgmm::mrpt_bridge::FileKind;
    const std::string page =
        options.output.empty()
            ? std::filesystem::path(options.mapFile).replace_extension(".html").string()
            : options.output;
    std::vector<std::string> inputs{options.mapFile};
    std::vector<std::string> arguments{"--output=-", "--up=" + options.up};
    const auto add = [&](const char* name, const std::string& file) {
        if (file.empty()) return;
        inputs.push_back(file);
        arguments.push_back(std::string(name) + "=" + file);
    };
    add("--poses", options.posesFile);
    add("--points", options.pointsFile);
    arguments.insert(arguments.end(), {"--", options.mapFile});
    hgmm::mrpt_bridge::checkOutputs({{page, FileKind::html}}, inputs,
                                    replaceFor(options.force));
    hgmm::mrpt_bridge::writeFile(page, madeByPython("hgmm.view", arguments),
                                 replaceFor(options.force));
    std::printf("%s\n", page.c_str());
}

}  // namespace maptool

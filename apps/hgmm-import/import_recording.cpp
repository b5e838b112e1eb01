#include "import_recording.h"

#include <unistd.h>

#include <iostream>
#include <optional>
#include <stdexcept>

#include "import_tally.h"

namespace hgmm::importer {
namespace {

/// A line that is overwritten as scans pass, on a terminal only.
class Progress {
 public:
    explicit Progress(std::size_t total)
        : total_(total), visible_(isatty(STDERR_FILENO) == 1) {}
    ~Progress() {
        if (visible_) std::cerr << "\r\033[K";
    }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    void show(std::size_t done) const {
        if (visible_)
            std::cerr << "\rimporting scan " << done << " of " << total_ << std::flush;
    }

 private:
    std::size_t total_;
    bool visible_;
};

/// The scan, or nothing if it cannot be read.
std::optional<ImportedScan> tryLoad(const Source& source, std::size_t index,
                                    ImportTally& tally) {
    try {
        return source.load(index);
    } catch (const std::runtime_error& e) {
        tally.addDamaged(e.what());
        return std::nullopt;
    }
}

std::vector<std::string> pathsOf(const std::vector<std::filesystem::path>& files) {
    std::vector<std::string> paths;
    for (const auto& file : files) paths.push_back(file.string());
    return paths;
}

}  // namespace

void importRecording(Source& source, const RecordingOutputs& outputs, std::size_t step) {
    const SourceSummary& summary = source.summary();
    mrpt_bridge::checkOutputs(outputs.files(), pathsOf(summary.files), outputs.replace);
    for (const auto& note : summary.notes) std::cerr << "note: " << note << "\n";
    const std::size_t total = (source.size() + step - 1) / step;
    ImportTally tally;
    RecordingWriter writer(outputs);
    source.prepare();
    {
        const Progress progress(total);
        for (std::size_t i = 0; i < total; ++i) {
            progress.show(i + 1);
            const auto scan = tryLoad(source, i * step, tally);
            if (!scan) continue;
            tally.add(*scan);
            writer.add(*scan);
        }
    }
    tally.check(summary.expectedRange);
    writer.commit();
    std::cout << "imported " << tally.scans() << " scans into " << outputs.rawlog
              << ", poses into " << outputs.poses;
    if (!outputs.simplemap.empty()) std::cout << ", simple map into " << outputs.simplemap;
    std::cout << tally.describe(summary) << std::endl;
}

}  // namespace hgmm::importer

#include "import_recording.h"

#include <unistd.h>

#include <iostream>

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

}  // namespace

void importRecording(const Source& source, const RecordingOutputs& outputs,
                     std::size_t step) {
    for (const auto& note : source.notes()) std::cerr << "note: " << note << "\n";
    const std::size_t total = (source.size() + step - 1) / step;
    std::size_t dropped = 0;
    RecordingWriter writer(outputs);
    {
        const Progress progress(total);
        for (std::size_t i = 0; i < total; ++i) {
            progress.show(i + 1);
            const ImportedScan scan = source.load(i * step);
            dropped += scan.droppedPoints;
            writer.add(scan);
        }
    }
    writer.commit();
    std::cout << "imported " << total << " scans into " << outputs.rawlog << ", poses into "
              << outputs.poses;
    if (!outputs.simplemap.empty()) std::cout << ", simple map into " << outputs.simplemap;
    if (dropped > 0) std::cout << "; left out " << dropped << " points without a return";
    std::cout << std::endl;
}

}  // namespace hgmm::importer

#pragma once
#include <chrono>
#include <cstddef>
#include <string>

namespace replay {

/// Tells on stderr how far a run is: a bar with scans/s and the time left on a terminal,
/// else one plain line for each tenth.
class Progress {
 public:
    /// @param done scans that an earlier run has done
    Progress(std::size_t total, bool quiet, std::size_t done = 0);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// One more scan is done.
    /// @param news shown behind what is told of the scans
    void advance(const std::string& news = {});

 private:
    using Clock = std::chrono::steady_clock;

    void drawBar(double scansPerSecond, const std::string& news) const;
    void printLine(double scansPerSecond, const std::string& news) const;

    std::size_t total_;
    std::size_t doneEarlier_, done_;
    bool quiet_;
    bool terminal_;
    Clock::time_point start_ = Clock::now();
    Clock::time_point drawn_{};
};

}  // namespace replay

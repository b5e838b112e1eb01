#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include "interrupt.h"
#include "scan_source.h"
#include "standard_input.h"

namespace localise {

namespace {

/// A scan with more points is a mistake of the sender's.
constexpr unsigned long kMostPoints = 50'000'000;
constexpr std::size_t kLongestLine = 128;

class StreamSource : public ScanSource {
 public:
    std::optional<TimedScan> next() override {
        const std::string line = input_.readLine(kLongestLine);
        if (line.empty() || replay::interrupted()) return {};
        ++scans_;
        TimedScan timed;
        const unsigned long points = readHeader(line, timed);
        // A header may promise more than ever comes.
        timed.scan.reserve(std::min(points, 1'000'000UL));
        for (unsigned long i = 0; i < points; ++i) {
            std::array<float, 3> p{};
            if (input_.read(p.data(), sizeof p) != sizeof p) {
                if (replay::interrupted()) return {};
                fail("ends after " + std::to_string(i) + " of " + std::to_string(points) +
                     " points");
            }
            timed.scan.pushBack(p[0], p[1], p[2]);
        }
        return timed;
    }

 private:
    /// Returns the number of points.
    unsigned long readHeader(const std::string& line, TimedScan& timed) {
        unsigned long points = 0;
        int read = 0;
        if (std::sscanf(line.c_str(), "scan %lf %lu%n", &timed.time_s, &points, &read) !=
                2 ||
            line.compare(static_cast<std::size_t>(read), std::string::npos, "\n") != 0 ||
            !std::isfinite(timed.time_s) || points > kMostPoints)
            fail("does not begin with a line 'scan TIME POINTS'");
        if (timed.time_s < time_s_) fail("is earlier than the one before");
        time_s_ = timed.time_s;
        return points;
    }

    [[noreturn]] void fail(const std::string& cause) const {
        throw std::runtime_error("stdin: scan " + std::to_string(scans_) + " " + cause);
    }

    StandardInput input_;
    std::size_t scans_ = 0;
    double time_s_ = std::numeric_limits<double>::lowest();  // of the last scan
};

}  // namespace

std::unique_ptr<ScanSource> openStandardInput() {
    return std::make_unique<StreamSource>();
}

}  // namespace localise

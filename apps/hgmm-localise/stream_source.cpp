#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "scan_source.h"

namespace localise {

namespace {

/// A scan with more points is a mistake of the sender's.
constexpr unsigned long kMostPoints = 50'000'000;

class StreamSource : public ScanSource {
 public:
    std::optional<TimedScan> next() override {
        std::array<char, 128> line{};
        if (std::fgets(line.data(), int(line.size()), stdin) == nullptr) return {};
        ++scans_;
        TimedScan timed;
        unsigned long points = 0;
        int read = 0;
        if (std::sscanf(line.data(), "scan %lf %lu%n", &timed.time_s, &points, &read) !=
                2 ||
            line[std::size_t(read)] != '\n' || !std::isfinite(timed.time_s) ||
            points > kMostPoints)
            fail("must begin with a line 'scan TIME POINTS'");
        timed.scan.reserve(points);
        for (unsigned long i = 0; i < points; ++i) {
            std::array<float, 3> p{};
            if (std::fread(p.data(), sizeof p, 1, stdin) != 1)
                fail("ends after " + std::to_string(i) + " of " + std::to_string(points) +
                     " points");
            timed.scan.pushBack(p[0], p[1], p[2]);
        }
        return timed;
    }

 private:
    [[noreturn]] void fail(const std::string& cause) const {
        throw std::runtime_error("stdin: scan " + std::to_string(scans_) + " " + cause);
    }

    std::size_t scans_ = 0;
};

}  // namespace

std::unique_ptr<ScanSource> openStandardInput() {
    return std::make_unique<StreamSource>();
}

}  // namespace localise

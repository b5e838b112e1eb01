#include "progress.h"

#include <unistd.h>

#include <cstdio>

namespace replay {

Progress::Progress(std::size_t total, bool quiet, std::size_t done)
    : total_(total),
      doneEarlier_(done),
      done_(done),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
    if (!quiet_ && terminal_ && done_ > 0) std::fputc('\n', stderr);
}

void Progress::advance(const std::string& news) {
    ++done_;
    if (quiet_) return;
    const Clock::time_point now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - start_).count();
    const double scansPerSecond =
        static_cast<double>(done_ - doneEarlier_) / (seconds > 0 ? seconds : 1e-9);
    if (terminal_) {
        if (done_ < total_ && now - drawn_ < std::chrono::milliseconds(100)) return;
        drawn_ = now;
        drawBar(scansPerSecond, news);
    } else if (done_ * 10 / total_ != (done_ - 1) * 10 / total_) {
        printLine(scansPerSecond, news);
    }
}

void Progress::drawBar(double scansPerSecond, const std::string& news) const {
    constexpr std::size_t width = 30;
    const std::size_t filled = width * done_ / total_;
    const std::string bar = std::string(filled, '#') + std::string(width - filled, '.');
    std::fprintf(stderr, "\r[%s] %zu/%zu scans, %.1f scans/s, ETA %.0f s%s \033[K",
                 bar.c_str(), done_, total_, scansPerSecond,
                 static_cast<double>(total_ - done_) / scansPerSecond, news.c_str());
    std::fflush(stderr);
}

void Progress::printLine(double scansPerSecond, const std::string& news) const {
    std::fprintf(stderr, "%zu/%zu scans, %.1f scans/s, ETA %.0f s%s\n", done_, total_,
                 scansPerSecond, static_cast<double>(total_ - done_) / scansPerSecond,
                 news.c_str());
}

}  // namespace replay

#include "standard_input.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "interrupt.h"

namespace localise {

namespace {

/// Ctrl-C is looked for so often while no bytes come [ms].
constexpr int kPatience_ms = 100;

}  // namespace

bool StandardInput::fill() {
    while (!replay::interrupted()) {
        pollfd input{STDIN_FILENO, POLLIN, 0};
        const int ready = poll(&input, 1, kPatience_ms);
        if (ready == 0 || (ready < 0 && errno == EINTR)) continue;
        const ssize_t got = ::read(STDIN_FILENO, buffer_.data(), buffer_.size());
        if (got < 0 && errno == EINTR) continue;
        if (got < 0)
            throw std::runtime_error(std::string("stdin: ") + std::strerror(errno));
        begin_ = 0;
        end_ = static_cast<std::size_t>(got);
        return got > 0;
    }
    return false;
}

std::size_t StandardInput::read(void* to, std::size_t bytes) {
    std::size_t done = 0;
    while (done < bytes && (begin_ < end_ || fill())) {
        const std::size_t n = std::min(bytes - done, end_ - begin_);
        std::memcpy(static_cast<char*>(to) + done, buffer_.data() + begin_, n);
        begin_ += n;
        done += n;
    }
    return done;
}

std::string StandardInput::readLine(std::size_t mostBytes) {
    std::string line;
    char c = 0;
    while (line.size() < mostBytes && c != '\n' && read(&c, 1) == 1) line += c;
    return line;
}

}  // namespace localise

#include "options/warnings.h"

#include <algorithm>
#include <cctype>
#include <deque>
#include <iostream>
#include <mutex>
#include <numeric>

namespace hgmm::mrpt_bridge {

namespace {

/// What was said. Bounded and locked.
class SaidTexts {
 public:
    /// Whether a text is new.
    bool add(const std::string& text) {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (std::find(texts_.begin(), texts_.end(), text) != texts_.end()) return false;
        texts_.push_back(text);
        if (texts_.size() > kMost) texts_.pop_front();
        return true;
    }
    void forget() {
        const std::lock_guard<std::mutex> lock(mutex_);
        texts_.clear();
    }

 private:
    static constexpr std::size_t kMost = 200;  // [texts]
    std::mutex mutex_;
    std::deque<std::string> texts_;
};

SaidTexts& saidTexts() {
    static SaidTexts texts;
    return texts;
}

int lower(char c) {
    return std::tolower(static_cast<unsigned char>(c));
}

}  // namespace

void warn(const std::string& text) {
    if (saidTexts().add(text)) std::cerr << "[hgmm] warning: " + text + "\n" << std::flush;
}

void forgetWarnings() {
    saidTexts().forget();
}

bool equalsIgnoringCase(const std::string& a, const std::string& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](char x, char y) { return lower(x) == lower(y); });
}

std::string lowerCase(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return static_cast<char>(lower(c)); });
    return text;
}

std::size_t editDistance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced =
                diagonal + (lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row.back();
}

const std::string& nearestName(const std::string& name,
                               const std::vector<std::string>& known) {
    return *std::min_element(known.begin(), known.end(),
                             [&](const std::string& a, const std::string& b) {
                                 return editDistance(name, a) < editDistance(name, b);
                             });
}

std::string listed(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

}  // namespace hgmm::mrpt_bridge

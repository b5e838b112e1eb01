#include "files.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace hgmm::importer {
namespace fs = std::filesystem;
namespace {

bool endsWith(const std::string& text, const std::string& suffix) {
    return text.size() > suffix.size() &&
           text.compare(text.size() - suffix.size(), suffix.size(), suffix) == 0;
}

bool isDigit(char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// The last run of digits before the suffix: "sim_structured_12.pcd" is 12.
long long numberInName(const fs::path& path, const std::string& suffix) {
    std::string name = path.filename().string();
    name.resize(name.size() - suffix.size());
    const auto last = std::find_if(name.rbegin(), name.rend(), isDigit);
    const auto first = std::find_if_not(last, name.rend(), isDigit);
    const std::string digits(first.base(), last.base());
    constexpr std::size_t maxDigits = 18;  // what a long long surely holds
    if (digits.empty() || digits.size() > maxDigits)
        failFile(path,
                 "the name holds no number (of at most 18 digits) that gives its order; "
                 "rename the file, e.g. 000000" +
                     suffix);
    return std::stoll(digits);
}

}  // namespace

void failFile(const fs::path& path, const std::string& what) {
    throw std::runtime_error(path.string() + ": " + what);
}

std::vector<fs::path> listFiles(const fs::path& folder, const std::string& suffix) {
    if (!fs::is_directory(folder))
        failFile(folder, "is no folder; give the recording's folder");
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.is_regular_file() && endsWith(entry.path().filename().string(), suffix))
            files.push_back(entry.path());
    if (files.empty())
        failFile(folder, "holds no *" + suffix + " files; give another folder");
    std::sort(files.begin(), files.end());
    return files;
}

std::vector<NumberedFile> listNumberedFiles(const fs::path& folder,
                                            const std::string& suffix) {
    std::vector<NumberedFile> files;
    for (const auto& path : listFiles(folder, suffix))
        files.push_back({path, numberInName(path, suffix)});
    std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) {
        return a.number != b.number ? a.number < b.number : a.path < b.path;
    });
    return files;
}

std::string readBytes(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in || fs::is_directory(file))
        failFile(file, "cannot be read; check that it is there");
    std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    if (in.bad()) failFile(file, "cannot be read to its end; check the disk");
    return bytes;
}

}  // namespace hgmm::importer

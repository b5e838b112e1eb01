#pragma once
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/serialization/CSerializable.h>

#include <cstdint>
#include <string>

namespace hgmm::evaluation {

/// Reads the entries of a rawlog one after the other, compressed or not, holding one at a
/// time.
class RawlogReader {
 public:
    /// Throws std::runtime_error naming the file if it is missing or empty.
    explicit RawlogReader(const std::string& file);

    /// The next entry; null at the end of the recording or where it is damaged. An entry of
    /// a type that no loaded library knows counts as damage, for what follows cannot be
    /// found.
    mrpt::serialization::CSerializable::Ptr next();

    /// Whole entries read so far.
    std::size_t entries() const { return entries_; }

    /// What is wrong with the file after the last whole entry, and how much of it is lost;
    /// empty as long as all is well.
    const std::string& damage() const { return damage_; }

 private:
    void describeDamage(const std::string& cause);

    std::string file_;
    mrpt::io::CFileGZInputStream stream_;
    std::size_t entries_ = 0;
    std::uint64_t endOfLastEntry_ = 0;  // uncompressed [bytes]
    std::string damage_;
};

}  // namespace hgmm::evaluation

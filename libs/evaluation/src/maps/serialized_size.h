#pragma once
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/CSerializable.h>

#include <cstddef>

namespace hgmm::evaluation {

/// Bytes that MRPT's serialisation of an object takes.
inline std::size_t serializedSize(const mrpt::serialization::CSerializable& object) {
    mrpt::io::CMemoryStream stream;
    mrpt::serialization::archiveFrom(stream) << object;
    return static_cast<std::size_t>(stream.getTotalBytesCount());
}

}  // namespace hgmm::evaluation

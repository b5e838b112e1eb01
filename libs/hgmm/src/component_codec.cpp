#include "component_codec.h"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <stdexcept>

#include "hgmm/conditional.h"
#include "storable.h"

namespace hgmm {

namespace {

constexpr double kBlock_m = 16.0;

/// Positive numbers on a logarithmic scale of `codes` steps.
struct LogScale {
    double low, high;
    int codes;

    int encode(double v) const {
        const double position = std::log(v / low) / std::log(high / low) * (codes - 1);
        return position > 0 ? static_cast<int>(std::lround(std::min(position, codes - 1.0)))
                            : 0;
    }
    double decode(int code) const {
        return low * std::exp(std::log(high / low) * code / (codes - 1));
    }
};

constexpr LogScale kSigma{5e-4, 500.0, 256};
constexpr LogScale kOffDiagonal{1e-6, 1e3, 32767};
constexpr LogScale kSupport{1e-6, 1e12, 65536};
constexpr LogScale kRange{0.05, 1e4, 255};
constexpr LogScale kDistance{1e-3, 1e4, 256};

class Out {
 public:
    explicit Out(std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}
    template <typename T>
    void put(T value) {
        const auto* p = reinterpret_cast<const std::uint8_t*>(&value);
        bytes_.insert(bytes_.end(), p, p + sizeof(T));
    }

 private:
    std::vector<std::uint8_t>& bytes_;
};

class In {
 public:
    In(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
    template <typename T>
    T get() {
        if (size_ - read_ < sizeof(T))
            throw std::out_of_range("saved map: it ends too early");
        T value{};
        std::memcpy(&value, data_ + read_, sizeof(T));
        read_ += sizeof(T);
        return value;
    }
    std::size_t read() const { return read_; }

 private:
    const std::uint8_t* data_;
    std::size_t size_, read_ = 0;
};

using Block = std::array<std::int32_t, 3>;

Block blockOf(const Eigen::Vector3d& p) {
    Block b;
    for (int d = 0; d < 3; ++d)
        b[d] = static_cast<std::int32_t>(std::floor(p[d] / kBlock_m));
    return b;
}

void putPlace(Out& out, const Block& block, const Eigen::Vector3d& mean,
              const Eigen::Matrix3d& covariance, double support) {
    for (int d = 0; d < 3; ++d) {
        const double inside = mean[d] / kBlock_m - block[d];
        out.put(static_cast<std::uint16_t>(std::min(inside * 65536, 65535.0)));
    }
    const Eigen::Matrix3d L = covariance.llt().matrixL();
    for (int d = 0; d < 3; ++d) out.put(static_cast<std::uint8_t>(kSigma.encode(L(d, d))));
    for (const double v : {L(1, 0), L(2, 0), L(2, 1)}) {
        const int magnitude =
            std::abs(v) < kOffDiagonal.low ? 0 : kOffDiagonal.encode(std::abs(v)) + 1;
        out.put(static_cast<std::uint16_t>(magnitude | (v < 0 ? 0x8000 : 0)));
    }
    out.put(static_cast<std::uint16_t>(kSupport.encode(support)));
}

void getPlace(In& in, const Block& block, Gaussian<3>& g) {
    for (int d = 0; d < 3; ++d)
        g.mean[d] = (block[d] + (in.get<std::uint16_t>() + 0.5) / 65536) * kBlock_m;
    Eigen::Matrix3d L = Eigen::Matrix3d::Zero();
    for (int d = 0; d < 3; ++d) L(d, d) = kSigma.decode(in.get<std::uint8_t>());
    for (double* v : {&L(1, 0), &L(2, 0), &L(2, 1)}) {
        const auto code = in.get<std::uint16_t>();
        const int magnitude = code & 0x7FFF;
        *v = magnitude == 0 ? 0.0 : kOffDiagonal.decode(magnitude - 1);
        if ((code & 0x8000) != 0) *v = -*v;
    }
    g.covariance = L * L.transpose();
    g.support = kSupport.decode(in.get<std::uint16_t>());
}

/// Unit vectors on the faces of an octahedron, unfolded to a square [-1, 1]^2.
void putDirection(Out& out, const Eigen::Vector3d& u) {
    const double sum = u.cwiseAbs().sum();
    double a = u.x() / sum, b = u.y() / sum;
    if (u.z() < 0) {
        const double folded = (1 - std::abs(b)) * (a < 0 ? -1 : 1);
        b = (1 - std::abs(a)) * (b < 0 ? -1 : 1);
        a = folded;
    }
    for (const double v : {a, b})
        out.put(static_cast<std::int8_t>(std::lround(std::clamp(v, -1.0, 1.0) * 127)));
}

Eigen::Vector3d getDirection(In& in) {
    double a = in.get<std::int8_t>() / 127.0, b = in.get<std::int8_t>() / 127.0;
    const double z = 1 - std::abs(a) - std::abs(b);
    if (z < 0) {
        const double unfolded = (1 - std::abs(b)) * (a < 0 ? -1 : 1);
        b = (1 - std::abs(a)) * (b < 0 ? -1 : 1);
        a = unfolded;
    }
    return Eigen::Vector3d(a, b, z).normalized();
}

/// Calls record(block, i) for each component, block after block.
template <int D, typename Record>
void forEachBlock(const Mixture<D>& mixture, Out& out, Record&& record) {
    std::map<Block, std::vector<std::size_t>> blocks;
    for (std::size_t i = 0; i < mixture.size(); ++i)
        blocks[blockOf({mixture.mean[0][i], mixture.mean[1][i], mixture.mean[2][i]})]
            .push_back(i);
    out.put(static_cast<std::uint32_t>(blocks.size()));
    for (const auto& [block, members] : blocks) {
        for (const std::int32_t v : block) out.put(v);
        out.put(static_cast<std::uint32_t>(members.size()));
        for (const std::size_t i : members) record(block, i);
    }
}

template <typename Record>
void readBlocks(In& in, Record&& record) {
    const auto blocks = in.get<std::uint32_t>();
    for (std::uint32_t b = 0; b < blocks; ++b) {
        Block block;
        for (std::int32_t& v : block) v = in.get<std::int32_t>();
        const auto members = in.get<std::uint32_t>();
        for (std::uint32_t m = 0; m < members; ++m) record(block);
    }
}

}  // namespace

void encodeSurfaces(const Mixture<3>& mixture, const Views& views,
                    std::vector<std::uint8_t>& bytes) {
    Out out(bytes);
    forEachBlock(mixture, out, [&](const Block& block, std::size_t i) {
        const Gaussian<3> g = mixture[i];
        const View view = views[i];
        putPlace(out, block, g.mean, g.covariance, g.support);
        putDirection(out, view.known() ? view.direction : Eigen::Vector3d::UnitZ());
        out.put(
            static_cast<std::uint8_t>(view.known() ? 1 + kRange.encode(view.range_m) : 0));
    });
}

std::size_t decodeSurfaces(const std::uint8_t* data, std::size_t size, Mixture<3>& mixture,
                           Views& views) {
    In in(data, size);
    readBlocks(in, [&](const Block& block) {
        Gaussian<3> g;
        getPlace(in, block, g);
        View view;
        view.direction = getDirection(in);
        const auto range = in.get<std::uint8_t>();
        if (range == 0) view.direction.setZero();
        if (range > 0) view.range_m = kRange.decode(range - 1);
        mixture.pushBack(storable(g));
        views.pushBack(view);
    });
    return in.read();
}

void encodeFree(const Mixture<4>& mixture, const std::vector<int>& octaves,
                std::vector<std::uint8_t>& bytes) {
    Out out(bytes);
    forEachBlock(mixture, out, [&](const Block& block, std::size_t i) {
        const Gaussian<4> g = mixture[i];
        const RegressedGaussian<4> w(g, 1.0);
        putPlace(out, block, g.mean.head<3>(), g.covariance.topLeftCorner<3, 3>(),
                 g.support);
        out.put(static_cast<std::int8_t>(octaves[i]));
        out.put(static_cast<std::uint8_t>(kDistance.encode(g.mean[3])));
        for (int d = 0; d < 3; ++d)
            out.put(static_cast<std::int8_t>(
                std::lround(std::clamp(w.slope(d) * 100, -127.0, 127.0))));
        out.put(static_cast<std::uint8_t>(kDistance.encode(std::sqrt(w.variance()))));
    });
}

std::size_t decodeFree(const std::uint8_t* data, std::size_t size, Mixture<4>& mixture,
                       std::vector<int>& octaves) {
    In in(data, size);
    readBlocks(in, [&](const Block& block) {
        Gaussian<3> place;
        getPlace(in, block, place);
        octaves.push_back(in.get<std::int8_t>());
        Gaussian<4> g;
        g.support = place.support;
        g.mean.head<3>() = place.mean;
        g.mean[3] = kDistance.decode(in.get<std::uint8_t>());
        Eigen::Vector3d slope;
        for (int d = 0; d < 3; ++d) slope[d] = in.get<std::int8_t>() / 100.0;
        const double sigma = kDistance.decode(in.get<std::uint8_t>());
        const Eigen::Vector3d cross = place.covariance * slope;
        g.covariance.topLeftCorner<3, 3>() = place.covariance;
        g.covariance.topRightCorner<3, 1>() = cross;
        g.covariance.bottomLeftCorner<1, 3>() = cross.transpose();
        g.covariance(3, 3) = sigma * sigma + slope.dot(cross);
        mixture.pushBack(storable(g));
    });
    return in.read();
}

}  // namespace hgmm

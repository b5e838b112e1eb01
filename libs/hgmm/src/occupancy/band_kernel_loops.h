// The loops of bands::Kernel, for one instruction set: that of the file that includes this.
// All is local to that file, for the linker keeps one of several inline functions, and
// might keep that of another instruction set. For the same reason no header of templates
// is included.
#include "occupancy/band_kernel.h"

namespace hgmm::bands {
namespace {  // NOLINT(cert-dcl59-cpp): local, as said above

/// Eight lanes: vectors of GCC and Clang, in as many registers as they take.
typedef float Float8 __attribute__((vector_size(32), may_alias));
typedef int Int8 __attribute__((vector_size(32), may_alias));

inline const Float8& load(const float* lanes) {
    return *reinterpret_cast<const Float8*>(lanes);
}
inline Float8& store(float* lanes) {
    return *reinterpret_cast<Float8*>(lanes);
}
#define HGMM_INLINE __attribute__((always_inline)) inline

HGMM_INLINE Float8 least(const Float8& a, const Float8& b) {
    return a < b ? a : b;
}
HGMM_INLINE Float8 most(const Float8& a, const Float8& b) {
    return a > b ? a : b;
}

/// exp(x) for x <= 0, relative error below 4e-7; 0 below -60, far from denormal numbers.
/// Minimax polynomial on [-ln 2 / 2, ln 2 / 2] after the reduction of Cody and Waite.
HGMM_INLINE Float8 expOfNegative(const Float8& x) {
    constexpr float kLog2E = 1.44269504F, kLn2High = 0.693359375F,
                    kLn2Low = -2.12194440e-4F;
    const Float8 zero = {}, clamped = most(x, zero - 60.F);
    const Int8 n = __builtin_convertvector(clamped * kLog2E - 0.5F, Int8);
    const Float8 k = __builtin_convertvector(n, Float8);
    const Float8 r = (clamped - k * kLn2High) - k * kLn2Low;
    Float8 p = r * 0.001381459821F + 0.008368716913F;
    p = p * r + 0.04166838805F;
    p = p * r + 0.1666652063F;
    p = p * r + 0.4999999345F;
    p = (p * r * r + r) + 1.F;
    const Int8 power = (n + 127) << 23;
    return x < -60.F ? zero : p * reinterpret_cast<const Float8&>(power);
}

/// erfc(z / sqrt 2) / exp(-z^2 / 2) for z >= 0, relative error below 6e-7: t times a
/// minimax polynomial in t = 1 / (1 + .35 z).
HGMM_INLINE Float8 scaledTail(const Float8& z) {
    const Float8 t = 1.F / (1.F + 0.35F * z);
    Float8 p = t * -0.02915784821F + 0.08500502882F;
    p = p * t - 0.01212679321F;
    p = p * t - 0.1619001616F;
    p = p * t + 0.07028131792F;
    p = p * t + 0.064280188F;
    p = p * t + 0.1803379805F;
    p = p * t + 0.24475184F;
    p = p * t + 0.2792687545F;
    p = p * t + 0.2792595461F;
    return p * t;
}

/// Bit k says whether lane k of a comparison is true (-1, not 0).
HGMM_INLINE LaneSet bitsOf(const Int8& isTrue) {
#if defined(__AVX2__)
    return static_cast<unsigned>(
        __builtin_ia32_movmskps256(reinterpret_cast<const Float8&>(isTrue)));
#else
    LaneSet bits = 0;
    for (int k = 0; k < 8; ++k) bits |= (static_cast<unsigned>(isTrue[k]) & 1U) << k;
    return bits;
#endif
}

HGMM_INLINE Float8 absolute(const Float8& v) {
    return most(v, -v);
}

HGMM_INLINE LaneSet firstLanes(int n) {
    return n < kBlock ? (LaneSet{1} << n) - 1 : ~LaneSet{0};
}

LaneSet inside(const Boxes& in, int n, const float* point) {
    LaneSet found = 0;
    for (int i = 0; i < n; i += 8) {
        const auto isWithin = [&](int d) {
            return absolute(point[d] - load(in.centre[d] + i)) <=
                   load(in.halfExtent[d] + i);
        };
        found |= bitsOf(isWithin(0) & isWithin(1) & isWithin(2)) << i;
    }
    return found & firstLanes(n);
}

HGMM_INLINE void place8(const Lanes& in, int i, const float* point, const float* rest,
                        Places& out) {
    const Float8 x = (point[0] - load(in.mean[0] + i)) + rest[0];
    const Float8 y = (point[1] - load(in.mean[1] + i)) + rest[1];
    const Float8 z = (point[2] - load(in.mean[2] + i)) + rest[2];
    const Float8 a = load(in.factor[0] + i) * x;
    const Float8 b = load(in.factor[1] + i) * x + load(in.factor[2] + i) * y;
    const Float8 c = load(in.factor[3] + i) * x + load(in.factor[4] + i) * y +
                     load(in.factor[5] + i) * z;
    const Float8 v0 = load(in.view[0] + i), v1 = load(in.view[1] + i),
                 v2 = load(in.view[2] + i);
    const Float8 height = (v0 * a + v1 * b + v2 * c) / load(in.precision + i);
    // The part along the view goes first: a difference of squares would lose all its
    // digits far from a thin surface.
    const Float8 u = a - height * v0, v = b - height * v1, w = c - height * v2;
    store(out.height + i) = height;
    store(out.beside + i) = u * u + v * v + w * w;
}

void place(const Lanes& in, int n, const float* point, const float* rest, Places& out) {
    for (int i = 0; i < n; i += 8) place8(in, i, point, rest, out);
}

LaneSet placeNear(const Lanes& in, LaneSet set, const float* point, const float* rest,
                  float maxBeside, Places& out) {
    LaneSet near = 0;
    for (LaneSet left = set; left != 0;) {
        const int i = __builtin_ctzll(left) & ~7;
        left &= ~(LaneSet{255} << i);
        place8(in, i, point, rest, out);
        near |= bitsOf(load(out.beside + i) <= maxBeside) << i;
    }
    return near & set;
}

LaneSet within(const Bodies& in, int n, const float* point, float maxSquared,
               float* squared) {
    LaneSet near = 0;
    for (int i = 0; i < n; i += 8) {
        const Float8 x = point[0] - load(in.mean[0] + i);
        const Float8 y = point[1] - load(in.mean[1] + i);
        const Float8 z = point[2] - load(in.mean[2] + i);
        const Float8 a = load(in.factor[0] + i) * x;
        const Float8 b = load(in.factor[1] + i) * x + load(in.factor[2] + i) * y;
        const Float8 c = load(in.factor[3] + i) * x + load(in.factor[4] + i) * y +
                         load(in.factor[5] + i) * z;
        const Float8 sum = a * a + b * b + c * c;
        store(squared + i) = sum;
        near |= bitsOf(sum <= maxSquared) << i;
    }
    return near & firstLanes(n);
}

void evaluate(const Lanes& in, const Places& at, int n, float cut, Densities& out) {
    constexpr float kSqrtTwoPi = 2.50662827F;
    const Float8 zero = {};
    for (int i = 0; i < n; i += 8) {
        const Float8 t = load(at.height + i), beside = load(at.beside + i);
        const Float8 tau = load(in.tau + i), reach = load(in.reach + i);
        const Float8 column = load(in.peak + i) * expOfNegative(-0.5F * beside);
        const Float8 extent = expOfNegative(-0.5F * load(in.sharpness + i) * beside);
        // Along the view a hit is N(t; 0, tau^2). Free points have the mass of a normal
        // number between low and high.
        const Float8 low = -t / tau, high = (reach - t) / tau;
        const Float8 pLow = expOfNegative(-0.5F * low * low);
        const Float8 pHigh = expOfNegative(-0.5F * high * high);
        const Float8 tailLow = pLow * scaledTail(low > 0.F ? low : -low);
        const Float8 tailHigh = pHigh * scaledTail(high > 0.F ? high : -high);
        const Float8 above = high > 0.F ? tailHigh : 2.F - tailHigh;
        const Float8 mass =
            most(0.5F * ((low > 0.F ? tailLow : 2.F - tailLow) - above), zero);
        const Float8 width = load(in.width + i);
        const Float8 fall = t > width ? width / t : zero + 1.F;
        const Float8 free =
            column * mass * (tau * kSqrtTwoPi * load(in.freePerMetre + i)) * fall;
        store(out.occupied + i) = column * pLow;
        store(out.known + i) = most(extent * pLow - cut, zero);
        store(out.freeAtHits + i) = free * pLow;
        store(out.freePassed + i) = free * (1.F - pLow);

        // W of free points is N(t, tau^2) cut to [0, reach].
        const Float8 perMass = 1.F / most(mass * kSqrtTwoPi, zero + 1e-12F);
        const Float8 shift = (pLow - pHigh) * perMass;
        const Float8 meanW = least(most(t + tau * shift, zero), reach);
        const Float8 spread = 1.F + (low * pLow - high * pHigh) * perMass - shift * shift;
        store(out.meanW + i) = meanW;
        store(out.meanSquaredW + i) =
            least(meanW * meanW + tau * tau * most(spread, zero), reach * meanW);
    }
}

void normalFall(float* squared, int n) {
    for (int i = 0; i < n; i += 8)
        store(squared + i) = expOfNegative(-0.5F * load(squared + i));
}

#undef HGMM_INLINE

}  // namespace
}  // namespace hgmm::bands

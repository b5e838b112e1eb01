#include "hgmm/evaluation/picture.h"

#include <png.h>

#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>

#include "hgmm/mrpt_bridge/output_file.h"

namespace hgmm::evaluation {
namespace {

/// Few colours take one byte for a pixel instead of three, which compresses far better.
struct Palette {
    std::string colours;  // RGB
    std::string pixels;   // index of each
};

std::optional<Palette> paletteOf(const Picture& picture) {
    constexpr std::size_t most = 256;
    std::map<std::uint32_t, char> indices;
    Palette palette;
    for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
        const std::uint8_t* p = &picture.rgb[i];
        const std::uint32_t colour = (std::uint32_t(p[0]) << 16U) |
                                     (std::uint32_t(p[1]) << 8U) | std::uint32_t(p[2]);
        const auto [entry, isNew] =
            indices.emplace(colour, static_cast<char>(indices.size()));
        if (indices.size() > most) return std::nullopt;
        if (isNew) palette.colours.append(reinterpret_cast<const char*>(p), 3);
        palette.pixels += entry->second;
    }
    return palette;
}

}  // namespace

Picture besideEachOther(const std::vector<Picture>& pictures) {
    constexpr int gap_px = 12;
    if (pictures.empty()) throw std::invalid_argument("there are no pictures to join");
    Picture joined;
    joined.width_px = -gap_px;
    for (const Picture& p : pictures) {
        joined.width_px += gap_px + p.width_px;
        joined.height_px = std::max(joined.height_px, p.height_px);
    }
    const auto stride = 3 * static_cast<std::size_t>(joined.width_px);
    joined.rgb.assign(stride * static_cast<std::size_t>(joined.height_px), 255);
    std::size_t left = 0;
    for (const Picture& p : pictures) {
        const auto width = 3 * static_cast<std::size_t>(p.width_px);
        for (std::size_t y = 0; y < static_cast<std::size_t>(p.height_px); ++y)
            std::copy_n(&p.rgb[y * width], width, &joined.rgb[y * stride + left]);
        left += width + 3 * gap_px;
    }
    return joined;
}

std::string pngOf(const Picture& picture) {
    if (picture.width_px <= 0 || picture.height_px <= 0 ||
        picture.rgb.size() !=
            3 * static_cast<std::size_t>(picture.width_px) * picture.height_px)
        throw std::invalid_argument("a picture without pixels, or with too few or many");
    const std::optional<Palette> palette = paletteOf(picture);
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(picture.width_px);
    image.height = static_cast<png_uint_32>(picture.height_px);
    image.format = palette ? PNG_FORMAT_RGB_COLORMAP : PNG_FORMAT_RGB;
    if (palette)
        image.colormap_entries = static_cast<png_uint_32>(palette->colours.size() / 3);
    const void* pixels = palette ? static_cast<const void*>(palette->pixels.data())
                                 : static_cast<const void*>(picture.rgb.data());
    const void* colours = palette ? palette->colours.data() : nullptr;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::string png(size, '\0');
    if (png_image_write_to_memory(&image, png.data(), &size, 0, pixels, 0, colours) == 0)
        throw std::runtime_error(std::string("a picture cannot be written: ") +
                                 image.message);
    png.resize(size);
    return png;
}

void writePng(const Picture& picture, const std::string& file) {
    mrpt_bridge::writeFile(file, pngOf(picture));
}

std::string base64(const std::string& bytes) {
    constexpr char digits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = (group << 8U) | (k < n ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            out += k <= n ? digits[(group >> (18U - 6U * k)) & 63U] : '=';
    }
    return out;
}

}  // namespace hgmm::evaluation

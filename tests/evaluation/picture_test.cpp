#include "hgmm/evaluation/picture.h"

#include <mrpt/img/CImage.h>

#include <cstdint>
#include <fstream>
#include <iterator>

#include "hgmm/evaluation/split.h"
#include "scratch_folder.h"

namespace hgmm::evaluation {
namespace {

/// Random pixels of so many colours.
Picture speckles(int width_px, int height_px, int colours) {
    std::mt19937_64 stream(7);
    Picture picture{width_px, height_px, {}};
    for (int i = 0; i < width_px * height_px; ++i) {
        const auto c = static_cast<unsigned>(nextUniform(stream) * colours);
        for (const unsigned v : {c * 37U, c * 101U + c / 256U, 255U - c % 256U})
            picture.rgb.push_back(static_cast<std::uint8_t>(v));
    }
    return picture;
}

class PicturePng : public ScratchFolder {
 protected:
    /// As another library reads it.
    Picture readBack(const std::string& file) const {
        mrpt::img::CImage image;
        EXPECT_TRUE(image.loadFromFile(path(file)));
        Picture picture{int(image.getWidth()), int(image.getHeight()), {}};
        for (int y = 0; y < picture.height_px; ++y)
            for (int x = 0; x < picture.width_px; ++x) {
                // MRPT keeps blue first.
                for (const unsigned channel : {2U, 1U, 0U})
                    picture.rgb.push_back(*image(x, y, channel));
            }
        return picture;
    }
};

TEST_F(PicturePng, AnotherLibraryReadsTheSamePixels) {
    // Up to 256 colours there is a palette, from 257 on there is none.
    for (const int colours : {1, 2, 200, 5000}) {
        const Picture picture = speckles(61, 47, colours);
        writePng(picture, path("a.png"));
        const Picture back = readBack("a.png");
        EXPECT_EQ(back.width_px, 61);
        EXPECT_EQ(back.height_px, 47);
        EXPECT_TRUE(back.rgb == picture.rgb) << colours << " colours";
    }
}

TEST_F(PicturePng, FewColoursTakeAByteAPixelAtMost) {
    EXPECT_LT(pngOf(speckles(300, 300, 200)).size(), 300U * 300U + 2000U);
}

TEST_F(PicturePng, AFileHoldsTheSameBytes) {
    const Picture picture = speckles(10, 20, 999);
    writePng(picture, path("a.png"));
    std::ifstream in(path("a.png"), std::ios::binary);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), pngOf(picture));
    EXPECT_THROW(writePng(picture, path("missing/a.png")), std::runtime_error);
}

TEST_F(PicturePng, RefusesPicturesWithoutTheirPixels) {
    EXPECT_THROW(pngOf({}), std::invalid_argument);
    EXPECT_THROW(pngOf({2, 2, std::vector<std::uint8_t>(11)}), std::invalid_argument);
    EXPECT_THROW(pngOf({-2, -2, std::vector<std::uint8_t>(12)}), std::invalid_argument);
}

TEST(Base64, EncodesTheExamplesOfItsStandard) {
    // RFC 4648, section 10.
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foob"), "Zm9vYg==");
    EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64("\xFB\xFF\xBF"), "+/+/");
    EXPECT_EQ(base64(std::string(1, '\0')), "AA==");
}

}  // namespace
}  // namespace hgmm::evaluation

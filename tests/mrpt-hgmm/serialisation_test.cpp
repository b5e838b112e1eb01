#include <gtest/gtest.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/serialization/CArchive.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "edited_options.h"
#include "observations.h"

namespace fs = std::filesystem;
using mrpt::maps::CHGMMOccupancyMap;
using mrpt::poses::CPose3D;

namespace {

CHGMMOccupancyMap filledMap() {
    CHGMMOccupancyMap map;
    map.insertObservation(*observations::laser(), CPose3D(100, 50, 0.2, 0, 0, 0));
    map.insertObservation(*observations::cloud(), CPose3D(101, 50, 0.2, 0.4, 0, 0));
    return map;
}

/// Files are compact: they hold what the map's own compact buffer holds, not every bit.
hgmm::Map asFiled(const hgmm::Map& map) {
    const std::vector<std::uint8_t> buffer = map.save(hgmm::Encoding::compact);
    return hgmm::Map::load(buffer.data(), buffer.size());
}

std::vector<char> bytesOf(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void write(const std::string& file, const std::vector<char>& bytes) {
    std::ofstream(file, std::ios::binary).write(bytes.data(), bytes.size());
}

/// A folder of this test's own, removed with it.
class Serialisation : public ::testing::Test {
 protected:
    Serialisation()
        : folder(fs::path(::testing::TempDir()) /
                 ("hgmm-" + std::to_string(::getpid()) +
                  ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
        fs::create_directories(folder);
    }
    ~Serialisation() override { fs::remove_all(folder); }
    std::string path(const std::string& name) const { return (folder / name).string(); }

    /// The message with which a file is refused; the map must stay as it was.
    std::string refusal(const std::string& file) const {
        CHGMMOccupancyMap map = filledMap();
        const CHGMMOccupancyMap before = map;
        try {
            map.loadFromFile(file);
        } catch (const std::runtime_error& e) {
            EXPECT_EQ(map.model(), before.model());
            return e.what();
        }
        return "";
    }

    const fs::path folder;
};

// Trap: CMultiMetricMap copies through serialisation, so what is not stored is lost by
// copying.
TEST_F(Serialisation, CopyOfAFilledMapThroughMultiMetricMapIsEqual) {
    auto map = CHGMMOccupancyMap::Create(filledMap());
    edited::change(*map);
    mrpt::maps::CMultiMetricMap original;
    original.maps.push_back(map);
    const mrpt::maps::CMultiMetricMap copy = original;
    const auto copied = copy.mapByClass<CHGMMOccupancyMap>();
    ASSERT_TRUE(copied);
    EXPECT_NE(copied.get(), map.get());
    EXPECT_FALSE(copied->isEmpty());
    EXPECT_EQ(copied->model(), map->model());
    EXPECT_EQ(edited::all(*copied), edited::all(*map));
    const CHGMMOccupancyMap defaults;
    const auto before = edited::all(defaults);
    for (const auto& [name, value] : edited::all(*copied))
        if (name != "likelihood") {
            EXPECT_NE(value, before.at(name)) << name;
        }
    const CPose3D pose(100.1, 50, 0.2, 0, 0, 0);
    EXPECT_EQ(copied->computeObservationLikelihood(*observations::laser(), pose),
              map->computeObservationLikelihood(*observations::laser(), pose));
}

TEST_F(Serialisation, FileRoundTrip) {
    CHGMMOccupancyMap map = filledMap();
    edited::change(map);
    map.saveToFile(path("a.hgmm"));
    CHGMMOccupancyMap loaded;
    loaded.loadFromFile(path("a.hgmm"));
    EXPECT_EQ(loaded.model(), asFiled(map.model()));
    EXPECT_EQ(edited::all(loaded), edited::all(map));
    // What is read is not rounded once more by writing it.
    loaded.saveToFile(path("a.hgmm"));
    CHGMMOccupancyMap again;
    again.loadFromFile(path("a.hgmm"));
    EXPECT_EQ(again.model(), loaded.model());
    // A copy of what was read is exact as any other.
    mrpt::maps::CMultiMetricMap maps;
    maps.maps.push_back(CHGMMOccupancyMap::Create(filledMap()));
    maps.mapByClass<CHGMMOccupancyMap>()->loadFromFile(path("a.hgmm"));
    maps.mapByClass<CHGMMOccupancyMap>()->insertObservation(
        *observations::laser(), CPose3D(100, 50, 0.2, 0.1, 0, 0));
    const mrpt::maps::CMultiMetricMap copy = maps;
    EXPECT_EQ(copy.mapByClass<CHGMMOccupancyMap>()->model(),
              maps.mapByClass<CHGMMOccupancyMap>()->model());

    CHGMMOccupancyMap empty;
    empty.saveToFile(path("a.hgmm"));  // over the old one
    loaded.loadFromFile(path("a.hgmm"));
    EXPECT_TRUE(loaded.isEmpty());
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1)
        << "a temporary file stayed";
}

TEST_F(Serialisation, MissingAndUnwritableFilesAreNamed) {
    EXPECT_NE(refusal(path("none.hgmm")).find("none.hgmm: no such file"),
              std::string::npos);
    EXPECT_NE(refusal(folder.string()).find("not a file"), std::string::npos);
    const CHGMMOccupancyMap map;
    try {
        map.saveToFile(path("no/such/folder.hgmm"));
        FAIL();
    } catch (const std::runtime_error& e) {
        EXPECT_NE(std::string(e.what()).find("folder.hgmm"), std::string::npos);
    }
}

TEST_F(Serialisation, TruncatedFilesAreRefusedAtEveryLength) {
    filledMap().saveToFile(path("whole.hgmm"));
    const auto whole = bytesOf(path("whole.hgmm"));
    std::vector<std::size_t> lengths;
    for (std::size_t k = 0; k < 40; ++k) lengths.push_back(k * whole.size() / 40);
    for (std::size_t k = 1; k <= 12; ++k) lengths.push_back(whole.size() - k);
    for (const std::size_t length : lengths) {
        write(path("cut.hgmm"), {whole.begin(), whole.begin() + length});
        EXPECT_NE(refusal(path("cut.hgmm")).find("cut.hgmm: "), std::string::npos)
            << length;
    }
}

TEST_F(Serialisation, FlippedBitsAreRefusedOrHarmless) {
    const CHGMMOccupancyMap map = filledMap();
    map.saveToFile(path("whole.hgmm"));
    const auto whole = bytesOf(path("whole.hgmm"));
    int refused = 0;
    constexpr std::size_t flips = 200;
    for (std::size_t k = 0; k < flips; ++k) {
        auto bytes = whole;
        bytes[k * whole.size() / flips] ^= static_cast<char>(1 << (k % 8));
        write(path("flip.hgmm"), bytes);
        CHGMMOccupancyMap loaded;
        try {
            loaded.loadFromFile(path("flip.hgmm"));
            EXPECT_EQ(loaded.model(), asFiled(map.model())) << k;
        } catch (const std::runtime_error&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 190);  // a flip in the header's time stamp does no harm
}

// Inside an archive no gzip check sum helps.
TEST_F(Serialisation, DamagedArchivesThrowOrKeepTheModel) {
    const CHGMMOccupancyMap map = filledMap();
    mrpt::io::CMemoryStream stream;
    mrpt::serialization::archiveFrom(stream) << map;
    const auto* data = static_cast<const char*>(stream.getRawBufferData());
    const std::vector<char> whole(data, data + stream.getTotalBytesCount());
    const auto read = [](std::vector<char> bytes) {
        mrpt::io::CMemoryStream in;
        in.assignMemoryNotOwn(bytes.data(), bytes.size());
        auto archive = mrpt::serialization::archiveFrom(in);
        return std::dynamic_pointer_cast<CHGMMOccupancyMap>(archive.ReadObject());
    };
    ASSERT_EQ(read(whole)->model(), map.model());
    for (std::size_t k = 0; k < 50; ++k)
        EXPECT_ANY_THROW(read({whole.begin(), whole.begin() + k * whole.size() / 50})) << k;
    for (std::size_t at = 0; at < whole.size(); at += 1 + at / 100) {
        auto bytes = whole;
        bytes[at] ^= static_cast<char>(1 << (at % 8));
        try {
            const auto loaded = read(bytes);
            if (loaded) {
                EXPECT_EQ(loaded->model(), map.model()) << at;
            }
        } catch (const std::exception&) {
        }
    }
}

// The check sum of gzip is right, the content is not.
TEST_F(Serialisation, DamagedContentIsSaidInPlainWords) {
    mrpt::io::CMemoryStream stream;
    mrpt::serialization::archiveFrom(stream) << filledMap();
    const auto* data = static_cast<const char*>(stream.getRawBufferData());
    const std::vector<char> whole(data, data + stream.getTotalBytesCount());
    int refused = 0;
    for (std::size_t at = 0; at < whole.size(); at += 1 + at / 20) {
        for (const char flip : {'\x01', '\x40', '\x80'}) {
            auto bytes = whole;
            bytes[at] = static_cast<char>(bytes[at] ^ flip);
            {
                mrpt::io::CFileGZOutputStream out(path("damaged.hgmm"));
                out.Write(bytes.data(), bytes.size());
            }
            CHGMMOccupancyMap map;
            try {
                map.loadFromFile(path("damaged.hgmm"));
                continue;  // an option's value
            } catch (const std::runtime_error& e) {
                ++refused;
                const std::string said = e.what();
                EXPECT_EQ(said.rfind(path("damaged.hgmm: "), 0), 0U) << said;
                for (const char* code : {".h:", ".cpp", "[", "std::", "typename", "\n"})
                    EXPECT_EQ(said.find(code), std::string::npos) << at << ": " << said;
                for (const char c : said) EXPECT_TRUE(c >= ' ' && c < 0x7F) << at;
            }
        }
    }
    EXPECT_GT(refused, 200);
}

TEST_F(Serialisation, ForeignFilesAreRefused) {
    write(path("text.hgmm"), {'h', 'e', 'l', 'l', 'o', ' ', 'w', 'o', 'r', 'l', 'd'});
    EXPECT_NE(refusal(path("text.hgmm")).find("text.hgmm: not a saved map"),
              std::string::npos);
    write(path("empty.hgmm"), {});
    EXPECT_NE(refusal(path("empty.hgmm")).find("empty.hgmm: "), std::string::npos);
    {
        mrpt::io::CFileGZOutputStream out(path("pose.hgmm"));
        mrpt::serialization::archiveFrom(out) << CPose3D();
    }
    const std::string said = refusal(path("pose.hgmm"));
    EXPECT_NE(said.find("CPose3D"), std::string::npos) << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << "one line, no call stack: " << said;
    const std::string simplemap =
        std::string(observations::datasets()) + "localization_demo.simplemap.gz";
    EXPECT_NE(refusal(simplemap).find("CSimpleMap"), std::string::npos);
}

TEST_F(Serialisation, LoadFileGivesTheModelAndTheConfigurationTheOptions) {
    CHGMMOccupancyMap map = filledMap();
    edited::change(map.renderOptions);
    map.saveToFile(path("saved.hgmm"));
    {
        std::ofstream ini(path("maps.ini"));
        ini << "[m]\nhgmmMap_count = 1\n[m_hgmmMap_00_creationOpts]\nload_file = "
               "saved.hgmm\n"
            << "[m_hgmmMap_00_likelihoodOpts]\nkernelWidth_m = 0.33\n";
    }
    // The name is relative to the configuration file, which is not in the working folder.
    mrpt::maps::TSetOfMetricMapInitializers definitions;
    definitions.loadFromConfigFileName(path("maps.ini"), "m");
    const mrpt::maps::CMultiMetricMap maps(definitions);
    const auto loaded = maps.mapByClass<CHGMMOccupancyMap>();
    ASSERT_TRUE(loaded);
    EXPECT_EQ(loaded->model(), asFiled(map.model()));
    EXPECT_EQ(loaded->likelihoodOptions.kernelWidth_m, 0.33);
    EXPECT_EQ(edited::values(loaded->renderOptions),
              edited::values(CHGMMOccupancyMap().renderOptions));

    CHGMMOccupancyMap::TMapDefinition missing;
    missing.load_file = path("absent.hgmm");
    EXPECT_THROW(CHGMMOccupancyMap::CreateFromMapDefinition(missing), std::runtime_error);
}

TEST_F(Serialisation, RepresentationIsAMapFileAndAScene) {
    CHGMMOccupancyMap map = filledMap();
    map.saveMetricMapRepresentationToFile(path("map"));
    CHGMMOccupancyMap loaded;
    loaded.loadFromFile(path("map.hgmm"));
    EXPECT_EQ(loaded.model(), asFiled(map.model()));
    mrpt::opengl::COpenGLScene scene;
    EXPECT_TRUE(scene.loadFromFile(path("map.3Dscene")));
    fs::remove(path("map.3Dscene"));
    map.genericMapParams.enableSaveAs3DObject = false;
    map.saveMetricMapRepresentationToFile(path("map"));
    EXPECT_FALSE(fs::exists(path("map.3Dscene")));
}

}  // namespace

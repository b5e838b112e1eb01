#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <set>

#include "hgmm/map.h"
#include "io/checksum.h"

namespace hgmm {
namespace {

std::string errorOfOptions(const std::function<void()>& act) {
    try {
        act();
    } catch (const std::invalid_argument& e) {
        return e.what();
    }
    return "";
}

/// Doubles and ints of the structs, without looking at any table. All of a struct's members
/// but nested structs are such.
template <typename Struct>
std::size_t bytesOfRows() {
    std::size_t bytes = 0;
    const Struct s;
    forEachRow(s, [&](const OptionRow&, const auto& field) { bytes += sizeof(field); });
    return bytes;
}

// A field without a row would be neither saved nor compared.
TEST(OptionTable, HoldsEveryFieldOfEveryStruct) {
    const auto padded = [](std::size_t bytes) { return (bytes + 7) / 8 * 8; };
    EXPECT_EQ(padded(bytesOfRows<FilterParams>()), sizeof(FilterParams));
    EXPECT_EQ(padded(bytesOfRows<NoveltyParams>()), sizeof(NoveltyParams));
    EXPECT_EQ(padded(bytesOfRows<CellParams>()), sizeof(CellParams));
    EXPECT_EQ(bytesOfRows<EmParams>(), sizeof(int) + sizeof(double));
    EXPECT_EQ(bytesOfRows<HierarchyParams>(), sizeof(int) + 4 * sizeof(double));
    EXPECT_EQ(padded(bytesOfRows<FreeSpaceBandParams>()), sizeof(FreeSpaceBandParams));
    EXPECT_EQ(padded(bytesOfRows<FreeSpaceParams>()), sizeof(FreeSpaceParams));
    EXPECT_EQ(padded(bytesOfRows<CoverageParams>()), sizeof(CoverageParams));
    EXPECT_EQ(padded(bytesOfRows<OccupancyParams>()) + sizeof(FreeSpaceBandParams) +
                  sizeof(FreeSpaceParams) + sizeof(CoverageParams),
              sizeof(OccupancyParams));
    EXPECT_EQ(padded(bytesOfRows<CarvingParams>()), sizeof(CarvingParams));
    EXPECT_EQ(padded(bytesOfRows<ModalityParams>()), sizeof(ModalityParams));
    std::size_t stages = 0;
    const MapParams params;
    forEachStage([&](const auto&) { ++stages; }, params);
    EXPECT_EQ(stages, 12U);
}

TEST(OptionTable, NamesFieldsAndDefaultsAreEachTheirOwn) {
    std::set<std::string> names;
    std::set<const void*> fields;
    MapParams params;
    std::size_t rows = 0;
    forEachOption(params, [&](const OptionRow& row, auto& field) {
        ++rows;
        names.insert(row.name);
        if (row.formerName) names.insert(row.formerName);
        fields.insert(&field);
        EXPECT_GT(std::strlen(row.doc), 5U) << row.name;
        if constexpr (isNumber<decltype(field)>) {
            EXPECT_GT(std::strlen(row.unit), 0U) << row.name;
            EXPECT_LT(row.low, row.high) << row.name;
            EXPECT_GE(field, row.low) << row.name;
            EXPECT_LE(field, row.high) << row.name;
        }
        const std::string name = row.name;
        if (name.substr(name.size() - 2) == "_m") {
            EXPECT_STREQ(row.unit, "m") << name;
        }
    });
    EXPECT_EQ(fields.size(), rows);
    EXPECT_EQ(names.size(), rows + 2);  // two former names
    // The table's rows name the fields that they stand for.
    params.cells.minCell_m = 7;
    params.occupancy.extentSigmas = 1.5;
    std::map<std::string, double> values;
    forEachNumber(params,
                  [&](const OptionRow& row, auto value) { values[row.name] = value; });
    EXPECT_EQ(values.at("minCell_m"), 7);
    EXPECT_EQ(values.at("extentSigmas"), 1.5);
    EXPECT_EQ(values.at("resolution_m"), params.filter.resolution_m);
}

TEST(OptionTable, EveryNumberIsRefusedOutsideOfItsRangeByName) {
    std::size_t numbers = 0;
    MapParams params;
    forEachNumber(params, [&](const OptionRow& row, auto& field) {
        ++numbers;
        const auto kept = field;
        using Number = std::decay_t<decltype(field)>;
        std::vector<Number> wrong = {static_cast<Number>(row.low - 1),
                                     static_cast<Number>(row.high * 1.001 + 1)};
        if constexpr (std::is_same_v<Number, double>) {
            wrong.push_back(std::numeric_limits<double>::quiet_NaN());
            wrong.push_back(std::numeric_limits<double>::infinity());
        }
        for (const Number value : wrong) {
            field = value;
            const std::string said = errorOfOptions([&] { params.validate(); });
            EXPECT_EQ(said.rfind(std::string(row.name) + " = ", 0), 0U) << said;
            EXPECT_NE(said.find("must be in ["), std::string::npos) << said;
        }
        field = kept;
        EXPECT_NO_THROW(params.validate());
    });
    EXPECT_EQ(numbers, 32U);
}

TEST(OptionTable, MessagesSayNameValueAndRange) {
    EXPECT_EQ(errorOfOptions([] { requireInRange("share", 2.5, 1e-9, 0.75); }),
              "share = 2.5: must be in [1e-09, 0.75]");
    EXPECT_EQ(errorOfOptions([] { requireInRange("n", 0, 1, 1e5); }),
              "n = 0: must be in [1, 100000]");
    EXPECT_EQ(errorOfOptions([] { requireInRange("n", 1, 1, 1e5); }), "");
    MapParams params;
    params.filter.maxRange_m = 0.05;
    EXPECT_EQ(errorOfOptions([&] { params.validate(); }),
              "maxRange_m = 0.05: must be in [0.1, 100000], as minRange_m is 0.1");
    params = {};
    params.occupancy.knownSigmas = 2;
    EXPECT_EQ(errorOfOptions([&] { params.validate(); }),
              "extentSigmas = 2.4: must be in [1, 2], as knownSigmas is 2");
}

TEST(OptionTable, NumbersReadBackTheSameAndAreShort) {
    for (const auto& [number, text] :
         {std::pair{1e5, "100000"}, std::pair{1e-4, "0.0001"}, std::pair{1e-9, "1e-09"},
          std::pair{0.1, "0.1"}, std::pair{0.0, "0"}, std::pair{-2.5, "-2.5"},
          std::pair{1e300, "1e+300"}, std::pair{1.0 / 3.0, "0.3333333333333333"}}) {
        EXPECT_EQ(numberText(number), text);
        EXPECT_EQ(std::strtod(numberText(number).c_str(), nullptr), number);
    }
}

TEST(OptionTable, OfTwoThatDoNotFitTheOneThatWasSetIsNamed) {
    OccupancyParams params;
    params.knownSigmas = 2;
    const auto errorIfSet = [&](const std::set<std::string>& set) {
        return errorOfOptions([&] {
            requireOptionsInRange(params,
                                  [&](const std::string& name) { return set.count(name); });
        });
    };
    EXPECT_EQ(errorIfSet({"knownSigmas"}),
              "knownSigmas = 2: must be in [2.4, 3.9], as extentSigmas is 2.4");
    const std::string own = "extentSigmas = 2.4: must be in [1, 2], as knownSigmas is 2";
    EXPECT_EQ(errorIfSet({"extentSigmas"}), own);
    EXPECT_EQ(errorIfSet({"extentSigmas", "knownSigmas"}), own);
    EXPECT_EQ(errorIfSet({}), own);
}

TEST(OptionTable, EveryFieldTakesPartInEquality) {
    const MapParams params;
    MapParams other;
    EXPECT_TRUE(other == params);
    forEachOption(other, [&](const OptionRow& row, auto& field) {
        const auto kept = field;
        if constexpr (isNumber<decltype(field)>)
            field = std::is_same_v<decltype(kept), const int>
                        ? field + 1
                        : std::nextafter(field, 1e300);
        else if constexpr (std::is_same_v<std::decay_t<decltype(field)>, Names>)
            field.emplace_back("a");
        EXPECT_TRUE(other != params) << row.name;
        EXPECT_TRUE(params != other) << row.name;
        field = kept;
        EXPECT_TRUE(other == params) << row.name;
    });
}

std::vector<double*> lengthsOf(MapParams& params) {
    return {&params.filter.resolution_m,
            &params.filter.minLeaf_m,
            &params.cells.cellAtOneMetre_m,
            &params.cells.minCell_m,
            &params.occupancy.band.bandBase_m,
            &params.occupancy.freeSpace.freeCellAtOneMetre_m,
            &params.occupancy.coverage.coverageCellAtOneMetre_m,
            &params.modality.modalityLeafAtOneMetre_m};
}

TEST(Resolution, AllLengthsFollowItAndNothingElse) {
    MapParams params, defaults;
    params.setResolution(0.1);
    const auto scaled = lengthsOf(params), before = lengthsOf(defaults);
    for (std::size_t i = 0; i < scaled.size(); ++i)
        EXPECT_NEAR(*scaled[i], 2.5 * *before[i], 1e-15) << i;
    for (std::size_t i = 0; i < scaled.size(); ++i) *scaled[i] = *before[i];
    EXPECT_TRUE(params == defaults);
}

TEST(Resolution, TheDefaultChangesNoBit) {
    MapParams params;
    params.setResolution(0.04);
    EXPECT_TRUE(params == MapParams());
    params.setResolution(0.11);
    params.setResolution(0.04);
    EXPECT_TRUE(params == MapParams()) << "nothing is left of what was set before";
}

TEST(Resolution, WholeRangeIsValid) {
    for (const double resolution_m : {5e-3, 0.01, 0.3, 10.0}) {
        MapParams params;
        params.setResolution(resolution_m);
        EXPECT_EQ(errorOfOptions([&] { params.validate(); }), "");
    }
    for (const double wrong : {0.0, -1.0, 11.0, std::nan("")}) {
        MapParams params;
        params.setResolution(wrong);
        EXPECT_EQ(errorOfOptions([&] { params.validate(); }).rfind("resolution_m = ", 0),
                  0U);
    }
}

TEST(Resolution, FieldThatIsAssignedHasItsOwnValue) {
    MapParams params;
    params.filter.resolution_m = 0.1;
    EXPECT_EQ(params.cells.minCell_m, MapParams().cells.minCell_m);
    params.setResolution(0.08);
    params.cells.minCell_m = 0.123;
    EXPECT_EQ(params.cells.minCell_m, 0.123);
    EXPECT_EQ(params.cells.cellAtOneMetre_m, 0.44);
}

/// A saved map with one option renamed and set to a value.
std::vector<std::uint8_t> withOption(const std::string& name, const std::string& inFile,
                                     double value) {
    auto buffer = Map().save();
    const auto at = std::search(buffer.begin(), buffer.end(), name.begin(), name.end());
    EXPECT_NE(at, buffer.end()) << name;
    const auto begin = at - buffer.begin();
    std::vector<std::uint8_t> entry(1, static_cast<std::uint8_t>(inFile.size()));
    entry.insert(entry.end(), inFile.begin(), inFile.end());
    entry.resize(entry.size() + sizeof value);
    std::memcpy(entry.data() + 1 + inFile.size(), &value, sizeof value);
    buffer.erase(at - 1, at + static_cast<std::ptrdiff_t>(name.size() + sizeof value));
    buffer.insert(buffer.begin() + begin - 1, entry.begin(), entry.end());
    return buffer;
}

Map loaded(std::vector<std::uint8_t> buffer) {
    const std::uint64_t size = buffer.size(),
                        sum = checksum(buffer.data() + 24, buffer.size() - 24);
    std::memcpy(buffer.data() + 8, &size, sizeof size);
    std::memcpy(buffer.data() + 16, &sum, sizeof sum);
    return Map::load(buffer.data(), buffer.size());
}

TEST(SavedOptions, FormerNamesAreRead) {
    const MapParams leaf =
        loaded(withOption("resolution_m", "leafAtOneMetre_m", 0.25)).params();
    EXPECT_EQ(leaf.filter.resolution_m, 0.25);
    EXPECT_EQ(leaf.cells.minCell_m, MapParams().cells.minCell_m) << "no length follows";
    EXPECT_EQ(loaded(withOption("carvedSupport", "contradictedKeep", 0.75))
                  .params()
                  .carving.carvedSupport,
              0.75);
    EXPECT_EQ(
        loaded(withOption("resolution_m", "resolution_m", 0.25)).params().cells.minCell_m,
        MapParams().cells.minCell_m);
}

TEST(SavedOptions, ModelOfTheThesisIsRefusedWithTheStudyThatShowsIt) {
    EXPECT_EQ(loaded(withOption("minSupport", "freeSpaceModel", 0)).params(), MapParams());
    try {
        loaded(withOption("minSupport", "freeSpaceModel", 1));
        FAIL() << "it was read";
    } catch (const FormatError& e) {
        EXPECT_NE(std::string(e.what()).find("hgmm-replay --study free-space"),
                  std::string::npos)
            << e.what();
    }
}

}  // namespace
}  // namespace hgmm

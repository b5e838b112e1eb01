#include "hgmm/mrpt_bridge/option_list.h"

#include <mrpt/maps/CHGMMOccupancyMap.h>

#include "options/option_fields.h"

namespace hgmm::mrpt_bridge {

namespace {

constexpr double kNoLimit = 1e9;  // a range that ends here is open for users

std::string rangeOf(const OptionField& field) {
    if (std::holds_alternative<Names*>(field.member)) return "names";
    if (field.isText()) return "text";
    if (!field.isRanged()) return "true or false";
    const OptionRow& row = *field.row;
    const std::string low = row.atLeast ? row.atLeast : numberText(row.low);
    const std::string high = row.atMost ? row.atMost : numberText(row.high);
    return (row.mayBeZero ? "0 or " : "") +
           (row.high >= kNoLimit ? "at least " + low : low + " to " + high);
}

template <typename Struct>
void append(const char* section, std::vector<OptionInfo>& list) {
    Struct byDefault;
    for (const OptionField& field : fieldsOf(byDefault)) {
        const OptionRow& row = *field.row;
        list.push_back({section, row.name, row.formerName ? row.formerName : "",
                        textOf(field), row.unit, rangeOf(field), row.doc, row.isBasic});
        if (row.scales) list.back().doc += "; follows resolution_m";
    }
}

}  // namespace

std::vector<OptionInfo> listOptions() {
    using Map = mrpt::maps::CHGMMOccupancyMap;
    std::vector<OptionInfo> list;
    append<Map::TInsertionOptions>("insertOpts", list);
    append<LikelihoodParams>("likelihoodOpts", list);
    append<RenderParams>("renderOpts", list);
    append<CreationOptions>("creationOpts", list);
    return list;
}

}  // namespace hgmm::mrpt_bridge

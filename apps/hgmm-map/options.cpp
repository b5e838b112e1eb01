#include <cstdio>
#include <string>
#include <vector>

#include "commands.h"
#include "hgmm/mrpt_bridge/option_list.h"

namespace maptool {
namespace {

using hgmm::mrpt_bridge::OptionInfo;

std::string defaultOf(const OptionInfo& option) {
    return option.defaultValue.empty() ? "none" : option.defaultValue;
}

/// "0.04 m": a unit of 1 is not said.
std::string withUnit(const std::string& text, const OptionInfo& option) {
    return option.unit.empty() || option.unit == "1" ? text : text + " " + option.unit;
}

std::string docOf(const OptionInfo& option) {
    return option.formerName.empty() ? option.doc
                                     : option.doc + " (formerly " + option.formerName + ")";
}

/// Calls print(option) for each, and begin(section) where another section starts.
template <typename Begin, typename Print>
void bySection(const std::vector<OptionInfo>& options, Begin&& begin, Print&& print) {
    std::string section;
    for (const OptionInfo& option : options) {
        if (option.section != section) begin(option.section);
        section = option.section;
        print(option);
    }
}

void printPlain(const std::vector<OptionInfo>& options) {
    bySection(
        options,
        [&](const std::string& section) {
            std::printf("%s[<section>_hgmmMap_00_%s]\n",
                        section == options.front().section ? "" : "\n", section.c_str());
        },
        [](const OptionInfo& option) {
            std::printf("%-24s = %-12s %s\n    %s\n", option.name.c_str(),
                        defaultOf(option).c_str(), withUnit(option.range, option).c_str(),
                        docOf(option).c_str());
        });
}

void printMarkdown(const std::vector<OptionInfo>& options) {
    std::printf(
        "# Options\n\n"
        "`hgmm-map options --markdown` writes this page; do not edit it. `hgmm-map "
        "options` "
        "prints the options in\nbold, `hgmm-map options --all` prints all.\n\n"
        "`<section>` is the section of the configuration that has `hgmmMap_count`. Maps "
        "are "
        "numbered from 00. An option\nthat a configuration does not give has its default. "
        "A length that follows `resolution_m` and is not given has\nits default, times "
        "`resolution_m` / 0.04, within its range. Former names are read for ever; a "
        "configuration with\n`leafAtOneMetre_m` sets the leaf only.\n");
    bySection(
        options,
        [](const std::string& section) {
            std::printf(
                "\n## `[<section>_hgmmMap_00_%s]`\n\n"
                "| option | default | unit | range | what | formerly |\n"
                "| --- | --- | --- | --- | --- | --- |\n",
                section.c_str());
        },
        [](const OptionInfo& option) {
            const char* bold = option.isBasic ? "**" : "";
            std::printf("| %s`%s`%s | %s | %s | %s | %s | %s |\n", bold,
                        option.name.c_str(), bold, defaultOf(option).c_str(),
                        option.unit.c_str(), option.range.c_str(), option.doc.c_str(),
                        option.formerName.c_str());
        });
}

}  // namespace

void printOptions(const OptionsOptions& options) {
    std::vector<OptionInfo> list;
    for (const OptionInfo& option : hgmm::mrpt_bridge::listOptions())
        if (option.isBasic || options.all || options.markdown) list.push_back(option);
    if (options.markdown)
        printMarkdown(list);
    else
        printPlain(list);
    if (!options.markdown && !options.all)
        std::printf("\nhgmm-map options --all prints all options.\n");
}

}  // namespace maptool

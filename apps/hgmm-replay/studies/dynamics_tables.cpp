#include "studies/dynamics_protocols.h"

namespace replay {
namespace {

using Worst = FigureColumn::Worst;

const FigureColumn kTime{"ms/scan", "scan_ms_median", 1, Worst::largest};

std::vector<FigureColumn> columnsOfStays() {
    const char* const goals[StayingPoints::kClasses] = {">=.999", ">=.995", ">=.95", ">=.9",
                                                        ""};
    const char* const keys[StayingPoints::kClasses] = {"wall", "floor", "table_top", "pole",
                                                       "grazing"};
    std::vector<FigureColumn> columns;
    for (const char* when : {"before", "after"})
        for (int i = 0; i < StayingPoints::kClasses; ++i)
            columns.push_back({std::string(StayingPoints::nameOf(i)) + " " + when,
                               std::string(keys[i]) + "_" + when, 3, Worst::smallest,
                               goals[i]});
    return columns;
}

}  // namespace

DynamicsTables::DynamicsTables()
    : removed("removed", "Removed: scans until half and 99 % of the points are free",
              {"sensor", "after", "map"},
              {{"half", "scans_to_half", 0, Worst::largest, "<=2"},
               {"99 %", "scans_to_99pct", 0, Worst::largest, "<=4"},
               {"free at once", "free_share_1", 3, Worst::smallest},
               {"at last", "free_share_last", 3, Worst::smallest},
               {"points", "points", 0, Worst::smallest},
               kTime}),
      appears("appears", "Appears: scans until half and 99 % of the points are occupied",
              {"sensor", "after", "map"},
              {{"half", "scans_to_half", 0, Worst::largest, "<=2"},
               {"99 %", "scans_to_99pct", 0, Worst::largest, "<=5"},
               {"occupied at once", "occupied_share_1", 3, Worst::smallest},
               {"at last", "occupied_share_last", 3, Worst::smallest},
               {"points", "points", 0, Worst::smallest},
               kTime}),
      person("person", "Person walking for 300 scans",
             {"sensor", "background", "after", "map"},
             {{"occupied in own scan", "own_scan_occupied", 3, Worst::smallest, ">=.8"},
              {"trail after 1", "trail_occupied_1", 4, Worst::largest, "<=.01"},
              {"trail after 20", "trail_occupied_20", 4, Worst::largest, "<=.001"},
              kTime}),
      door("door", "Door: scans until 90 % of its points are right, worst swing",
           {"sensor", "door", "map"},
           {{"opens", "scans_to_open", 0, Worst::largest, "<=3"},
            {"shuts", "scans_to_shut", 0, Worst::largest, "<=2"},
            {"free at ends of open swings", "open_free_share", 3, Worst::smallest},
            kTime}),
      stays("stays", "What stays: share occupied, before and after the change",
            {"protocol", "sensor", "map"}, columnsOfStays()) {}

}  // namespace replay

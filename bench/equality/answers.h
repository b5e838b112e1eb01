#pragma once
#include <string>
#include <vector>

#include "dump.h"
#include "hgmm/map.h"
#include "questions.h"

namespace equality {

/// Adds what a map says of the questions: occupancy of all levels, its gradient, density,
/// hits of rays, and modalities where the map has some.
/// @param of begins the sections' names, to tell maps of one dump apart
void addAnswers(Dump& dump, const std::string& of, const hgmm::Map& map,
                const Questions& questions);

/// Adds the components of maps loaded from either encoding, and what they
/// say of a quarter of the questions.
void addSaved(Dump& dump, const hgmm::Map& map, const Questions& questions);

/// Adds how each of other maps, of single scans of the same place, aligns with a map from
/// a guess that is off, and what the map becomes when they are merged into it.
void addPairs(Dump& dump, const hgmm::Map& map, const std::vector<hgmm::Map>& others);

/// Adds the reports of inserting scans into one new map, and the bytes of that map.
void addInsertions(Dump& dump, const hgmm::MapParams& params,
                   const std::vector<hgmm::Scan>& scans);

}  // namespace equality

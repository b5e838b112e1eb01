#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "studies/dynamics_world.h"
#include "studies/figure_table.h"

namespace replay {

/// The tables of the dynamics study.
struct DynamicsTables {
    DynamicsTables();

    FigureTable removed, appears, person, door, stays;
};

/// One sensor and seed of the study.
struct DynamicsRun {
    std::string sensor;  ///< as observerOf takes it
    std::uint64_t seed = 1;
    MakeMaps makeMaps;
    DynamicsTables& tables;
};

/// A box stands for `scans` scans, then is gone: scans until its points are free.
void removedProtocol(const DynamicsRun& run, int scans);

/// A box appears after `scans` scans without it: scans until its points are occupied.
void appearsProtocol(const DynamicsRun& run, int scans);

/// A person walks for 300 scans, after `scans` scans without it.
void personProtocol(const DynamicsRun& run, int scans,
                    hgmm::evaluation::changing_room::Background background);

/// A door opens and shuts 4 times each, shut for 50 scans at first.
/// @param recess_m its distance behind the face of the wall [m]
void doorProtocol(const DynamicsRun& run, double recess_m);

}  // namespace replay

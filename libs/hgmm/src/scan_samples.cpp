#include "hgmm/scan_samples.h"

#include "hgmm/gaps.h"

namespace hgmm {

ScanSamples samplesOf(const Scan& scan, const MapParams& params) {
    scan.validate();
    params.filter.validate();
    params.cells.validate();
    ScanSamples result;
    result.samples_sensor = filterScan(scan, params.filter, &result.points);
    bridgeGaps(result.samples_sensor, params.cells);
    result.normalOfRays_sensor = normalOfRays(result.samples_sensor);
    return result;
}

}  // namespace hgmm

#include "hgmm/scan_samples.h"

#include "hgmm/gaps.h"

namespace hgmm {

ScanSamples samplesOf(const Scan& scan, const MapParams& params) {
    ScanSamples result;
    result.samples_sensor = filterScan(scan, params.filter, &result.points);
    bridgeGaps(result.samples_sensor, params.cells);
    return result;
}

}  // namespace hgmm

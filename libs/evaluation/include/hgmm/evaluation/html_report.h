#pragma once
#include <string>
#include <vector>

#include "hgmm/evaluation/figures.h"
#include "hgmm/evaluation/picture.h"

namespace hgmm::evaluation {

/// A picture of the report.
struct ReportPicture {
    std::string title;
    std::string caption;
    Picture picture;
};

/// All that was measured as one page of HTML that needs neither network nor scripts: what
/// was run, tables of the maps with the best in bold, plots, pictures side by side, and
/// where each map comes from. The first map is drawn thickest. What was not measured, or is
/// not finite, is shown as a dash. The same figures give the same page. Throws
/// std::invalid_argument for a picture that is empty.
std::string htmlReport(const Run& run, const std::vector<MapFigures>& maps,
                       const std::vector<ReportPicture>& pictures);

}  // namespace hgmm::evaluation

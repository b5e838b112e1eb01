#pragma once

namespace hgmm {

/// How modalities (thesis chapter 5) are learnt.
struct ModalityParams {
    /// Leaf edge at range 1 m [m], > 0, growing like FilterParams::leafAtOneMetre_m: finer
    /// than that of the surfaces, for texture is finer than shape.
    double modalityLeafAtOneMetre_m = 0.028;
    /// Share of the variance of a modality within a scan that its components need not
    /// explain, in (0, 1): 1 - R^2 of what the map keeps of a scan.
    double modalityUnexplained = 0.07;
    /// Standard deviation of the measurements of a modality [unit of the channel], > 0:
    /// what is closer is not told apart.
    double modalityNoise = 0.01;

    /// Throws std::invalid_argument naming the field.
    void validate() const;
};

}  // namespace hgmm

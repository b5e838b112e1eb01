#pragma once
#include <Eigen/Cholesky>

#include "hgmm/mixture.h"

namespace hgmm {

/// The component with its covariance widened, where needed, so that it stays positive
/// definite when a Mixture rounds it to float. Rounding moves an eigenvalue by at most D
/// 2^-24 times the largest; the floor of 5e-7 trace(Sigma) is clear of that and reached
/// only by components more than a thousand times longer than thick.
template <int D>
Gaussian<D> regularized(Gaussian<D> component) {
    using Matrix = typename Gaussian<D>::Matrix;
    // The smallest normal float keeps a component of coinciding points above zero.
    const double floor = 5e-7 * component.covariance.trace() + 1.2e-38;
    const Matrix raised = component.covariance - floor * Matrix::Identity();
    if (Eigen::LLT<Matrix>(raised).info() != Eigen::Success)
        component.covariance.diagonal().array() += floor;
    return component;
}

}  // namespace hgmm

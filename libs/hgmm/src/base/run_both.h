#pragma once
#include <exception>

namespace hgmm {

/// Runs two tasks that do not touch each other's data, at the same time where there are two
/// threads. An exception of either is thrown on when both have ended.
template <typename First, typename Second>
void runBoth(First&& first, Second&& second) {
    std::exception_ptr errors[2];
    const auto guarded = [&errors](int which, auto& task) {
        try {
            task();
        } catch (...) {
            errors[which] = std::current_exception();
        }
    };
#pragma omp parallel sections
    {
#pragma omp section
        guarded(0, first);
#pragma omp section
        guarded(1, second);
    }
    for (const std::exception_ptr& error : errors)
        if (error) std::rethrow_exception(error);
}

}  // namespace hgmm

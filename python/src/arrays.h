#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "hgmm/scan.h"

/// numpy arrays as the core's arguments and answers. Errors name the argument, what was
/// expected and what came.
namespace hgmm::python {

namespace py = pybind11;

/// Text of a shape, as Python writes it: "(10, 3)".
std::string shapeText(const py::array& array);

/// An array in C order, of float or double; the same memory if it is that already. `rows`
/// and `columns` of the shape: any number if -1; one dimension only if `columns` is 0.
/// Throws TypeError for what is not an array of real numbers, ValueError for another shape.
template <typename Number>
py::array_t<Number> numbers(const py::handle& argument, const std::string& name,
                            py::ssize_t rows, py::ssize_t columns);

/// Points [m] that live as long as the array.
class Points {
 public:
    /// From shape (N, 3). Throws as numbers().
    Points(const py::handle& argument, const std::string& name)
        : array_(numbers<double>(argument, name, -1, 3)) {}
    std::size_t size() const { return static_cast<std::size_t>(array_.shape(0)); }
    const Eigen::Vector3d* data() const {
        static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double));
        return reinterpret_cast<const Eigen::Vector3d*>(array_.data());
    }

 private:
    py::array_t<double> array_;
};

/// From shape (3,). Throws as numbers().
Eigen::Vector3d vector3(const py::handle& argument, const std::string& name);

/// From shape (4, 4), or None for the identity. Throws as numbers(), and ValueError for a
/// last row other than 0 0 0 1, for what is not finite and for a rotation that is not
/// orthonormal.
Pose poseFrom(const py::object& argument, const std::string& name);

/// Shape (4, 4).
py::array_t<double> arrayOf(const Pose& pose);
/// A copy in C order.
py::array_t<double> arrayOf(const Eigen::MatrixXd& matrix);
py::array_t<double> arrayOf(const Eigen::Vector3d& vector);

/// Answers that numpy arrays share: each field of Struct is an array that strides over
/// them.
template <typename Struct>
class Columns {
 public:
    explicit Columns(std::size_t n) : answers_(std::make_unique<std::vector<Struct>>(n)) {}
    Struct* data() { return answers_->data(); }
    auto begin() { return answers_->begin(); }
    auto end() { return answers_->end(); }

    /// The arrays of some fields, in their order. The answers go with the last of them.
    template <typename... Fields>
    py::tuple arrays(Fields Struct::*... fields) {
        std::vector<Struct>* answers = answers_.release();
        const py::capsule owner(
            answers, [](void* p) { delete static_cast<std::vector<Struct>*>(p); });
        const auto n = static_cast<py::ssize_t>(answers->size());
        const Struct none{};  // an empty vector has no first element to take an address of
        const Struct* first = answers->empty() ? &none : answers->data();
        return py::make_tuple(column(first->*fields, n, owner)...);
    }

 private:
    static constexpr auto kStride = static_cast<py::ssize_t>(sizeof(Struct));

    /// A field of the first answer and of those behind it.
    template <typename Number>
    static py::array column(const Number& first, py::ssize_t n, const py::capsule& owner) {
        return py::array_t<Number>({n}, {kStride}, &first, owner);
    }
    static py::array column(const Eigen::Vector3d& first, py::ssize_t n,
                            const py::capsule& owner) {
        constexpr auto between = static_cast<py::ssize_t>(sizeof(double));
        return py::array_t<double>({n, py::ssize_t{3}}, {kStride, between}, first.data(),
                                   owner);
    }

    std::unique_ptr<std::vector<Struct>> answers_;
};

/// A named tuple of the module hgmm.answers.
template <typename... Fields>
py::object answer(const char* name, Fields&&... fields) {
    return py::module_::import("hgmm.answers").attr(name)(std::forward<Fields>(fields)...);
}

}  // namespace hgmm::python

#include "arrays.h"

#include <Eigen/LU>
#include <cstdint>
#include <cstring>

namespace hgmm::python {

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::string expectedShape(py::ssize_t rows, py::ssize_t columns) {
    const std::string n = rows < 0 ? "N" : std::to_string(rows);
    if (columns == 0) return "(" + n + ",)";
    return "(" + n + ", " + std::to_string(columns) + ")";
}

bool isAligned(const py::array& array, std::size_t alignment) {
    return reinterpret_cast<std::uintptr_t>(array.data()) % alignment == 0;
}

}  // namespace

std::string shapeText(const py::array& array) {
    return py::str(array.attr("shape")).cast<std::string>();
}

template <typename Number>
py::array_t<Number> numbers(const py::handle& argument, const std::string& name,
                            py::ssize_t rows, py::ssize_t columns) {
    const auto array = py::array::ensure(argument);
    if (!array) {
        PyErr_Clear();
        throw py::type_error(name + ": expected an array of numbers of shape " +
                             expectedShape(rows, columns));
    }
    const bool isEmptyList = array.size() == 0 && array.ndim() == 1 && columns > 0;
    const bool fits = array.ndim() == (columns == 0 ? 1 : 2) &&
                      (rows < 0 || array.shape(0) == rows) &&
                      (columns == 0 || array.shape(1) == columns);
    if (!fits && !(isEmptyList && rows < 0))
        throw py::value_error(name + ": expected shape " + expectedShape(rows, columns) +
                              ", got " + shapeText(array));
    if (const char kind = array.dtype().kind(); kind != 'f' && kind != 'i' && kind != 'u')
        throw py::type_error(name + ": expected numbers, got dtype " +
                             py::str(array.dtype()).cast<std::string>());
    if (!fits) return py::array_t<Number>(std::vector<py::ssize_t>{0, columns});
    const auto converted =
        py::array_t<Number, py::array::c_style | py::array::forcecast>::ensure(array);
    if (!converted) throw py::error_already_set();
    if (isAligned(converted, alignof(Number))) return converted;
    py::array_t<Number> copy(
        std::vector<py::ssize_t>(converted.shape(), converted.shape() + converted.ndim()));
    std::memcpy(copy.mutable_data(), converted.data(),
                static_cast<std::size_t>(converted.nbytes()));
    return copy;
}

template py::array_t<double> numbers(const py::handle&, const std::string&, py::ssize_t,
                                     py::ssize_t);
template py::array_t<float> numbers(const py::handle&, const std::string&, py::ssize_t,
                                    py::ssize_t);

Eigen::Vector3d vector3(const py::handle& argument, const std::string& name) {
    return Eigen::Map<const Eigen::Vector3d>(numbers<double>(argument, name, 3, 0).data());
}

Pose poseFrom(const py::object& argument, const std::string& name) {
    if (argument.is_none()) return {};
    const py::array_t<double> array = numbers<double>(argument, name, 4, 4);
    const Eigen::Map<const RowMajor> T(array.data(), 4, 4);
    if (!T.allFinite())
        throw py::value_error(name + ": the pose, of shape (4, 4), is not finite");
    if (T.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
        throw py::value_error(name + ": the last row of a pose is 0 0 0 1");
    Pose pose;
    pose.R = T.topLeftCorner<3, 3>();
    pose.t = T.topRightCorner<3, 1>();
    if (!(pose.R * pose.R.transpose()).isIdentity(1e-4) || pose.R.determinant() < 0)
        throw py::value_error(name + ": the rotation of the pose is not orthonormal");
    return pose;
}

py::array_t<double> arrayOf(const Eigen::MatrixXd& matrix) {
    py::array_t<double> array(std::vector<py::ssize_t>{matrix.rows(), matrix.cols()});
    Eigen::Map<RowMajor>(array.mutable_data(), matrix.rows(), matrix.cols()) = matrix;
    return array;
}

py::array_t<double> arrayOf(const Eigen::Vector3d& vector) {
    return py::array_t<double>(3, vector.data());
}

py::array_t<double> arrayOf(const Pose& pose) {
    Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
    T.topLeftCorner<3, 3>() = pose.R;
    T.topRightCorner<3, 1>() = pose.t;
    return arrayOf(Eigen::MatrixXd(T));
}

}  // namespace hgmm::python

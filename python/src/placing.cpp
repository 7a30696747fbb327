#include "placing.hpp"

#include "lamella/core/error.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>

namespace lamella::python {
namespace {

std::string row_text(const std::array<double, 4>& row) {
    std::array<char, 120> text{};
    std::snprintf(text.data(), text.size(), "%g, %g, %g, %g", row[0], row[1], row[2], row[3]);
    return text.data();
}

} // namespace

pybind11::array_t<double> bounds_of(const Box3& box) {
    const std::array bounds{box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z};
    return pybind11::array_t<double>({2, 3}, bounds.data());
}

Box3 box_of(const Bounds& bounds) {
    const auto& [min, max] = bounds;
    return {{min[0], min[1], min[2]}, {max[0], max[1], max[2]}};
}

bool finite(const Box3& box) noexcept {
    const auto& [min, max] = box;
    for (const double v : {min.x, min.y, min.z, max.x, max.y, max.z})
        if (!std::isfinite(v))
            return false;
    return true;
}

pybind11::array_t<double> matrix_of(const Transform& map) {
    Matrix rows{};
    for (std::size_t r = 0; r < 3; ++r)
        rows[r] = {map.linear[r][0], map.linear[r][1], map.linear[r][2], map.offset[r]};
    rows[3] = {0, 0, 0, 1};
    return pybind11::array_t<double>({4, 4}, rows.front().data());
}

Transform transform_of(const Matrix& rows, const char* argument) {
    if (rows[3] != std::array<double, 4>{0, 0, 0, 1})
        throw Error(ErrorKind::usage,
                    std::string(argument) +
                        ": the last row of a transform must be 0, 0, 0, 1, and this one is " +
                        row_text(rows[3]) + ": meshes are moved, rotated and scaled, but not projected");
    Transform map;
    for (std::size_t r = 0; r < 3; ++r) {
        map.linear[r] = {rows[r][0], rows[r][1], rows[r][2]};
        map.offset[r] = rows[r][3];
    }
    return map;
}

} // namespace lamella::python

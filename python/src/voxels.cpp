#include "lamella/jobs/voxels.hpp"

#include "lamella/contour/plane_source.hpp"
#include "lamella/findings/findings.hpp"

#include "bindings.hpp"
#include "run.hpp"
#include "shared_layer.hpp"
#include "source_plate.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace py = pybind11;

namespace lamella::python {
namespace {

/// The number of voxels along z, y and x, and the centre of the first one and the spacing along x, y and z.
using Shape = std::array<std::uint32_t, 3>;
using Lengths = std::array<double, 3>;

VoxelGrid grid_of(const Shape& shape, const Lengths& origin, const Lengths& spacing) {
    return {.columns = shape[2],
            .rows = shape[1],
            .layers = shape[0],
            .origin = {origin[0], origin[1], origin[2]},
            .spacing = {spacing[0], spacing[1], spacing[2]}};
}

/// Returns an array whose content is undefined, after a check whether there is memory for it.
template <class Value>
py::array_t<Value> array_for(const VoxelGrid& grid, std::uint64_t max_memory) {
    check(grid, sizeof(Value), max_memory);
    return py::array_t<Value>({grid.layers, grid.rows, grid.columns});
}

template <class Value>
py::array pixels_as(const Stack& stack, const VoxelGrid& grid, PixelValue value, std::uint64_t max_memory,
                    unsigned threads, const py::object& progress) {
    py::array_t<Value> array = array_for<Value>(grid, max_memory);
    static_assert(sizeof(Value) == 1); // NumPy stores False and True as 0 and 1
    const std::span pixels(reinterpret_cast<std::uint8_t*>(array.mutable_data()),
                           static_cast<std::size_t>(array.size()));
    run(threads, progress, [&](const Execution& execution) {
        fill_pixels(source_of(std::vector<LayerStack>{plain(stack.layers)}, {}, execution), grid, value,
                    pixels, execution);
    });
    return array;
}

py::array pixels_of(const StackPointer& stack, const Shape& shape, const Lengths& origin,
                    const Lengths& spacing, bool inside, std::uint64_t max_memory, unsigned threads,
                    const py::object& progress) {
    const VoxelGrid grid = grid_of(shape, origin, spacing);
    return inside
               ? pixels_as<bool>(*stack, grid, PixelValue::inside, max_memory, threads, progress)
               : pixels_as<std::uint8_t>(*stack, grid, PixelValue::coverage, max_memory, threads, progress);
}

/// Index of a file of the plate, and a text about it.
using Texts = std::vector<std::pair<std::uint32_t, std::string>>;

/// Returns an array that `fill` filled, and the defects of the layers.
template <class Value, class Fill>
std::pair<py::array, Texts> filled(const VoxelGrid& grid, std::uint64_t max_memory, unsigned threads,
                                   const py::object& progress, const Fill& fill) {
    py::array_t<Value> array = array_for<Value>(grid, max_memory);
    const std::span<Value> values(array.mutable_data(), static_cast<std::size_t>(array.size()));
    const Findings findings =
        result_of(threads, progress, [&](const Execution& execution) { return fill(values, execution); });
    Texts texts;
    for (const Finding& finding : findings.by_file)
        texts.emplace_back(finding.file, finding.text());
    return {std::move(array), std::move(texts)};
}

std::pair<py::array, Texts> coverage_of(const PlatePointer& plate, const Shape& shape, const Lengths& origin,
                                        const Lengths& spacing, std::uint64_t max_memory, unsigned threads,
                                        const py::object& progress) {
    const VoxelGrid grid = grid_of(shape, origin, spacing);
    return filled<std::uint8_t>(grid, max_memory, threads, progress,
                                [&](std::span<std::uint8_t> values, const Execution& execution) {
                                    return fill_coverage(plate->placed, grid, values, execution);
                                });
}

std::pair<py::array, Texts> labels_of(const PlatePointer& plate, const Shape& shape, const Lengths& origin,
                                      const Lengths& spacing, std::uint64_t max_memory, unsigned threads,
                                      const py::object& progress) {
    const VoxelGrid grid = grid_of(shape, origin, spacing);
    const auto fill = [&](const auto& values, const Execution& execution) {
        return fill_labels(plate->placed, grid, values, execution);
    };
    constexpr std::size_t most_of_bytes = 255;
    return plate->placed.parts.size() <= most_of_bytes
               ? filled<std::uint8_t>(grid, max_memory, threads, progress, fill)
               : filled<std::uint16_t>(grid, max_memory, threads, progress, fill);
}

} // namespace

void bind_pixels(py::class_<Stack, StackPointer>& cls) {
    cls.def("_pixels", &pixels_of);
}

void bind_voxels(py::module_& module) {
    module.def("coverage", &coverage_of);
    module.def("labels", &labels_of);
}

} // namespace lamella::python

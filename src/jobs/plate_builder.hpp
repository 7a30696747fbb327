#pragma once

// Builds a plate from mesh files: places the parts, and finds those that can share a shape.

#include "lamella/core/point.hpp"
#include "lamella/jobs/plate.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/meshes/mesh_file.hpp"

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace lamella {

/// Throws Error{usage} if there are no inputs, and for invalid values in them.
void check_inputs(std::span<const PlateInput> inputs);

/// Collects the instances of all files.
class PlateBuilder {
  public:
    using BoxOf = std::function<Box3(const Mesh& mesh, const Transform& placement)>;

    /// If parts take more than `max_memory` bytes besides their meshes, `add` throws Error{limit}. 0 means
    /// that only the number of parts is limited.
    explicit PlateBuilder(std::uint64_t max_memory = 0) : max_memory_(max_memory) {}

    /// Adds a file. Calls `box_of` once for each instance. Throws as load_plate.
    void add(const PlateInput& input, MeshFile file, const BoxOf& box_of);
    [[nodiscard]] Plate finish();

  private:
    struct Instance {
        std::size_t input;
        std::size_t object;
        Transform placement;
        std::string label;
        bool support;
        bool negative;
        bool of_all; ///< subtracted from all parts, not only from those of its body
        std::uint64_t copy;
        std::uint64_t body; ///< MeshInstance::body
        Box3 box;
    };
    /// Instances with equal keys have equal layers up to an offset along x and y.
    struct Key {
        std::size_t input;
        std::size_t object;
        std::array<std::array<double, 3>, 3> linear;
        double z;
        std::partial_ordering operator<=>(const Key&) const = default;
    };

    static Key key_of(const Instance& instance);

    std::uint64_t max_memory_;
    Plate plate_;
    std::vector<std::vector<MeshObject>> objects_;
    std::vector<Instance> instances_;
    std::map<std::tuple<std::size_t, std::uint64_t, std::uint64_t>, std::vector<std::size_t>> bodies_;
};

} // namespace lamella

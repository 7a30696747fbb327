#pragma once

// From mesh files to a plate: what stands where, and which parts can share a shape.

#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/pipeline/plate.hpp"
#include "lamella/read/mesh_file.hpp"

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

/// Throws Error{usage} where there is none, and for what none of them can mean.
void check_inputs(std::span<const PlateInput> inputs);

/// Collects the instances of all files.
class PlateBuilder {
  public:
    /// The box of a mesh under a map.
    using BoxOf = std::function<Box3(const Mesh& mesh, const Transform& placement)>;

    /// `box_of` is asked once for each instance of the file. Throws as load_plate.
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
        std::uint64_t copy;
        std::uint64_t body; ///< MeshInstance::body
        Box3 box;
    };
    /// Equal keys, equal layers but for a way along x and y.
    struct Key {
        std::size_t input;
        std::size_t object;
        std::array<std::array<double, 3>, 3> linear;
        double z;
        std::partial_ordering operator<=>(const Key&) const = default;
    };

    static Key key_of(const Instance& instance);

    Plate plate_;
    std::vector<std::vector<MeshObject>> objects_;
    std::vector<Instance> instances_;
    /// Input, copy and body: their parts.
    std::map<std::tuple<std::size_t, std::uint64_t, std::uint64_t>, std::vector<std::size_t>> bodies_;
};

/// As load_plate, for files that have been read already: one for each input.
[[nodiscard]] Plate build_plate(std::span<const PlateInput> inputs, std::vector<MeshFile> files,
                                const Execution& execution);

} // namespace lamella

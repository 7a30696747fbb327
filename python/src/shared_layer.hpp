#pragma once

#include "lamella/contour/exposure.hpp"
#include "lamella/contour/layer.hpp"
#include "lamella/contour/measure.hpp"
#include "lamella/contour/plane_rule.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/polygon/nesting.hpp"

#include "made.hpp"

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace lamella::python {

/// A layer that never changes, and what is found out about it when somebody asks first. To be asked without
/// the interpreter lock, since another thread may be finding out the same.
class SharedLayer {
  public:
    explicit SharedLayer(Layer layer, std::optional<PlaneRule> rule = {})
        : layer_(std::move(layer)), rule_(rule) {}

    [[nodiscard]] const Layer& get() const noexcept { return layer_; }
    /// By which it was cut, and what it was made of; unset where that is arrays.
    [[nodiscard]] std::optional<PlaneRule> rule() const noexcept { return rule_; }
    [[nodiscard]] const LayerMeasure& measure() const;
    [[nodiscard]] const Nesting& nesting() const;
    [[nodiscard]] std::uint64_t hash() const;
    /// Ring by ring the ring around it, then a value for each chain; -1 is none.
    [[nodiscard]] const std::vector<std::int64_t>& parents() const;

  private:
    Layer layer_;
    std::optional<PlaneRule> rule_;
    mutable std::once_flag measured_;
    mutable std::once_flag nested_;
    mutable std::once_flag hashed_;
    mutable LayerMeasure measure_;
    mutable Nesting nesting_;
    mutable std::vector<std::int64_t> parents_;
    mutable std::uint64_t hash_ = 0;
};

using LayerPointer = std::shared_ptr<SharedLayer>;

/// The layers of one part, or of all parts of a file together.
struct Stack {
    std::vector<LayerPointer> layers;
    std::string label = {};
    /// Of the mesh that was sliced, as it was sliced. Where there was none, of the layers themselves; empty
    /// where these are.
    Box3 box = {};
    bool of_mesh = false; ///< which of both
    /// How many layers the plan has at least that these belong to, those included that were left out; 0 where
    /// that is not known.
    std::uint64_t planned = 0;
    /// From the coordinates of the mesh to those in which it was sliced.
    Transform matrix = {};
    /// The slice file it was read from; empty where it was sliced.
    std::string path = {};
    std::string format = {};
    Rounding rounding = {}; ///< of that file
    PlaneRule rule = PlaneRule::section_above;
    /// Where set, the layers are scan vectors.
    std::optional<Exposure> exposure = {};
    bool support = false; ///< marked so in that file
    /// The parts of a file that holds several, with as many layers.
    std::vector<std::shared_ptr<Stack>> parts = {};
};

/// See part_box.
[[nodiscard]] Box3 box_of(const std::vector<LayerPointer>& layers);
/// The box of the stack, or where it is empty the origin at the heights of its layers.
[[nodiscard]] Box3 shown_box(const Stack& stack);

[[nodiscard]] std::vector<LayerPointer> shared(LayerStack layers, std::optional<PlaneRule> rule);
/// The layer with points of its own. Slicing puts those of many layers into one block, which each of them
/// would keep in memory.
[[nodiscard]] Layer with_own_points(Layer layer);
/// Throws Error{usage} for no rule's name.
[[nodiscard]] PlaneRule rule_named(const std::string& name);
/// The layers themselves: their points stay where they are.
[[nodiscard]] LayerStack plain(const std::vector<LayerPointer>& shared);

} // namespace lamella::python

#pragma once

#include "lamella/contour/exposure.hpp"
#include "lamella/contour/layer.hpp"
#include "lamella/contour/measure.hpp"
#include "lamella/contour/plane_rule.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/polygon/fill.hpp"
#include "lamella/polygon/layer_steps.hpp"
#include "lamella/polygon/nesting.hpp"

#include "made.hpp"
#include "repairs.hpp"

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lamella::python {

/// An immutable layer with properties that are computed on first use. Its functions must be called without
/// the interpreter lock, because another thread may be computing the same property.
class SharedLayer {
  public:
    explicit SharedLayer(Layer layer, std::optional<PlaneRule> rule = {}, PointArray hatches = {},
                         std::vector<std::shared_ptr<SharedLayer>> parts = {})
        : layer_(std::move(layer)), hatches_(std::move(hatches)), rule_(rule), parts_(std::move(parts)) {}

    [[nodiscard]] const Layer& get() const noexcept { return layer_; }
    /// Returns the hatch lines of a slice file, or of scan vectors: two points for each line.
    [[nodiscard]] const PointArray& hatches() const noexcept { return hatches_; }
    /// Returns the layer and its hatch lines as a plane of one part.
    [[nodiscard]] Plane plane() const {
        Plane plane;
        plane.add(layer_, hatches_);
        return plane;
    }
    /// Returns the rule by which this layer, or the layer from which it was made, was cut; nullopt if it was
    /// made from arrays.
    [[nodiscard]] std::optional<PlaneRule> rule() const noexcept { return rule_; }
    /// Returns the layers of the parts from which this layer was merged; none if there are no several parts.
    [[nodiscard]] const std::vector<std::shared_ptr<SharedLayer>>& parts() const noexcept { return parts_; }
    [[nodiscard]] const LayerMeasure& measure() const;
    [[nodiscard]] const Nesting& nesting() const;
    [[nodiscard]] std::uint64_t hash() const;
    /// Returns, for each ring, the index of the ring around it, and then a value for each chain; -1 stands
    /// for none.
    [[nodiscard]] const std::vector<std::int64_t>& parents() const;

  private:
    Layer layer_;
    PointArray hatches_;
    std::optional<PlaneRule> rule_;
    std::vector<std::shared_ptr<SharedLayer>> parts_;
    mutable std::once_flag measured_;
    mutable std::once_flag nested_;
    mutable std::once_flag hashed_;
    mutable LayerMeasure measure_;
    mutable Nesting nesting_;
    mutable std::vector<std::int64_t> parents_;
    mutable std::uint64_t hash_ = 0;
};

using LayerPointer = std::shared_ptr<SharedLayer>;

/// Returns the hash of a layer as 16 hexadecimal digits. Must be called with the interpreter lock.
[[nodiscard]] std::string hash_text(const SharedLayer& layer);
/// Returns whether layers are equal, with their hatch lines.
[[nodiscard]] bool same(const SharedLayer& first, const SharedLayer& second);

/// The layers of one part, or of all parts of a file together.
struct Stack {
    std::vector<LayerPointer> layers;
    std::string label = {};
    /// Bounding box of the placed mesh that was sliced; without a mesh, that of the layers.
    Box3 box = {};
    bool of_mesh = false; ///< true if `box` is that of the mesh
    /// Lower bound on the number of layers of the whole plan, including those left out; 0 if unknown.
    std::uint64_t planned = 0;
    /// Transform from the coordinates of the mesh to those in which it was sliced.
    Transform matrix = {};
    /// The slice file that it was read from; empty if it was sliced.
    std::string path = {};
    std::string format = {};
    Rounding rounding = {}; ///< rounding of that file
    PlaneRule rule = PlaneRule::section_above;
    /// If set, the layers are scan vectors.
    std::optional<Exposure> exposure = {};
    bool support = false; ///< marked as support in that file
    Repairs repairs = {};
    /// The parts of a file with several parts, with the same number of layers.
    std::vector<std::shared_ptr<Stack>> parts = {};
};

using StackPointer = std::shared_ptr<Stack>;

/// See part_box.
[[nodiscard]] Box3 box_of(const std::vector<LayerPointer>& layers);
/// Returns the box of the stack or, if it is empty, the origin at the heights of its layers.
[[nodiscard]] Box3 shown_box(const Stack& stack);

/// `hatches` has the hatch lines of each layer, or none. `parts` are those from which the layers were merged.
[[nodiscard]] std::vector<LayerPointer> shared(LayerStack layers, std::optional<PlaneRule> rule,
                                               std::vector<PointArray> hatches = {},
                                               const std::vector<std::shared_ptr<Stack>>& parts = {});
/// Returns the layer with its own copy of its points. Slicing stores the points of many layers in one
/// allocation, which each of them would keep in memory.
[[nodiscard]] Layer with_own_points(Layer layer);
/// Returns the rule of this name. Throws Error{usage} for an unknown name.
[[nodiscard]] PlaneRule rule_named(const std::string& name);
/// Returns the rule of this name, which is one of the four.
[[nodiscard]] FillRule fill_rule(const std::string& name);

/// The inset of the first layers at the plate, and the height above it that none shrinks; or nothing.
using InsetAndHeight = std::optional<std::pair<double, double>>;
[[nodiscard]] BottomInset bottom_inset(const InsetAndHeight& given, double plate_mm);
/// Returns the layers without copying their points, and without their hatch lines.
[[nodiscard]] LayerStack plain(const std::vector<LayerPointer>& shared);
/// Returns those of each part.
[[nodiscard]] std::vector<LayerStack> plain_parts(const Stack& stack);

} // namespace lamella::python

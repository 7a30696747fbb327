// Slice stacks are in the root model or, by reference, in other model parts. Objects use stacks; components
// and build items place objects. Slices have the coordinates of their object.

#include "lamella/core/error.hpp"
#include "lamella/mesh/transform.hpp"

#include "container/text_position.hpp"
#include "container/xml.hpp"
#include "core/executor.hpp"
#include "core/farthest.hpp"
#include "read/layer_assembly.hpp"
#include "read/layer_readers.hpp"
#include "read/read_limits.hpp"
#include "read/three_mf_part.hpp"
#include "read/three_mf_terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {

namespace {

/// One slice, in the unit of its object, with the contours as written.
struct Slice {
    double top = 0;
    RawLayer raw;
};

struct Stack {
    double bottom = 0;
    std::vector<Slice> slices;
};

struct Object {
    std::string name;
    std::shared_ptr<const Stack> stack;
    std::vector<ThreeMfUse> components;
    ThreeMfObjectType type = ThreeMfObjectType::model;
};

/// Returns the bytes that a copy of the contours takes.
std::uint64_t contour_bytes(const RawLayer& raw) {
    return raw.points.size() * sizeof(Point2) + raw.ends.size() * sizeof(RawLayer::Contour);
}

/// Reads one model part.
class SliceModelReader {
  public:
    /// Returns the stack that a <sliceref> refers to.
    using FindStack = std::function<std::shared_ptr<const Stack>(const ThreeMfElement& reference)>;

    SliceModelReader(FindStack find, ReadLimits& limits) : find_(std::move(find)), limits_(limits) {}

    void start(const ThreeMfElement& element) {
        line_ = element.line;
        if (element.name.space == three_mf::slices)
            start_slice_element(element);
        else if (element.name.space == three_mf::core)
            start_core_element(element);
    }

    void end(XmlName element) {
        if (element == XmlName{three_mf::slices, "slicestack"})
            stack_.reset();
        else if (element == XmlName{three_mf::slices, "polygon"})
            end_polygon();
        else if (element == XmlName{three_mf::core, "object"})
            object_ = nullptr;
    }

    [[nodiscard]] double unit() const { return unit_; }
    [[nodiscard]] const std::map<std::uint32_t, Object>& objects() const { return objects_; }
    [[nodiscard]] const std::vector<ThreeMfUse>& items() const { return items_; }
    /// Returns the parts that items and components refer to, as written.
    [[nodiscard]] std::vector<std::string> used_parts() const {
        std::vector<std::string> parts;
        const auto add = [&](const std::vector<ThreeMfUse>& uses) {
            for (const ThreeMfUse& use : uses)
                if (!use.part.empty())
                    parts.push_back(use.part);
        };
        add(items_);
        for (const auto& [id, object] : objects_)
            add(object.components);
        return parts;
    }
    [[nodiscard]] const std::map<std::uint32_t, std::shared_ptr<const Stack>>& stacks() const {
        return stacks_;
    }
    void append_to(std::vector<std::string>& warnings) const {
        open_.append_to(warnings);
        returning_.append_to(warnings);
        dropped_.append_to(warnings);
    }

  private:
    /// Returns the position of the parser, for errors.
    auto location() const { return at_line(line_); }

    void start_core_element(const ThreeMfElement& element) {
        const std::string_view name = element.name.local;
        if (name == "model") {
            unit_ = element.unit_mm();
            static_cast<void>(element.required_extensions());
        } else if (name == "object") {
            const std::string_view label = element["name"].text;
            limits_.add_bytes_at(node_bytes + sizeof(Object) + label.size(), location());
            const std::uint32_t id = element["id"].index();
            const auto [object, is_new] =
                objects_.try_emplace(id, Object{std::string(label), nullptr, {}, element.object_type()});
            if (!is_new)
                element.fail(fmt::format("id {} for the second time", id), "ids that differ");
            object_ = &object->second;
            if (const ThreeMfValue stack = element[XmlName{three_mf::slices, "slicestackid"}]; stack.is_there)
                object_->stack = stack_of(stack);
        } else if (name == "component" && object_ != nullptr) {
            limits_.make_room(object_->components, 1, location());
            object_->components.push_back(element.use(unit_));
        } else if (name == "item") {
            limits_.make_room(items_, 1, location());
            items_.push_back(element.use(unit_));
        }
    }

    void start_slice_element(const ThreeMfElement& element) {
        const std::string_view name = element.name.local;
        if (name == "slicestack") {
            const std::uint32_t id = element["id"].index();
            limits_.add_bytes_at(node_bytes + sizeof(Stack), location());
            stack_ = std::make_shared<Stack>();
            if (!stacks_.try_emplace(id, stack_).second)
                element.fail(fmt::format("a second slice stack {}", id), "ids that differ");
            stack_->bottom = element["zbottom"].number_or(0);
        } else if (name == "sliceref" && stack_) {
            append(*find_(element), element);
        } else if (name == "slice" && stack_) {
            const double top = element["ztop"].number();
            if (!(top > top_of_stack()))
                element.fail(fmt::format("a slice with ztop = {}", top),
                             fmt::format("it to lie above z = {}", top_of_stack()));
            limits_.make_room(stack_->slices, 1, location());
            stack_->slices.emplace_back().top = top;
            vertices_.clear();
        } else if (name == "vertex" && in_slice()) {
            limits_.make_room(vertices_, 1, location());
            vertices_.push_back({element["x"].number(), element["y"].number()});
        } else if (name == "polygon" && in_slice()) {
            start_ = element["startv"].index();
            add_point(*start_, element);
        } else if (name == "segment" && in_slice() && start_) {
            add_point(element["v2"].index(), element);
        }
    }

    [[nodiscard]] bool in_slice() const { return stack_ && !stack_->slices.empty(); }
    RawLayer& raw() { return stack_->slices.back().raw; }

    [[nodiscard]] double top_of_stack() const {
        return stack_->slices.empty() ? stack_->bottom : stack_->slices.back().top;
    }

    void add_point(std::uint32_t index, const ThreeMfElement& element) {
        if (index >= vertices_.size())
            element.fail(fmt::format("vertex {}", index),
                         fmt::format("less than {}, the number of vertices of the slice", vertices_.size()));
        last_ = index;
        limits_.make_room(raw().points, 1, location());
        raw().points.push_back(vertices_[index]);
    }

    void end_polygon() {
        if (!in_slice() || !start_)
            return;
        const bool returning_chain = last_ != start_ && raw().is_returning_chain();
        const bool closed = last_ == start_ || returning_chain;
        if (returning_chain)
            returning_.note(location());
        else if (!closed)
            open_.note(location());
        raw().end_contour(closed, 0, limits_, location(), dropped_);
        start_.reset();
    }

    /// Appends a stack to this one. The tops of all its slices must be above this stack. Its first slice
    /// begins at the top of this stack.
    void append(const Stack& other, const ThreeMfElement& element) {
        for (const Slice& slice : other.slices) {
            if (!(slice.top > top_of_stack()))
                element.fail(fmt::format("a reference to slices that end at z = {}", slice.top),
                             fmt::format("them to lie above z = {}", top_of_stack()));
            limits_.make_room(stack_->slices, 1, location());
            limits_.add_bytes_at(contour_bytes(slice.raw), location());
            stack_->slices.push_back(slice);
        }
    }

    [[nodiscard]] std::shared_ptr<const Stack> stack_of(const ThreeMfValue& id) const {
        const auto found = stacks_.find(id.index());
        if (found == stacks_.end())
            id.element.fail(fmt::format("slice stack {}", id.text), "one that is defined before it is used");
        return found->second;
    }

    FindStack find_;
    ReadLimits& limits_;
    std::size_t line_ = 0;
    double unit_ = 1;
    std::map<std::uint32_t, std::shared_ptr<const Stack>> stacks_;
    std::map<std::uint32_t, Object> objects_;
    std::vector<ThreeMfUse> items_;
    std::shared_ptr<Stack> stack_; ///< under construction
    std::vector<Point2> vertices_;
    std::optional<std::uint32_t> start_; ///< first vertex of the polygon under construction
    std::uint32_t last_ = 0;
    Object* object_ = nullptr;
    CountedWarning open_{"contour is open", "contours are open"};
    ReturningChains returning_;
    DroppedContours dropped_;
};

/// A stack with the placement by a build item.
struct Placed {
    std::string label;
    std::shared_ptr<const Stack> stack;
    Transform placement; ///< applies to millimetres
    double scale = 1;    ///< millimetres per unit of the stack
    double shift = 0;
    bool support = false;

    [[nodiscard]] double height(double z) const { return z * scale + shift; }
};

class PackageReader {
  public:
    PackageReader(const ZipReader& zip, LayerFile& file, ReadLimits& limits, const Execution& execution)
        : zip_(zip), root_(root_model(zip)), file_(file), limits_(limits), executor_(execution) {}

    void read() {
        if (zip_.find(root_) == nullptr)
            throw NoLayers(fmt::format("{}: found no part '{}'; a 3MF file of layers has its model there",
                                       zip_.name(), printable(root_, 100)));
        const Model& model = model_of(root_);
        // A package without slices may use features in its build that are not supported here.
        if (has_slices(model))
            for (const ThreeMfUse& item : model.reader->items())
                place(model, item, {}, false, 0);
        if (placed_.empty())
            throw NoLayers(
                fmt::format("{}: found no slice stack in the build; a 3MF file of layers has one for each "
                            "object",
                            zip_.name()));
        for (const CountedWarning* warning : {&without_slices_, &no_solid_, &not_printed_})
            warning->append_to(file_.warnings);
        make_layers();
    }

  private:
    struct Model {
        std::string part;
        std::unique_ptr<SliceModelReader> reader;
    };

    std::unique_ptr<SliceModelReader> read_model(const ByteSource& source, SliceModelReader::FindStack find) {
        auto model = std::make_unique<SliceModelReader>(std::move(find), limits_);
        parse_part(
            source, [&](const ThreeMfElement& element) { model->start(element); },
            [&](XmlName name) { model->end(name); }, executor_);
        model->append_to(file_.warnings);
        return model;
    }

    /// Returns a part whose objects are placed; reads it on first use.
    const Model& model_of(const std::string& part) {
        Model& model = models_[part];
        if (!model.reader) {
            model.part = part;
            model.reader =
                read_model(unpack_part(zip_, part, limits_),
                           [&, part](const ThreeMfElement& reference) { return referred(reference, part); });
        }
        return model;
    }

    /// Returns whether the root, or a part whose objects it uses, has slice stacks. Such a part must declare
    /// the extension.
    bool has_slices(const Model& root) {
        if (!root.reader->stacks().empty())
            return true;
        std::set<std::string> parts;
        for (const std::string& reference : root.reader->used_parts())
            parts.insert(opc_resolved(zip_, root_, reference));
        return std::any_of(parts.begin(), parts.end(), [&](const std::string& part) {
            if (zip_.find(part) == nullptr)
                return false; // reading the meshes reports this
            return unpack_part(zip_, part, limits_).text().find(three_mf::slices) != std::string_view::npos;
        });
    }

    /// Returns a stack in another part, which must not refer to a third part. Its lengths are in the unit of
    /// the part that refers to it, as other programs interpret it.
    std::shared_ptr<const Stack> referred(const ThreeMfElement& reference, const std::string& from) {
        const std::string part = opc_resolved(zip_, from, reference["slicepath"].text);
        const std::uint32_t id = reference["slicestackid"].index();
        auto& model = parts_[part];
        if (!model)
            model = read_model(unpack_part(zip_, part, limits_),
                               [](const ThreeMfElement& second) -> std::shared_ptr<const Stack> {
                                   second.fail("a reference to slices within slices that are referred to",
                                               "slices");
                               });
        const auto found = model->stacks().find(id);
        if (found == model->stacks().end())
            reference.fail(fmt::format("a reference to slice stack {} of '{}'", id, printable(part, 100)),
                           "one that is there");
        return found->second;
    }

    void place(const Model& user, const ThreeMfUse& use, const Transform& outer, bool in_support, int depth) {
        constexpr int deepest = 32;
        constexpr std::size_t most = std::size_t{1} << 20;
        if (!use.part.empty() && &user != &models_.at(root_))
            throw Error(ErrorKind::input,
                        fmt::format("{}, part '{}', line {}: found path '{}' in a part that is not the root, "
                                    "expected none: only the root may refer to other parts",
                                    zip_.name(), printable(user.part, 100), use.line,
                                    printable(use.part, 100)));
        const Model& model = use.part.empty() ? user : model_of(opc_resolved(zip_, root_, use.part));
        const auto object = model.reader->objects().find(use.object);
        if (object == model.reader->objects().end())
            throw Error(
                ErrorKind::input,
                fmt::format("{}, line {}: found no object {}{}", zip_.name(), use.line, use.object,
                            use.part.empty() ? "" : fmt::format(" in '{}'", printable(model.part, 100))));
        if (depth > deepest || placed_.size() >= most || ++uses_ > most)
            throw Error(ErrorKind::input,
                        fmt::format("{}, line {}: found components within components without end",
                                    zip_.name(), use.line));
        const ThreeMfObjectType type = object->second.type;
        const bool is_other = type == ThreeMfObjectType::other;
        if (depth == 0 && is_other)
            throw Error(ErrorKind::input, fmt::format("{}, line {}: the build holds object {}, whose type "
                                                      "'other' says that it is not to be made",
                                                      zip_.name(), use.line, use.object));
        if (depth == 0 && !use.printable)
            return not_printed_.note(at_line(use.line));
        if (is_other || type == ThreeMfObjectType::surface)
            return no_solid_.note(at_line(use.line));
        const Transform placement = compose(outer, use.placement);
        const bool support =
            in_support || type == ThreeMfObjectType::support || type == ThreeMfObjectType::solid_support;
        if (!object->second.stack) { // an object's own stack replaces those of its components
            if (object->second.components.empty())
                without_slices_.note(at_line(use.line));
            for (const ThreeMfUse& component : object->second.components)
                place(model, component, placement, support, depth + 1);
            return;
        }
        limits_.make_room(placed_, 1, at_line(use.line));
        limits_.add_bytes_at(object->second.name.size(), at_line(use.line));
        placed_.push_back(in_millimetres(object->second, placement, model.reader->unit(), use.line));
        placed_.back().support = support;
    }

    Placed in_millimetres(const Object& object, const Transform& placement, double unit,
                          std::size_t line) const {
        const auto& m = placement.linear;
        constexpr double tolerance = 1e-7;
        const bool planar = std::abs(m[0][2]) <= tolerance && std::abs(m[1][2]) <= tolerance &&
                            std::abs(m[2][0]) <= tolerance && std::abs(m[2][1]) <= tolerance &&
                            std::abs(m[2][2] - 1) <= tolerance;
        if (!planar || !finite(placement))
            throw NoLayers(
                fmt::format("{}, line {}: found a transform that tilts slices or changes their heights; "
                            "slices may only be moved, and rotated, scaled and mirrored in their plane",
                            zip_.name(), line));
        return {object.name, object.stack, placement, unit, placement.offset[2]};
    }

    void check_reach(const Point3& p) const {
        if (is_too_far(p))
            throw Error(ErrorKind::input, fmt::format("{}: the build puts slices further away than {} mm",
                                                      zip_.name(), farthest_mm));
    }

    /// Describes a part by its number in the build, for errors.
    static auto place_of(std::size_t part) {
        return [part] {
            return fmt::format("part {} of the build", part + 1);
        };
    }

    /// Makes layers. All parts get the same planes. If slices of parts end at different heights, they are
    /// divided, which does not change the material.
    void make_layers() {
        std::vector<double> heights;
        std::uint64_t points = 0;
        for (std::size_t k = 0; k < placed_.size(); ++k) {
            const Placed& part = placed_[k];
            limits_.make_room(heights, 1 + part.stack->slices.size(), place_of(k));
            check_reach({0, 0, part.height(part.stack->bottom)});
            heights.push_back(part.height(part.stack->bottom));
            for (const Slice& slice : part.stack->slices) {
                check_reach({0, 0, part.height(slice.top)});
                heights.push_back(part.height(slice.top));
                points += slice.raw.points.size();
            }
        }
        std::sort(heights.begin(), heights.end());
        // Heights that differ only by rounding are equal.
        constexpr double same = 1e-9;
        heights.erase(
            std::unique(heights.begin(), heights.end(),
                        [&](double a, double b) { return b - a <= same * std::max(1.0, std::abs(b)); }),
            heights.end());
        if (heights.size() < 2)
            throw Error(ErrorKind::input,
                        fmt::format("{}: found slice stacks without slices; a slice file must have "
                                    "at least one layer",
                                    zip_.name()));
        ReadLabels labels;
        for (std::size_t k = 0; k < placed_.size(); ++k) {
            limits_.make_room(file_.parts, 1, place_of(k));
            limits_.add_bytes_at(placed_[k].label.size(), place_of(k));
            file_.parts.push_back(
                {.label = labels.of(placed_[k].label), .layers = {}, .support = placed_[k].support});
        }
        labels.append_to(file_.warnings);
        check_part_planes(file_, heights.size() - 1, std::max(points, zip_.unpacked()));
        std::uint64_t left = 64 * (points + heights.size() + (std::uint64_t{1} << 20));
        for (std::size_t k = 0; k < placed_.size(); ++k)
            add_part(k, heights, left);
    }

    void add_part(std::size_t index, const std::vector<double>& heights, std::uint64_t& left) const {
        const Placed& part = placed_[index];
        LayerStack& layers = file_.parts[index].layers;
        const std::vector<Slice>& slices = part.stack->slices;
        std::size_t next = 0;
        const Layer* last = nullptr;
        std::size_t last_slice = slices.size();
        limits_.make_room(layers, heights.size() - 1, place_of(index));
        limits_.add_bytes_at((heights.size() - 1) * of_empty_layer, place_of(index));
        for (std::size_t i = 0; i + 1 < heights.size(); ++i) {
            executor_.check_cancelled();
            const double bottom = heights[i];
            const double top = heights[i + 1];
            const double z = bottom + (top - bottom) / 2;
            while (next < slices.size() && part.height(slices[next].top) < z)
                ++next;
            const bool inside = next < slices.size() && z > part.height(part.stack->bottom);
            Layer layer;
            if (inside && next == last_slice) {
                layer = *last; // shares the points
            } else if (inside) {
                const std::uint64_t size = slices[next].raw.points.size();
                if (size > left)
                    throw Error(
                        ErrorKind::input,
                        fmt::format("{}: found the same slices placed so often that they would have more "
                                    "than 64 times their points",
                                    zip_.name()));
                left -= size;
                limits_.add_bytes_at(2 * contour_bytes(slices[next].raw), place_of(index)); // growing arrays
                layer = placed_layer(part, slices[next].raw);
            }
            layer.index = i;
            layer.z = z;
            layer.bottom = bottom;
            layer.top = top;
            layers.push_back(std::move(layer));
            if (inside) {
                last = &layers.back();
                last_slice = next;
            }
        }
    }

    Layer placed_layer(const Placed& part, const RawLayer& raw) const {
        const auto& m = part.placement.linear;
        const bool mirrors = m[0][0] * m[1][1] - m[0][1] * m[1][0] < 0;
        LayerBuilder builder;
        std::size_t begin = 0;
        for (const RawLayer::Contour& contour : raw.ends) {
            for (std::size_t i = begin; i < contour.end; ++i) {
                // Mirroring reverses the direction of a ring.
                const Point2& p = raw.points[mirrors ? contour.end - 1 - (i - begin) : i];
                const Point3 at = part.placement(Point3{p.x * part.scale, p.y * part.scale, 0});
                check_reach(at);
                builder.add_point({at.x, at.y});
            }
            builder.end_contour(contour.closed);
            begin = contour.end;
        }
        return builder.finish(0, 0, 0, 0);
    }

    const ZipReader& zip_;
    std::string root_;
    LayerFile& file_;
    ReadLimits& limits_;
    Executor executor_;
    std::map<std::string, Model> models_;                            ///< parts with objects
    std::map<std::string, std::unique_ptr<SliceModelReader>> parts_; ///< referenced parts
    std::vector<Placed> placed_;
    std::size_t uses_ = 0;
    CountedWarning without_slices_{"object of the build has no slices; it was left out",
                                   "objects of the build have no slices; they were left out"};
    CountedWarning no_solid_{"object is of type surface or other, which is no solid; it was left out",
                             "objects are of type surface or other, which are no solids; they were left out"};
    CountedWarning not_printed_{"item is marked in the build as not to be printed; it was left out",
                                "items are marked in the build as not to be printed; they were left out"};
};

} // namespace

bool is_3mf(const ZipReader& zip) {
    return zip.find("_rels/.rels") != nullptr || zip.find(three_mf::usual_root) != nullptr;
}

LayerFile read_slices_3mf(const ZipReader& package, ReadLimits& limits, const Execution& execution) {
    LayerFile file{.path = package.name(),
                   .format = "3mf",
                   .units_mm = 1,
                   .rounding = text_rounding,
                   .warnings = package.counted_warnings()};
    PackageReader(package, file, limits, execution).read();
    return file;
}

} // namespace lamella

// Slice stacks stand in the root model or, by reference, in other model parts; objects use stacks, components
// and build items put objects somewhere. Coordinates of slices are those of their object.

#include "lamella/core/error.hpp"
#include "lamella/mesh/transform.hpp"

#include "container/text_place.hpp"
#include "container/xml.hpp"
#include "core/executor.hpp"
#include "core/parse_number.hpp"
#include "read/layer_assembly.hpp"
#include "read/layer_readers.hpp"
#include "read/read_limits.hpp"
#include "read/three_mf_terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace lamella {

namespace {

/// One slice, in the unit of its object, with the contours as they stand there.
struct Slice {
    double top = 0;
    RawLayer raw;
};

struct Stack {
    double bottom = 0;
    std::vector<Slice> slices;
};

struct Use {
    std::uint32_t object = 0;
    Transform placement; ///< in the unit of the model
    std::size_t line = 0;
};

struct Object {
    std::string name;
    std::shared_ptr<const Stack> stack;
    std::vector<Use> components;
    bool support = false;
};

/// What a copy of the contours takes.
std::uint64_t contour_bytes(const RawLayer& raw) {
    return raw.points.size() * sizeof(Point2) + raw.ends.size() * sizeof(RawLayer::Contour);
}

/// One model part.
class SliceModelReader {
  public:
    using FindStack = std::function<std::shared_ptr<const Stack>(std::string_view path, std::uint32_t id)>;

    SliceModelReader(std::string name, FindStack find, ReadLimits& limits)
        : name_(std::move(name)), find_(std::move(find)), limits_(limits) {}

    void start(XmlName element, const XmlAttributes& attributes, std::size_t line) {
        line_ = line;
        if (element.space == three_mf::slices)
            start_slice_element(element.local, attributes);
        else if (element.space == three_mf::core)
            start_core_element(element.local, attributes);
    }

    void end(XmlName element) {
        if (element == XmlName{three_mf::slices, "slicestack"})
            end_stack();
        else if (element == XmlName{three_mf::slices, "polygon"})
            end_polygon();
        else if (element == XmlName{three_mf::core, "object"})
            object_ = nullptr;
    }

    [[nodiscard]] double unit() const { return unit_; }
    [[nodiscard]] const std::map<std::uint32_t, Object>& objects() const { return objects_; }
    [[nodiscard]] const std::vector<Use>& items() const { return items_; }
    [[nodiscard]] const std::map<std::uint32_t, std::shared_ptr<const Stack>>& stacks() const {
        return stacks_;
    }
    void say(std::vector<std::string>& warnings) const {
        open_.say(warnings);
        dropped_.say(warnings);
    }

    [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
        throw Error(ErrorKind::input,
                    fmt::format("{}, line {}: found {}; {}", name_, line_, found, expected));
    }

  private:
    /// Where the parser is, as errors call it.
    auto place() const {
        return [this] {
            return fmt::format("line {}", line_);
        };
    }

    void start_core_element(std::string_view element, const XmlAttributes& attributes) {
        if (element == "model") {
            const std::string_view unit = attributes.find("unit");
            unit_ = unit.data() == nullptr ? 1 : three_mf::unit_mm(unit).value_or(0);
            if (unit_ == 0)
                fail(fmt::format("the unit '{}'", printable(unit, 40)),
                     "it must be millimeter or another of 3MF's");
        } else if (element == "object") {
            const std::uint32_t id = whole(attributes, "id");
            const std::string_view name = attributes.find("name");
            limits_.add_bytes_at(node_bytes + sizeof(Object) + name.size(), place());
            object_ = &objects_[id];
            *object_ = {std::string(name), nullptr, {}, attributes.find("type") == "support"};
            if (const std::string_view stack = attributes.find(XmlName{three_mf::slices, "slicestackid"});
                stack.data() != nullptr)
                object_->stack = stack_of(whole_of(stack, "slicestackid"));
        } else if (element == "component" && object_ != nullptr) {
            limits_.make_room(object_->components, 1, place());
            object_->components.push_back(use(attributes));
        } else if (element == "item") {
            limits_.make_room(items_, 1, place());
            items_.push_back(use(attributes));
        }
    }

    void start_slice_element(std::string_view element, const XmlAttributes& attributes) {
        if (element == "slicestack") {
            stack_id_ = whole(attributes, "id");
            limits_.add_bytes_at(node_bytes + sizeof(Stack), place());
            stack_ = std::make_shared<Stack>();
            const std::string_view bottom = attributes.find("zbottom");
            stack_->bottom = bottom.data() == nullptr ? 0 : number_of(bottom, "zbottom");
        } else if (element == "sliceref" && stack_) {
            append(*find_(attributes.find("slicepath"), whole(attributes, "slicestackid")));
        } else if (element == "slice" && stack_) {
            const double top = number(attributes, "ztop");
            const double below = stack_->slices.empty() ? stack_->bottom : stack_->slices.back().top;
            if (!(top > below))
                fail(fmt::format("a slice with ztop = {}", top),
                     fmt::format("it must lie above z = {}", below));
            limits_.make_room(stack_->slices, 1, place());
            stack_->slices.emplace_back().top = top;
            vertices_.clear();
        } else if (element == "vertex" && in_slice()) {
            limits_.make_room(vertices_, 1, place());
            vertices_.push_back({number(attributes, "x"), number(attributes, "y")});
        } else if (element == "polygon" && in_slice()) {
            start_ = whole(attributes, "startv");
            last_ = start_;
            begin_ = raw().points.size();
            limits_.make_room(raw().points, 1, place());
            raw().points.push_back(vertex(start_));
        } else if (element == "segment" && in_slice() && start_) {
            last_ = whole(attributes, "v2");
            limits_.make_room(raw().points, 1, place());
            raw().points.push_back(vertex(*last_));
        }
    }

    [[nodiscard]] bool in_slice() const { return stack_ && !stack_->slices.empty(); }
    RawLayer& raw() { return stack_->slices.back().raw; }

    Point2 vertex(std::optional<std::uint32_t> index) const {
        if (*index >= vertices_.size())
            fail(fmt::format("vertex {}", *index), fmt::format("the slice has {}", vertices_.size()));
        return vertices_[*index];
    }

    void end_polygon() {
        if (!in_slice() || !start_)
            return;
        const bool closed = last_ == start_;
        if (!closed)
            open_.note(place());
        limits_.make_room(raw().ends, 1, place());
        if (!raw().end_clean_contour(begin_, closed))
            dropped_.note(place());
        start_.reset();
    }

    void end_stack() {
        if (stack_ && !stacks_.try_emplace(stack_id_, stack_).second)
            fail(fmt::format("a second slice stack {}", stack_id_), "ids must be unique");
        stack_.reset();
    }

    /// Stacks that are put on one another: where they do not meet, the upper one begins where the lower one
    /// ends.
    void append(const Stack& other) {
        for (const Slice& slice : other.slices) {
            const double below = stack_->slices.empty() ? stack_->bottom : stack_->slices.back().top;
            if (!(slice.top > below))
                fail(fmt::format("a reference to slices that end at z = {}", slice.top),
                     fmt::format("they must lie above z = {}", below));
            limits_.make_room(stack_->slices, 1, place());
            limits_.add_bytes_at(contour_bytes(slice.raw), place());
            stack_->slices.push_back(slice);
        }
    }

    std::shared_ptr<const Stack> stack_of(std::uint32_t id) const {
        const auto found = stacks_.find(id);
        if (found == stacks_.end())
            fail(fmt::format("slice stack {}", id), "it must be defined before it is used");
        return found->second;
    }

    Use use(const XmlAttributes& attributes) const {
        Use use{whole(attributes, "objectid"), {}, line_};
        std::string_view text = attributes.find("transform");
        if (text.data() == nullptr)
            return use;
        std::array<double, 12> m{};
        for (double& value : m) {
            text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
            const std::size_t end = std::min(text.find_first_of(" \t\r\n"), text.size());
            value = number_of(text.substr(0, end), "transform");
            text.remove_prefix(end);
        }
        // Rows of the matrix are multiplied from the left.
        for (std::size_t r = 0; r < 3; ++r) {
            for (std::size_t c = 0; c < 3; ++c)
                use.placement.linear[r][c] = m[3 * c + r];
            use.placement.offset[r] = m[9 + r];
        }
        return use;
    }

    std::uint32_t whole(const XmlAttributes& attributes, std::string_view name) const {
        return whole_of(attributes.find(name), name);
    }
    std::uint32_t whole_of(std::string_view text, std::string_view name) const {
        std::uint32_t value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (text.empty() || error != std::errc() || end != text.data() + text.size())
            fail(fmt::format("{} = '{}'", name, printable(text, 40)), "it must be a whole number");
        return value;
    }
    double number(const XmlAttributes& attributes, std::string_view name) const {
        return number_of(attributes.find(name), name);
    }
    double number_of(std::string_view text, std::string_view name) const {
        if (text.starts_with('+'))
            text.remove_prefix(1);
        double value = 0;
        const char* const end = parse_number(text.data(), text.data() + text.size(), value);
        // What lies further away could make sums and areas overflow; no part is near it.
        constexpr double farthest = 1e30;
        if (text.empty() || end != text.data() + text.size() || !(std::abs(value) <= farthest))
            fail(fmt::format("{} = '{}'", name, printable(text, 40)),
                 fmt::format("it must be a number within {}", farthest));
        return value;
    }

    std::string name_;
    FindStack find_;
    ReadLimits& limits_;
    std::size_t line_ = 0;
    double unit_ = 1;
    std::map<std::uint32_t, std::shared_ptr<const Stack>> stacks_;
    std::map<std::uint32_t, Object> objects_;
    std::vector<Use> items_;
    std::shared_ptr<Stack> stack_; ///< under construction
    std::uint32_t stack_id_ = 0;
    std::vector<Point2> vertices_;
    std::optional<std::uint32_t> start_; ///< of the polygon under construction
    std::optional<std::uint32_t> last_;
    std::size_t begin_ = 0;
    Object* object_ = nullptr;
    Oddity open_{"contours are open"};
    Oddity dropped_{"contours had too few different points; they were dropped"};
};

/// A stack where a build item puts it.
struct Placed {
    std::string label;
    std::shared_ptr<const Stack> stack;
    Transform placement; ///< to millimetres
    double scale = 1;    ///< of heights
    double shift = 0;
    bool support = false;

    [[nodiscard]] double height(double z) const { return z * scale + shift; }
};

class PackageReader {
  public:
    PackageReader(const OpcPackage& package, LayerFile& file, ReadLimits& limits, const Execution& execution)
        : package_(package), zip_(package.zip()), root_(root_part()), file_(file), limits_(limits),
          executor_(execution) {}

    void read() {
        const std::unique_ptr<SliceModelReader> model =
            read_model(root_, [&](std::string_view path, std::uint32_t id) { return referred(path, id); });
        unit_ = model->unit();
        for (const Use& item : model->items())
            place(*model, item, {}, false, 0);
        if (placed_.empty())
            throw Error(
                ErrorKind::input,
                fmt::format("{}: found no slice stack in the build; a 3MF file of layers has one for each "
                            "object",
                            zip_.name()));
        make_layers();
    }

  private:
    [[nodiscard]] std::string root_part() const {
        for (const OpcRelationship& relationship : package_.relationships(""))
            if (relationship.type == three_mf::model_type && !relationship.external)
                return relationship.target;
        return "3D/3dmodel.model";
    }

    std::unique_ptr<SliceModelReader> read_model(const std::string& part, SliceModelReader::FindStack find) {
        const ZipEntry* entry = zip_.find(part);
        if (entry == nullptr)
            throw Error(ErrorKind::input, fmt::format("{}: found no part '{}', to which the package refers",
                                                      zip_.name(), printable(part, 100)));
        const std::uint64_t before = zip_.unpacked();
        const ByteSource source = zip_.read(*entry);
        const std::uint64_t unpacked = zip_.unpacked() - before;
        limits_.add_bytes_at(unpacked, [&] { return fmt::format("part '{}'", printable(part, 100)); });
        auto model = std::make_unique<SliceModelReader>(source.name, std::move(find), limits_);
        XmlHandlers handlers;
        handlers.start = [&](XmlName name, const XmlAttributes& attributes, std::size_t line) {
            model->start(name, attributes, line);
        };
        handlers.end = [&](XmlName name) {
            model->end(name);
        };
        handlers.progress = [&](std::size_t) {
            executor_.check_cancelled();
        };
        parse_xml(source.text(), source.name, handlers,
                  {.namespaces = true, .utf8_only = true, .no_document_type = true});
        limits_.give_back(0, unpacked);
        model->say(file_.warnings);
        return model;
    }

    /// A stack in another part, which may not refer to a third one. Its lengths are taken to be in the unit
    /// of the root, as other readers take them.
    std::shared_ptr<const Stack> referred(std::string_view path, std::uint32_t id) {
        const std::string part = OpcPackage::resolve(root_, path);
        auto& model = parts_[part];
        if (!model)
            model = read_model(part, [&](std::string_view, std::uint32_t) -> std::shared_ptr<const Stack> {
                throw Error(ErrorKind::input,
                            fmt::format("{}: found a reference to slices within slices that are referred to",
                                        printable(part, 100)));
            });
        const auto found = model->stacks().find(id);
        if (found == model->stacks().end())
            throw Error(ErrorKind::input, fmt::format("{}: found no slice stack {} in '{}'", zip_.name(), id,
                                                      printable(part, 100)));
        return found->second;
    }

    void place(const SliceModelReader& model, const Use& use, const Transform& outer, bool in_support,
               int depth) {
        constexpr int deepest = 32;
        constexpr std::size_t most = std::size_t{1} << 20;
        const auto object = model.objects().find(use.object);
        if (object == model.objects().end())
            throw Error(ErrorKind::input,
                        fmt::format("{}, line {}: found no object {}", zip_.name(), use.line, use.object));
        if (depth > deepest || placed_.size() >= most || ++uses_ > most)
            throw Error(ErrorKind::input,
                        fmt::format("{}, line {}: found components within components without end",
                                    zip_.name(), use.line));
        const Transform placement = compose(outer, use.placement);
        const bool support = in_support || object->second.support;
        if (!object->second.stack) { // a stack above its components counts, not theirs
            for (const Use& component : object->second.components)
                place(model, component, placement, support, depth + 1);
            return;
        }
        const auto line = [&] {
            return fmt::format("line {}", use.line);
        };
        limits_.make_room(placed_, 1, line);
        limits_.add_bytes_at(object->second.name.size(), line);
        placed_.push_back(in_millimetres(object->second, placement, use.line));
        placed_.back().support = support;
    }

    Placed in_millimetres(const Object& object, const Transform& placement, std::size_t line) const {
        const auto& m = placement.linear;
        constexpr double tolerance = 1e-7;
        const bool planar = std::abs(m[0][2]) <= tolerance && std::abs(m[1][2]) <= tolerance &&
                            std::abs(m[2][0]) <= tolerance && std::abs(m[2][1]) <= tolerance &&
                            std::abs(m[2][2] - 1) <= tolerance;
        if (!planar || !finite(placement))
            throw Error(
                ErrorKind::input,
                fmt::format("{}, line {}: found a transform that tilts slices or changes their heights; "
                            "slices may only be moved, and turned, scaled and mirrored in their plane",
                            zip_.name(), line));
        return {object.name, object.stack, placement, unit_, placement.offset[2] * unit_};
    }

    /// A part of the file, counted as in the build, for errors.
    static auto place_of(std::size_t part) {
        return [part] {
            return fmt::format("part {} of the build", part + 1);
        };
    }

    /// All parts get the same planes: where their slices end at different heights, slices are divided, which
    /// changes nothing about the material.
    void make_layers() {
        std::vector<double> heights;
        std::uint64_t points = 0;
        for (std::size_t k = 0; k < placed_.size(); ++k) {
            const Placed& part = placed_[k];
            limits_.make_room(heights, 1 + part.stack->slices.size(), place_of(k));
            heights.push_back(part.height(part.stack->bottom));
            for (const Slice& slice : part.stack->slices) {
                heights.push_back(part.height(slice.top));
                points += slice.raw.points.size();
            }
        }
        std::sort(heights.begin(), heights.end());
        // Heights that differ by rounding alone are one.
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
        for (std::size_t k = 0; k < placed_.size(); ++k) {
            limits_.make_room(file_.parts, 1, place_of(k));
            limits_.add_bytes_at(placed_[k].label.size(), place_of(k));
            file_.parts.push_back({.label = placed_[k].label, .layers = {}, .support = placed_[k].support});
        }
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
                layer = *last; // points are shared
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
                // A mirrored ring would run the wrong way round.
                const Point2& p = raw.points[mirrors ? contour.end - 1 - (i - begin) : i];
                const Point3 at = part.placement(Point3{p.x, p.y, 0});
                builder.add_point({at.x * unit_, at.y * unit_});
            }
            builder.end_contour(contour.closed);
            begin = contour.end;
        }
        return builder.finish(0, 0, 0, 0);
    }

    const OpcPackage& package_;
    const ZipReader& zip_;
    std::string root_;
    LayerFile& file_;
    ReadLimits& limits_;
    Executor executor_;
    double unit_ = 1;
    std::map<std::string, std::unique_ptr<SliceModelReader>> parts_;
    std::vector<Placed> placed_;
    std::size_t uses_ = 0;
};

} // namespace

bool is_3mf(const ZipReader& zip) {
    return zip.find("_rels/.rels") != nullptr || zip.find("3D/3dmodel.model") != nullptr;
}

LayerFile read_slices_3mf(const OpcPackage& package, ReadLimits& limits, const Execution& execution) {
    LayerFile file;
    file.path = package.zip().name();
    file.format = "3mf";
    file.units_mm = 1;
    file.rounding = text_rounding;
    file.warnings = package.zip().oddities();
    PackageReader(package, file, limits, execution).read();
    return file;
}

} // namespace lamella

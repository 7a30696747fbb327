// Slice stacks are in the root model or, by reference, in other model parts. Objects use stacks; components
// and build items place objects. Slices have the coordinates of their object.

#include "lamella/core/error.hpp"
#include "lamella/mesh/transform.hpp"

#include "container/read_limits.hpp"
#include "container/text_position.hpp"
#include "contour/plane_sums.hpp"
#include "core/executor.hpp"
#include "core/farthest.hpp"
#include "meshes/three_mf_part.hpp"
#include "meshes/three_mf_terms.hpp"
#include "slices/engine/layer_assembly.hpp"
#include "slices/engine/layer_readers.hpp"
#include "slices/formats/slice_model_3mf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
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

/// Returns the parts that items and components refer to, as written.
std::vector<std::string> used_parts(const SliceModel& model) {
    std::vector<std::string> parts;
    const auto add = [&](const std::vector<ThreeMfUse>& uses) {
        for (const ThreeMfUse& use : uses)
            if (!use.part.empty())
                parts.push_back(use.part);
    };
    add(model.items);
    for (const auto& [id, object] : model.objects)
        add(object.components);
    return parts;
}

/// Returns the number of bytes that the model parts of the package unpack to.
std::uint64_t bytes_of_models(const ZipReader& zip) {
    std::uint64_t bytes = 0;
    for (const ZipEntry& entry : zip.entries())
        if (entry.name.ends_with(".model"))
            bytes += entry.size;
    return bytes;
}

/// A stack with the placement by a build item.
struct Placed {
    std::string label;
    std::shared_ptr<const SliceStack> stack;
    Transform placement; ///< applies to millimetres
    double scale = 1;    ///< millimetres per unit of the stack
    double shift = 0;
    bool support = false;

    [[nodiscard]] double height(double z) const { return z * scale + shift; }
};

void check_reach(const Point3& p, const std::string& file) {
    if (is_too_far(p))
        throw Error(ErrorKind::input,
                    fmt::format("{}: the build puts slices further away than {} mm", file, farthest_mm));
}

/// Returns where the part has a point of a slice. Throws Error{input} if that is too far away.
Point2 placed_point(const Placed& part, double x, double y, const std::string& file) {
    const Point3 at = part.placement(Point3{x * part.scale, y * part.scale, 0});
    check_reach(at, file);
    return {at.x + 0.0, at.y + 0.0};
}

Layer placed_layer(const Placed& part, const RawLayer& raw, const std::string& file) {
    const auto& m = part.placement.linear;
    const bool mirrors = m[0][0] * m[1][1] - m[0][1] * m[1][0] < 0;
    LayerBuilder builder;
    std::size_t begin = 0;
    for (const RawLayer::Contour& contour : raw.ends) {
        for (std::size_t i = begin; i < contour.end; ++i) {
            // Mirroring reverses the direction of a ring.
            const Point2& p = raw.points[mirrors ? contour.end - 1 - (i - begin) : i];
            builder.add_point(placed_point(part, p.x, p.y, file));
        }
        builder.end_contour(contour.closed);
        begin = contour.end;
    }
    return builder.finish(0, 0, 0, 0);
}

/// The same for a slice that may have to be read again. What that takes is not counted in `limits`, because
/// it is freed with the layer, but must not exceed them.
Layer placed_layer(const Placed& part, const Slice& slice, const ReadLimits& limits,
                   const std::string& file) {
    ReadLimits own(limits);
    const RawLayer again = slice.text ? slice.read_again(own) : RawLayer();
    const RawLayer& raw = slice.text ? again : slice.raw;
    own.add_bytes(2 * contour_bytes(raw)); // growing arrays
    return placed_layer(part, raw, file);
}

/// The planes of one slice.
struct PlanesOfSlice {
    const Slice* slice;
    std::size_t begin;
    std::size_t end;
    Layer layer = {}; ///< if layers are kept in memory
};

/// The slices of a part that are on planes, ascending.
using DrawnSlices = std::vector<PlanesOfSlice>;

/// Returns the slice on a plane, or null.
const PlanesOfSlice* slice_on(const DrawnSlices& drawn, std::size_t plane) {
    const auto next =
        std::upper_bound(drawn.begin(), drawn.end(), plane,
                         [](std::size_t at, const PlanesOfSlice& slice) { return at < slice.begin; });
    return next == drawn.begin() || plane >= std::prev(next)->end ? nullptr : &*std::prev(next);
}

class PackageReader {
  public:
    PackageReader(const ZipReader& zip, LayerFile& file, ReadLimits& limits, const Execution& execution)
        : zip_(zip), root_(root_model(zip)), file_(file), limits_(limits), executor_(execution) {}

    void read() {
        if (zip_.find(root_) == nullptr)
            throw NoLayers(fmt::format("{}: found no part '{}'; a 3MF file of layers has its model there",
                                       zip_.name(), printable(root_, 100)));
        limits_.keep_text_in_memory(bytes_of_models(zip_));
        const Model& model = model_of(root_);
        // A package without slices may use features in its build that are not supported here.
        if (has_slices(model))
            for (const ThreeMfUse& item : model.second.items)
                place(model, item, {}, false, 0);
        if (placed_.empty())
            throw NoLayers(
                fmt::format("{}: found no slice stack in the build; a 3MF file of layers has one for each "
                            "object",
                            zip_.name()));
        append_to(found_, file_.warnings);
        make_layers();
    }

  private:
    using Model = std::pair<const std::string, SliceModel>; ///< with the name of the part

    SliceModel read_model(const std::string& part, const FindSliceStack& find) {
        SliceModel model =
            read_slice_model(unpack_part(zip_, part, limits_, &executor_), find, limits_, executor_);
        file_.warnings.insert(file_.warnings.end(), model.warnings.begin(), model.warnings.end());
        return model;
    }

    /// Returns a part whose objects are placed; reads it on first use.
    const Model& model_of(const std::string& part) {
        auto model = models_.find(part);
        if (model == models_.end())
            model = models_
                        .emplace(part, read_model(part,
                                                  [&](const ThreeMfElement& reference) {
                                                      return referred(reference, part);
                                                  }))
                        .first;
        return *model;
    }

    /// Returns whether the root, or a part whose objects it uses, has slice stacks. Such a part must declare
    /// the extension.
    bool has_slices(const Model& root) {
        if (!root.second.stacks.empty())
            return true;
        std::set<std::string> parts;
        for (const std::string& reference : used_parts(root.second))
            parts.insert(opc_resolved(zip_, root_, reference));
        return std::any_of(parts.begin(), parts.end(), [&](const std::string& part) {
            if (zip_.find(part) == nullptr)
                return false; // reading the meshes reports this
            return unpack_part(zip_, part, limits_, &executor_).text().find(three_mf::slices) !=
                   std::string_view::npos;
        });
    }

    /// Returns a stack in another part, which must not refer to a third part. Its lengths are in the unit of
    /// the part that refers to it, as other programs interpret it.
    std::shared_ptr<const SliceStack> referred(const ThreeMfElement& reference, const std::string& from) {
        const std::string part = opc_resolved(zip_, from, reference["slicepath"].text);
        const std::uint32_t id = reference["slicestackid"].index();
        auto model = parts_.find(part);
        if (model == parts_.end())
            model = parts_
                        .emplace(
                            part,
                            read_model(part,
                                       [](const ThreeMfElement& second) -> std::shared_ptr<const SliceStack> {
                                           second.fail("a reference to slices within slices that "
                                                       "are referred to",
                                                       "slices");
                                       }))
                        .first;
        const std::map<std::uint32_t, std::shared_ptr<const SliceStack>>& stacks = model->second.stacks;
        const auto found = stacks.find(id);
        if (found == stacks.end())
            reference.fail(fmt::format("a reference to slice stack {} of '{}'", id, printable(part, 100)),
                           "one that is there");
        return found->second;
    }

    void place(const Model& user, const ThreeMfUse& use, const Transform& outer, bool in_support, int depth) {
        constexpr int deepest = 32;
        constexpr std::size_t most = std::size_t{1} << 20;
        if (!use.part.empty() && user.first != root_)
            throw Error(ErrorKind::input,
                        fmt::format("{}, part '{}', line {}: found path '{}' in a part that is not the root, "
                                    "expected none: only the root may refer to other parts",
                                    zip_.name(), printable(user.first, 100), use.line,
                                    printable(use.part, 100)));
        const Model& model = use.part.empty() ? user : model_of(opc_resolved(zip_, root_, use.part));
        const auto object = model.second.objects.find(use.object);
        if (object == model.second.objects.end())
            throw Error(
                ErrorKind::input,
                fmt::format("{}, line {}: found no object {}{}", zip_.name(), use.line, use.object,
                            use.part.empty() ? "" : fmt::format(" in '{}'", printable(model.first, 100))));
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
            return found_.note(FindingKind::items_not_printed, at_line(use.line));
        if (is_other || type == ThreeMfObjectType::surface)
            return found_.note(FindingKind::no_solids, at_line(use.line));
        const Transform placement = compose(outer, use.placement);
        const bool support =
            in_support || type == ThreeMfObjectType::support || type == ThreeMfObjectType::solid_support;
        if (!object->second.stack) { // an object's own stack replaces those of its components
            if (object->second.components.empty())
                found_.note(FindingKind::objects_without_slices, at_line(use.line));
            for (const ThreeMfUse& component : object->second.components)
                place(model, component, placement, support, depth + 1);
            return;
        }
        limits_.make_room(placed_, 1, at_line(use.line));
        limits_.add_bytes_at(object->second.name.size(), at_line(use.line));
        placed_.push_back(in_millimetres(object->second, placement, model.second.unit_mm, use.line));
        placed_.back().support = support;
    }

    Placed in_millimetres(const SlicedObject& object, const Transform& placement, double unit,
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
            check_reach({0, 0, part.height(part.stack->bottom)}, zip_.name());
            heights.push_back(part.height(part.stack->bottom));
            for (const Slice& slice : part.stack->slices) {
                check_reach({0, 0, part.height(slice.top)}, zip_.name());
                heights.push_back(part.height(slice.top));
                points += slice.points();
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
            file_.parts.push_back({.label = labels.of(placed_[k].label), .support = placed_[k].support});
        }
        labels.append_to(file_.warnings);
        check_part_planes(file_, heights.size() - 1, std::max(points, zip_.unpacked()));
        add_planes(heights);
        std::uint64_t left = 64 * (points + heights.size() + (std::uint64_t{1} << 20));
        PlaneSums sums(placed_.size());
        std::vector<DrawnSlices> drawn;
        std::uint64_t largest = 0; // points of the largest slices of all parts
        for (std::size_t k = 0; k < placed_.size(); ++k) {
            DrawnSlices& slices = drawn.emplace_back(drawn_slices(k, heights, left));
            sums.add_contours(k, place(placed_[k], slices));
            std::uint64_t of_part = 0;
            for (const PlanesOfSlice& some : slices) {
                of_part = std::max<std::uint64_t>(of_part, some.slice->points());
                for (std::size_t i = some.begin; i < some.end; ++i)
                    file_.contents[i].points += some.slice->points();
            }
            largest += of_part;
        }
        sums.put(file_);
        if (limits_.in_memory()) {
            for (const DrawnSlices& slices : drawn)
                for (const PlanesOfSlice& slice : slices)
                    file_.bytes += sizeof slice + slice.layer.offsets.size() * sizeof(std::uint64_t) +
                                   slice.layer.points.size() * sizeof(Point2);
            file_.make = [drawn = std::move(drawn)](std::size_t plane) {
                Plane vectors;
                for (const DrawnSlices& slices : drawn) {
                    const PlanesOfSlice* const slice = slice_on(slices, plane);
                    vectors.add(slice == nullptr ? Layer() : slice->layer, PointArray());
                }
                return vectors;
            };
            return;
        }
        file_.bytes = limits_.bytes();
        file_.plane_bytes = bytes_of_plane(largest);
        file_.spare_bytes = limits_.bytes_left();
        file_.make = [drawn = std::move(drawn), placed = std::move(placed_), name = zip_.name(),
                      &limits = limits_](std::size_t plane) {
            Plane vectors;
            for (std::size_t k = 0; k < placed.size(); ++k) {
                const PlanesOfSlice* const slice = slice_on(drawn[k], plane);
                vectors.add(slice == nullptr ? Layer() : placed_layer(placed[k], *slice->slice, limits, name),
                            PointArray());
            }
            return vectors;
        };
    }

    /// Adds planes without contours.
    void add_planes(const std::vector<double>& heights) {
        const std::size_t planes = heights.size() - 1;
        limits_.add_bytes(planes * (sizeof(Layer) + of_empty_layer + sizeof(PlaneContent)));
        file_.contents.resize(planes);
        for (std::size_t i = 0; i < planes; ++i)
            file_.planes.push_back(
                {.index = i, .z = middle(heights, i), .bottom = heights[i], .top = heights[i + 1]});
    }

    /// Finds the slice on each plane of a part. `left` is the number of points that parts may still have.
    DrawnSlices drawn_slices(std::size_t index, const std::vector<double>& heights, std::uint64_t& left) {
        const Placed& part = placed_[index];
        const std::vector<Slice>& slices = part.stack->slices;
        DrawnSlices drawn;
        std::size_t next = 0;
        std::size_t last_slice = slices.size();
        limits_.make_room(drawn, heights.size() - 1, place_of(index));
        for (std::size_t i = 0; i + 1 < heights.size(); ++i) {
            const double z = middle(heights, i);
            while (next < slices.size() && part.height(slices[next].top) < z)
                ++next;
            if (next == slices.size() || !(z > part.height(part.stack->bottom)))
                continue;
            if (std::exchange(last_slice, next) == next) {
                drawn.back().end = i + 1;
                continue;
            }
            const Slice& slice = slices[next];
            drawn.push_back({&slice, i, i + 1, {}});
            if (slice.points() > left)
                throw Error(ErrorKind::input,
                            fmt::format("{}: found the same slices placed so often that they would have more "
                                        "than 64 times their points",
                                        zip_.name()));
            left -= slice.points();
            if (limits_.in_memory())
                limits_.add_bytes_at(2 * contour_bytes(slice.raw), place_of(index)); // growing arrays
        }
        return drawn;
    }

    static double middle(const std::vector<double>& heights, std::size_t plane) {
        return heights[plane] + (heights[plane + 1] - heights[plane]) / 2;
    }

    /// Makes the layers of the slices of a part if layers are kept in memory. Returns the box of their points
    /// at a height of 0.
    Box3 place(const Placed& part, DrawnSlices& slices) {
        const auto& m = part.placement.linear;
        // If each coordinate depends on only one of the slice, the extremes of points are those of boxes,
        // after any rounding.
        const bool by_boxes = (m[0][0] == 0 || m[0][1] == 0) && (m[1][0] == 0 || m[1][1] == 0);
        std::vector<Box3> boxes(executor_.workers());
        executor_.for_chunks(slices.size(), 1, [&](std::uint64_t i, std::uint64_t, unsigned worker) {
            const Slice& slice = *slices[i].slice;
            if (by_boxes && slice.text) {
                for (const RawLayer::Run& run : slice.raw.runs)
                    for (const Point3& corner : {run.box.min, run.box.max}) {
                        const Point2 p = placed_point(part, corner.x, corner.y, zip_.name());
                        boxes[worker].add(Point3{p.x, p.y, 0});
                    }
                return;
            }
            Layer layer = placed_layer(part, slice, limits_, zip_.name());
            boxes[worker].add(PlaneSums::flat_box(layer.points.span()));
            if (limits_.in_memory())
                slices[i].layer = std::move(layer);
        });
        executor_.check_cancelled();
        Box3 box;
        for (const Box3& some : boxes)
            box.add(some);
        return box;
    }

    const ZipReader& zip_;
    std::string root_;
    LayerFile& file_;
    ReadLimits& limits_;
    Executor executor_;
    std::map<std::string, SliceModel> models_; ///< parts with objects
    std::map<std::string, SliceModel> parts_;  ///< referenced parts
    std::vector<Placed> placed_;
    std::size_t uses_ = 0;
    Findings found_;
};

} // namespace

bool is_3mf(const ZipReader& zip) {
    return zip.find("_rels/.rels") != nullptr || zip.find(three_mf::usual_root) != nullptr;
}

LayerFile read_slices_3mf(const ZipReader& package, ReadLimits& limits, const Execution& execution) {
    LayerFile file = layer_file(package.name(), "3mf", 1);
    file.rounding = text_rounding;
    file.warnings = package.counted_warnings();
    PackageReader(package, file, limits, execution).read();
    return file;
}

} // namespace lamella

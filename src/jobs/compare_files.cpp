#include "lamella/jobs/compare_files.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/polygon/boolean.hpp"
#include "lamella/scan/strategy_fields.hpp"

#include "contour/distance.hpp"
#include "contour/same_height.hpp"
#include "core/executor.hpp"
#include "polygon/compared_planes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

namespace lamella {

namespace {

std::vector<std::string> hatched_labels(const LayerFile& file) {
    std::vector<std::string> labels;
    for (const PartInfo& part : file.parts)
        if (part.hatch_lines > 0)
            labels.push_back(part.label);
    std::sort(labels.begin(), labels.end());
    labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
    return labels;
}

/// Lists of indices of parts whose hatches are compared together: one list for each label, or one of all
/// parts.
using HatchedParts = std::vector<std::vector<std::size_t>>;

HatchedParts hatched_parts(const LayerFile& file, const std::vector<std::string>& labels, bool by_label) {
    HatchedParts result(by_label ? labels.size() : 1);
    for (std::size_t i = 0; i < file.parts.size(); ++i) {
        if (!by_label)
            result.front().push_back(i);
        else if (const auto found = std::lower_bound(labels.begin(), labels.end(), file.parts[i].label);
                 found != labels.end() && *found == file.parts[i].label)
            result[static_cast<std::size_t>(found - labels.begin())].push_back(i);
    }
    return result;
}

std::vector<Point2> ends_of(const std::vector<std::size_t>& parts, const Plane& vectors) {
    std::vector<Point2> ends;
    for (const std::size_t part : parts) {
        const std::span<const Point2> hatches = vectors.hatches[part].span();
        ends.insert(ends.end(), hatches.begin(), hatches.end());
    }
    return ends;
}

/// Largest distances by which a format may have moved points of contours, and ends of hatch lines.
struct MovedPoints {
    double contours = 0;
    double hatches = 0;
};

MovedPoints moved_points(const LayerFile& file) {
    return {moved_point(file.largest_coordinate, file.rounding),
            moved_point(file.largest_hatch_coordinate, file.rounding)};
}

void compare_ends(const std::vector<Point2>& first, const std::vector<Point2>& second,
                  PlaneDetails& details) {
    details.first_hatches += first.size() / 2;
    details.second_hatches += second.size() / 2;
    if (first.size() != second.size()) {
        details.hatch_distance_mm = std::numeric_limits<double>::infinity();
        return;
    }
    for (std::size_t i = 0; i < first.size(); ++i)
        if (const double apart = distance(first[i], second[i]); apart > details.hatch_distance_mm) {
            details.hatch_distance_mm = apart;
            details.hatch_where = first[i];
        }
}

bool is_same(double one, double other) noexcept {
    constexpr double of_single_precision = 1e-6;
    return std::abs(one - other) <= of_single_precision * std::max(std::abs(one), std::abs(other));
}

void compare_parameters(const PartInfo& first, const PartInfo& second, bool one_format,
                        std::vector<ParameterDifference>& differences) {
    for (const StrategyField<ParameterSet>& field : parameter_fields()) {
        const auto member = std::get<double ParameterSet::*>(field.member);
        const double one = first.exposure->parameters.*member;
        const double its = second.exposure->parameters.*member;
        if ((one_format || (one != 0 && its != 0)) && !is_same(one, its))
            differences.push_back({first.label, std::string(field.name), one, its});
    }
}

/// Returns the parts that have vectors. Some formats list no other parts.
std::vector<const PartInfo*> exposed_parts(const LayerFile& file) {
    std::vector<const PartInfo*> parts;
    for (const PartInfo& part : file.parts)
        if (part.exposure && !part.box.empty())
            parts.push_back(&part);
    return parts;
}

/// Removes the pairs of equal keys from both lists, each in its order, and calls visit(one, other).
template <class Key, class Visit>
void take_pairs(std::vector<const PartInfo*>& first, std::vector<const PartInfo*>& second, const Key& key,
                const Visit& visit) {
    std::map<decltype(key(*first.front())), std::deque<const PartInfo*>> others;
    for (const PartInfo* const part : second)
        others[key(*part)].push_back(part);
    std::set<const PartInfo*> taken;
    std::erase_if(first, [&](const PartInfo* part) {
        std::deque<const PartInfo*>& alike = others[key(*part)];
        if (alike.empty())
            return false;
        visit(*part, *alike.front());
        taken.insert(alike.front());
        alike.pop_front();
        return true;
    });
    std::erase_if(second, [&](const PartInfo* part) { return taken.count(part) != 0; });
}

/// Indices of parts in both files.
using PartPair = std::pair<std::size_t, std::size_t>;

/// Returns whether the partners of the parts of one file are in the order of the parts.
bool in_order(std::vector<PartPair> pairs) {
    std::sort(pairs.begin(), pairs.end());
    return std::is_sorted(pairs.begin(), pairs.end(),
                          [](const PartPair& a, const PartPair& b) { return a.second < b.second; });
}

/// Returns the pairs of exposures, or an empty list if an exposure has no partner.
std::vector<PartPair> compare_exposures(const LayerFile& first, const LayerFile& second,
                                        FileComparison& result) {
    const bool one_format = first.format == second.format;
    std::vector<const PartInfo*> ones = exposed_parts(first);
    std::vector<const PartInfo*> others = exposed_parts(second);
    std::vector<PartPair> pairs;
    const auto compare = [&](const PartInfo& one, const PartInfo& other) {
        compare_parameters(one, other, one_format, result.parameters);
        pairs.emplace_back(&one - first.parts.data(), &other - second.parts.data());
    };
    take_pairs(
        ones, others, [](const PartInfo& part) { return std::string_view(part.label); }, compare);
    take_pairs(
        ones, others,
        [](const PartInfo& part) {
            return std::tuple(part.exposure->region, part.exposure->kind, part.exposure->contour);
        },
        compare);
    if (one_format) { // some formats do not keep labels and regions
        for (const PartInfo* const part : ones)
            result.only_first.push_back(part->label);
        for (const PartInfo* const part : others)
            result.only_second.push_back(part->label);
    }
    if (one_format)
        result.exposures_in_order = in_order(pairs);
    if (!ones.empty() || !others.empty())
        pairs.clear();
    return pairs;
}

bool has_other_hatches(const LayerFile& file) {
    return std::any_of(file.parts.begin(), file.parts.end(),
                       [](const PartInfo& part) { return !part.exposure && part.hatch_lines > 0; });
}

StackPlanes planes_of(const LayerFile& file) {
    StackPlanes planes{file.planes, file.rounding, {}};
    for (const PlaneContent& content : file.contents)
        planes.drawn.push_back(content.points > 0 || content.hatch_lines > 0);
    return planes;
}

/// Returns whether the images of both files have the same pixels on displays of the same kind.
bool have_same_pixels(const LayerFile& first, const LayerFile& second) {
    if (!first.grid || !second.grid)
        return false;
    const PixelGrid& one = *first.grid;
    const PixelGrid& other = *second.grid;
    const auto alike = [](double a, double b) {
        return (a < 0) == (b < 0) && (a > 0) == (b > 0);
    };
    return one.width == other.width && one.height == other.height && alike(one.ux, other.ux) &&
           alike(one.uy, other.uy) && alike(one.vx, other.vx) && alike(one.vy, other.vy);
}

/// Returns the absolute differences of the pixels of two images.
std::shared_ptr<const RunImage> difference_of(const RunImage& one, const RunImage& other) {
    RunImage difference{one.width, one.height, {}};
    auto first = one.runs.begin();
    auto second = other.runs.begin();
    while (first != one.runs.end() && second != other.runs.end()) {
        const std::uint64_t end = std::min(first->end, second->end);
        const auto value = static_cast<std::uint8_t>(std::abs(int{first->value} - int{second->value}));
        if (difference.runs.empty() || difference.runs.back().value != value)
            difference.runs.push_back({end, value});
        difference.runs.back().end = end;
        first += first->end == end ? 1 : 0;
        second += second->end == end ? 1 : 0;
    }
    return std::make_shared<const RunImage>(std::move(difference));
}

/// Puts the difference of two images into the details of a plane.
void take_difference(const RunImage& difference, PlaneDetails& details) {
    std::uint64_t from = 0;
    std::uint64_t pixels = 0;
    for (const ImageRun& run : difference.runs) {
        pixels += run.value == 0 ? 0 : run.end - from;
        details.largest_pixel_difference = std::max<unsigned>(details.largest_pixel_difference, run.value);
        from = run.end;
    }
    details.other_pixels = pixels;
}

/// Compares the exposures of layers and the movements of the plate.
void compare_jobs(const LayerFile& first, const LayerFile& second,
                  std::vector<ParameterDifference>& differences) {
    if (!first.resin || !second.resin)
        return;
    const std::vector<double>& ones = first.resin->exposures_s;
    const std::vector<double>& others = second.resin->exposures_s;
    constexpr double same_s = 1e-3; // some formats have milliseconds
    for (std::size_t i = 0; i < std::min(ones.size(), others.size()); ++i)
        if (std::abs(ones[i] - others[i]) > same_s)
            differences.push_back({fmt::format("layer {}", i), "exposure_s", ones[i], others[i]});
    if (first.format != second.format)
        return;
    const auto compare_travels = [&](const std::string& label, const PlateTravel& one,
                                     const PlateTravel& its) {
        for (const auto& [name, member] : {std::pair("lift_mm", &PlateTravel::lift_mm),
                                           {"lift_mm_min", &PlateTravel::lift_mm_min},
                                           {"lift2_mm", &PlateTravel::lift2_mm},
                                           {"retract_mm_min", &PlateTravel::retract_mm_min},
                                           {"retract2_mm", &PlateTravel::retract2_mm},
                                           {"wait_before_lift_s", &PlateTravel::wait_before_lift_s},
                                           {"wait_after_lift_s", &PlateTravel::wait_after_lift_s},
                                           {"wait_after_retract_s", &PlateTravel::wait_after_retract_s}})
            if (!is_same(one.*member, its.*member))
                differences.push_back({label, name, one.*member, its.*member});
    };
    compare_travels("bottom layers", first.resin->settings.bottom_travel,
                    second.resin->settings.bottom_travel);
    compare_travels("other layers", first.resin->settings.travel, second.resin->settings.travel);
}

/// Returns a source of pairs of planes: each of its planes has the parts of the first file, then those of the
/// second. On planes that a file lacks, its parts are empty. If both files have images with the same pixels,
/// the image of a pair is the difference of its images.
PlaneSource pairs_of(const LayerFile& first, const LayerFile& second, std::span<const ComparedPlane> pairs) {
    PlaneSource both;
    for (const ComparedPlane& pair : pairs)
        both.planes.push_back(pair.first ? first.planes[*pair.first] : second.planes[*pair.second]);
    both.parts = first.parts;
    both.parts.insert(both.parts.end(), second.parts.begin(), second.parts.end());
    const bool pixels = have_same_pixels(first, second);
    if (pixels)
        both.grid = first.grid;
    both.plane_bytes = first.plane_bytes + second.plane_bytes;
    both.spare_bytes = std::min(first.spare_bytes, second.spare_bytes);
    both.make = [&first, &second, pairs, pixels](std::size_t i) {
        const auto plane_of = [](const LayerFile& file, std::optional<std::size_t> position) {
            return position ? file.make(*position) : Plane(std::vector<Layer>(file.parts.size()));
        };
        Plane plane = plane_of(first, pairs[i].first);
        const std::shared_ptr<const RunImage> image = plane.image;
        Plane other = plane_of(second, pairs[i].second);
        const std::shared_ptr<const RunImage> other_image = other.image;
        plane.append(std::move(other));
        if (pixels && image && other_image)
            plane.image = difference_of(*image, *other_image);
        return plane;
    };
    return both;
}

/// Compares pairs of planes (see pairs_of).
class PairComparer {
  public:
    PairComparer(const LayerFile& first, const LayerFile& second, std::vector<PartPair> exposures,
                 const MovedPoints& tolerance, bool area_difference, const LayerLimits& limits)
        : first_(first), second_(second), exposures_(std::move(exposures)), tolerance_(tolerance),
          area_difference_(area_difference), limits_(limits) {
        const std::vector<std::string> labels = hatched_labels(first);
        const bool by_label = labels == hatched_labels(second);
        if (!exposures_.empty() && !has_other_hatches(first) && !has_other_hatches(second)) {
            for (const auto& [one, other] : exposures_) {
                ones_.push_back({one});
                others_.push_back({other});
            }
        } else {
            ones_ = hatched_parts(first, labels, by_label);
            others_ = hatched_parts(second, labels, by_label);
        }
        // The parts of the second file come after those of the first one.
        for (PartPair& pair : exposures_)
            pair.second += first.parts.size();
        for (std::vector<std::size_t>& parts : others_)
            for (std::size_t& part : parts)
                part += first.parts.size();
    }

    /// Fills in the comparison of a plane; `in_order` is FileComparison::exposures_in_order.
    void compare(const Plane& both, bool in_order, ComparedPlane& plane, PlaneDetails& details) const {
        const std::span<const Layer> lines(both.polylines);
        const Layer one = united(lines.first(first_.parts.size()));
        const Layer other = united(lines.subspan(first_.parts.size()));
        if (both.image)
            take_difference(*both.image, details);
        // Equal pixels may have outlines elsewhere: some formats do not say where the part was.
        const bool same_pixels = details.other_pixels && *details.other_pixels == 0;
        compare_layers(plane, one, same_pixels ? one : other, tolerance_.contours);
        if (details.other_pixels && !same_pixels)
            plane.agree = plane.difference.same = false;
        if (area_difference_ && !plane.difference.same)
            details.area_difference_mm2 =
                measure(combine(one, other, BooleanOperation::exclude, limits_)).area_mm2;
        if (plane.first && plane.second) {
            compare_vectors(both, in_order, plane, details);
        } else {
            details.first_hatches = plane.first ? first_.contents[*plane.first].hatch_lines : 0;
            details.second_hatches = plane.second ? second_.contents[*plane.second].hatch_lines : 0;
        }
    }

  private:
    /// Returns all contours of a file on a plane.
    static Layer united(std::span<const Layer> parts) {
        return parts.size() == 1 ? parts.front() : merged(parts);
    }

    void compare_vectors(const Plane& both, bool in_order, ComparedPlane& plane,
                         PlaneDetails& details) const {
        // Differences of all contours together are reported anyway.
        if (plane.agree) {
            details.exposed_alike = exposed_alike(both);
            details.followed_alike = !details.exposed_alike || followed_alike(both);
        }
        for (std::size_t i = 0; i < ones_.size(); ++i)
            compare_ends(ends_of(ones_[i], both), ends_of(others_[i], both), details);
        const Layer& one = first_.planes[*plane.first];
        const Layer& other = second_.planes[*plane.second];
        details.height_distance_mm =
            std::max(std::abs(one.bottom - other.bottom), std::abs(one.top - other.top));
        details.heights_agree = details.height_distance_mm <= moved_cut(one, first_.rounding) +
                                                                  moved_cut(other, second_.rounding) +
                                                                  same_height_mm;
        plane.agree = plane.agree && details.heights_agree &&
                      details.hatch_distance_mm <= tolerance_.hatches && details.exposed_alike &&
                      details.followed_alike;
        details.same = plane.difference.same && details.height_distance_mm == 0 &&
                       details.hatch_distance_mm == 0 && details.exposed_alike && details.followed_alike &&
                       in_order;
    }

    /// Returns whether each exposure has the contours of its partner.
    [[nodiscard]] bool exposed_alike(const Plane& both) const {
        return std::all_of(exposures_.begin(), exposures_.end(), [&](const PartPair& pair) {
            return lamella::compare(both.polylines[pair.first], both.polylines[pair.second])
                .within(tolerance_.contours);
        });
    }

    /// Returns whether the contours of each exposure have the order and the start points of its partner.
    /// Requires that the contours agree.
    [[nodiscard]] bool followed_alike(const Plane& both) const {
        return std::all_of(exposures_.begin(), exposures_.end(), [&](const PartPair& pair) {
            const Layer& one = both.polylines[pair.first];
            const Layer& other = both.polylines[pair.second];
            if (one.contours() != other.contours())
                return true; // some contours are too small to be matched
            for (std::size_t i = 0; i < one.contours(); ++i)
                if (!one.contour(i).empty() && !other.contour(i).empty() &&
                    distance(one.contour(i).front(), other.contour(i).front()) > tolerance_.contours)
                    return false;
            return true;
        });
    }

    const LayerFile& first_;
    const LayerFile& second_;
    std::vector<PartPair> exposures_;
    HatchedParts ones_;
    HatchedParts others_;
    MovedPoints tolerance_;
    bool area_difference_;
    LayerLimits limits_;
};

MovedPoints tolerance_of(const LayerFile& first, const LayerFile& second, std::optional<double> given_mm) {
    if (given_mm)
        return {*given_mm, *given_mm};
    const MovedPoints one = moved_points(first);
    const MovedPoints other = moved_points(second);
    return {one.contours + other.contours, one.hatches + other.hatches};
}

} // namespace

bool FileComparison::agree() const noexcept {
    return parameters.empty() && only_first.empty() && only_second.empty() && exposures_in_order &&
           std::all_of(layers.planes.begin(), layers.planes.end(),
                       [](const ComparedPlane& plane) { return plane.agree; });
}

FileComparison compare_files(const LayerFile& first, const LayerFile& second,
                             const FileComparisonOptions& options, const Execution& execution) {
    check_tolerance(options.tolerance_mm);
    FileComparison result{.layers = {}, .details = {}, .parameters = {}, .only_first = {}, .only_second = {}};
    std::vector<PartPair> exposures = compare_exposures(first, second, result);
    compare_jobs(first, second, result.parameters);
    const MovedPoints tolerance = tolerance_of(first, second, options.tolerance_mm);
    const StackPlanes planes[2] = {planes_of(first), planes_of(second)};
    result.layers.tolerance_mm = std::max(tolerance.contours, tolerance.hatches);
    result.layers.planes = paired(planes[0], planes[1], options.tolerance_mm);
    result.layers.cut_apart = are_cut_apart(planes[0], planes[1], result.layers.planes);
    result.details.resize(result.layers.planes.size());

    const PlaneSource pairs = pairs_of(first, second, result.layers.planes);
    const unsigned threads = thread_count(pairs.for_planes(execution));
    const PairComparer comparer(first, second, std::move(exposures), tolerance, options.area_difference,
                                layer_limits(execution, options.max_memory, threads));
    const PlaneVisitor compare_pair = [&](std::size_t i, const Plane& both, unsigned) {
        comparer.compare(both, result.exposures_in_order, result.layers.planes[i], result.details[i]);
    };
    pairs.visit(Stage::polygon, compare_pair, execution);
    return result;
}

} // namespace lamella

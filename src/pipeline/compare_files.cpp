#include "lamella/pipeline/compare_files.hpp"

#include "lamella/scan/strategy_fields.hpp"

#include "contour/distance.hpp"
#include "contour/same_height.hpp"
#include "core/executor.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

namespace lamella {

namespace {

std::vector<std::string> hatched_labels(const LayerFile& file) {
    std::vector<std::string> labels;
    for (const LayerPart& part : file.parts)
        if (part.hatch_lines() > 0)
            labels.push_back(part.label);
    std::sort(labels.begin(), labels.end());
    labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
    return labels;
}

/// Lists of parts whose hatches are compared together: one list for each label, or one of all parts.
using HatchedParts = std::vector<std::vector<const LayerPart*>>;

HatchedParts hatched_parts(const LayerFile& file, const std::vector<std::string>& labels, bool by_label) {
    HatchedParts result(by_label ? labels.size() : 1);
    for (const LayerPart& part : file.parts) {
        if (!by_label)
            result.front().push_back(&part);
        else if (const auto found = std::lower_bound(labels.begin(), labels.end(), part.label);
                 found != labels.end() && *found == part.label)
            result[static_cast<std::size_t>(found - labels.begin())].push_back(&part);
    }
    return result;
}

std::vector<Point2> ends_of(const std::vector<const LayerPart*>& parts, std::size_t plane) {
    std::vector<Point2> ends;
    for (const LayerPart* const part : parts) {
        const std::span<const Point2> hatches = part->hatches_of(plane);
        ends.insert(ends.end(), hatches.begin(), hatches.end());
    }
    return ends;
}

/// Returns the largest distance by which a format may have moved the ends of lines.
double moved_ends(const LayerFile& file, Executor& executor) {
    std::vector<double> most(executor.workers());
    for (const LayerPart& part : file.parts)
        executor.for_chunks(part.hatches.size(), 1, [&](std::uint64_t i, std::uint64_t, unsigned worker) {
            most[worker] = std::max(most[worker], moved_point(part.hatches[i].span(), file.rounding));
        });
    return *std::max_element(most.begin(), most.end());
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

void compare_parameters(const LayerPart& first, const LayerPart& second, bool one_format,
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
std::vector<const LayerPart*> exposed_parts(const LayerFile& file) {
    std::vector<const LayerPart*> parts;
    for (const LayerPart& part : file.parts)
        if (part.exposure &&
            (part.hatch_lines() > 0 || std::any_of(part.layers.begin(), part.layers.end(),
                                                   [](const Layer& layer) { return layer.contours() > 0; })))
            parts.push_back(&part);
    return parts;
}

/// Removes the pairs of equal keys from both lists, each in its order, and calls visit(one, other).
template <class Key, class Visit>
void take_pairs(std::vector<const LayerPart*>& first, std::vector<const LayerPart*>& second, const Key& key,
                const Visit& visit) {
    std::map<decltype(key(*first.front())), std::deque<const LayerPart*>> others;
    for (const LayerPart* const part : second)
        others[key(*part)].push_back(part);
    std::set<const LayerPart*> taken;
    std::erase_if(first, [&](const LayerPart* part) {
        std::deque<const LayerPart*>& alike = others[key(*part)];
        if (alike.empty())
            return false;
        visit(*part, *alike.front());
        taken.insert(alike.front());
        alike.pop_front();
        return true;
    });
    std::erase_if(second, [&](const LayerPart* part) { return taken.count(part) != 0; });
}

using PartPair = std::pair<const LayerPart*, const LayerPart*>;

/// Returns whether the partners of the parts of one file are in the order of the parts.
bool in_order(std::vector<PartPair> pairs) {
    std::sort(pairs.begin(), pairs.end()); // the parts of a file are in one array
    return std::is_sorted(pairs.begin(), pairs.end(),
                          [](const PartPair& a, const PartPair& b) { return a.second < b.second; });
}

/// Returns the pairs of exposures, or an empty list if an exposure has no partner.
std::vector<PartPair> compare_exposures(const LayerFile& first, const LayerFile& second,
                                        FileComparison& result) {
    const bool one_format = first.format == second.format;
    std::vector<const LayerPart*> ones = exposed_parts(first);
    std::vector<const LayerPart*> others = exposed_parts(second);
    std::vector<PartPair> pairs;
    const auto compare = [&](const LayerPart& one, const LayerPart& other) {
        compare_parameters(one, other, one_format, result.parameters);
        pairs.emplace_back(&one, &other);
    };
    take_pairs(
        ones, others, [](const LayerPart& part) { return std::string_view(part.label); }, compare);
    take_pairs(
        ones, others,
        [](const LayerPart& part) {
            return std::tuple(part.exposure->region, part.exposure->kind, part.exposure->contour);
        },
        compare);
    if (one_format) { // some formats do not keep labels and regions
        for (const LayerPart* const part : ones)
            result.only_first.push_back(part->label);
        for (const LayerPart* const part : others)
            result.only_second.push_back(part->label);
    }
    if (one_format)
        result.exposures_in_order = in_order(pairs);
    if (!ones.empty() || !others.empty())
        pairs.clear();
    return pairs;
}

/// Returns the number of hatch lines of all parts on each plane; empty if there are none.
std::vector<std::uint64_t> hatch_lines_of(const LayerFile& file) {
    std::vector<std::uint64_t> lines;
    for (const LayerPart& part : file.parts) {
        lines.resize(std::max(lines.size(), part.hatches.size()));
        for (std::size_t plane = 0; plane < part.hatches.size(); ++plane)
            lines[plane] += part.hatches[plane].size() / 2;
    }
    return lines;
}

bool has_other_hatches(const LayerFile& file) {
    return std::any_of(file.parts.begin(), file.parts.end(),
                       [](const LayerPart& part) { return !part.exposure && part.hatch_lines() > 0; });
}

/// Returns whether each exposure of a plane has the contours of its partner.
bool exposed_alike(std::span<const PartPair> pairs, std::size_t first, std::size_t second,
                   double tolerance_mm) {
    return std::all_of(pairs.begin(), pairs.end(), [&](const PartPair& pair) {
        return compare(pair.first->layers[first], pair.second->layers[second]).within(tolerance_mm);
    });
}

/// Returns whether the contours of each exposure of a plane have the order and the start points of its
/// partner. Requires that the contours agree.
bool followed_alike(std::span<const PartPair> pairs, std::size_t first, std::size_t second,
                    double tolerance_mm) {
    return std::all_of(pairs.begin(), pairs.end(), [&](const PartPair& pair) {
        const Layer& one = pair.first->layers[first];
        const Layer& other = pair.second->layers[second];
        if (one.contours() != other.contours())
            return true; // some contours are too small to be matched
        for (std::size_t i = 0; i < one.contours(); ++i)
            if (!one.contour(i).empty() && !other.contour(i).empty() &&
                distance(one.contour(i).front(), other.contour(i).front()) > tolerance_mm)
                return false;
        return true;
    });
}

} // namespace

bool FileComparison::agree() const noexcept {
    return parameters.empty() && only_first.empty() && only_second.empty() && exposures_in_order &&
           std::all_of(layers.planes.begin(), layers.planes.end(),
                       [](const ComparedPlane& plane) { return plane.agree; });
}

FileComparison compare_files(const LayerFile& first, const LayerFile& second,
                             std::optional<double> tolerance_mm, const Execution& execution) {
    const LayerStack stacks[2] = {first.merged(execution), second.merged(execution)};
    const std::vector<std::uint64_t> lines[2] = {hatch_lines_of(first), hatch_lines_of(second)};
    FileComparison result{.layers = compare(RoundedLayers{stacks[0], first.rounding, lines[0]},
                                            {stacks[1], second.rounding, lines[1]}, tolerance_mm, execution),
                          .details = {},
                          .parameters = {},
                          .only_first = {},
                          .only_second = {},
                          .exposures_in_order = true};
    const std::vector<PartPair> pairs = compare_exposures(first, second, result);
    const double of_contours = result.layers.tolerance_mm;
    Executor executor(execution);
    const double of_ends =
        tolerance_mm ? *tolerance_mm : moved_ends(first, executor) + moved_ends(second, executor);
    result.layers.tolerance_mm = std::max(result.layers.tolerance_mm, of_ends);
    const std::vector<std::string> labels = hatched_labels(first);
    const bool by_label = labels == hatched_labels(second);
    HatchedParts ones = hatched_parts(first, labels, by_label);
    HatchedParts others = hatched_parts(second, labels, by_label);
    if (!pairs.empty() && !has_other_hatches(first) && !has_other_hatches(second)) {
        ones.clear();
        others.clear();
        for (const auto& [one, other] : pairs) {
            ones.push_back({one});
            others.push_back({other});
        }
    }
    // Differences of all contours together are reported anyway.
    std::vector<char> alike(result.layers.planes.size(), 1);
    std::vector<char> followed(result.layers.planes.size(), 1);
    executor.for_chunks(alike.size(), 1, [&](std::uint64_t begin, std::uint64_t end, unsigned) {
        for (std::uint64_t i = begin; i < end; ++i)
            if (const ComparedPlane& plane = result.layers.planes[i];
                plane.first && plane.second && plane.agree) {
                alike[i] = exposed_alike(pairs, *plane.first, *plane.second, of_contours) ? 1 : 0;
                followed[i] =
                    alike[i] == 0 || followed_alike(pairs, *plane.first, *plane.second, of_contours) ? 1 : 0;
            }
    });
    executor.check_cancelled();
    result.details.resize(result.layers.planes.size());
    executor.for_chunks(result.details.size(), 1, [&](std::uint64_t k, std::uint64_t, unsigned) {
        ComparedPlane& plane = result.layers.planes[k];
        PlaneDetails& details = result.details[k];
        if (plane.first && plane.second) {
            for (std::size_t i = 0; i < ones.size(); ++i)
                compare_ends(ends_of(ones[i], *plane.first), ends_of(others[i], *plane.second), details);
            const Layer& one = stacks[0][*plane.first];
            const Layer& other = stacks[1][*plane.second];
            details.height_distance_mm =
                std::max(std::abs(one.bottom - other.bottom), std::abs(one.top - other.top));
            details.heights_agree = details.height_distance_mm <= moved_cut(one, first.rounding) +
                                                                      moved_cut(other, second.rounding) +
                                                                      same_height_mm;
            plane.agree = plane.agree && details.heights_agree && details.hatch_distance_mm <= of_ends;
            details.exposed_alike = alike[k] != 0;
            details.followed_alike = followed[k] != 0;
            plane.agree = plane.agree && details.exposed_alike && details.followed_alike;
            details.same = plane.difference.same && details.height_distance_mm == 0 &&
                           details.hatch_distance_mm == 0 && details.exposed_alike &&
                           details.followed_alike && result.exposures_in_order;
        } else {
            details.first_hatches = plane.first && !lines[0].empty() ? lines[0][*plane.first] : 0;
            details.second_hatches = plane.second && !lines[1].empty() ? lines[1][*plane.second] : 0;
        }
    });
    executor.check_cancelled();
    return result;
}

} // namespace lamella

#include "lamella/pipeline/verify.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/polygon/crossings.hpp"
#include "lamella/polygon/nesting.hpp"

#include "core/executor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace lamella {

namespace {

/// How often something occurs in a layer, and where first.
struct Occurrences {
    std::uint64_t count = 0;
    Point2 first;

    void add(std::uint64_t n, const Point2& at) {
        if (count == 0)
            first = at;
        count += n;
    }
};

struct LayerCheck {
    LayerMeasure measure;
    Occurrences open_chains;
    OpenGaps open_gaps;
    Occurrences crossings;
    Occurrences misoriented;
    Occurrences overlapping;
};

double largest_coordinate(std::span<const Point2> points) {
    double largest = 0;
    for (const Point2& p : points)
        largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
    return largest;
}

/// Whether a ring is so thin that rounding its points may have turned it over.
bool orientation_is_lost(std::span<const Point2> ring, const Rounding& rounding) {
    const double largest = largest_coordinate(ring);
    const double moved =
        std::sqrt(0.5) * rounding.step_at(largest) + 4 * std::numeric_limits<double>::epsilon() * largest;
    return std::abs(ring_area(ring)) <= contour_length(ring, true) * moved;
}

LayerCheck check(const Layer& layer, const Rounding& rounding) {
    LayerCheck result;
    result.measure = measure(layer);
    for (std::size_t i = layer.rings; i < layer.contours(); ++i)
        if (!layer.contour(i).empty())
            result.open_chains.add(1, layer.contour(i).front());
    result.open_gaps = open_gaps(layer);
    const Crossings crossings = find_crossings(layer, 1);
    if (crossings.count > 0)
        result.crossings.add(crossings.count, crossings.first.front().at);
    const std::vector<RingKind> kinds = nesting(layer).kind;
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        if (kinds[i] != RingKind::misoriented && kinds[i] != RingKind::overlapping)
            continue;
        if (!orientation_is_lost(layer.contour(i), rounding))
            (kinds[i] == RingKind::misoriented ? result.misoriented : result.overlapping)
                .add(1, layer.contour(i).front());
    }
    return result;
}

std::string where(const Layer& layer) {
    return fmt::format("layer {} (z {:.7g} mm)", layer.index, layer.z);
}

/// The total over all layers of one kind of finding; text(total, first place) makes a line of it.
template <class Text>
std::uint64_t summed(std::span<const Layer> layers, std::span<const LayerCheck> checks,
                     Occurrences LayerCheck::*kind, const Text& text, std::vector<std::string>& findings) {
    std::uint64_t total = 0;
    std::string place;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const Occurrences& found = checks[i].*kind;
        if (total == 0 && found.count > 0)
            place = fmt::format("{} at ({:.7g}, {:.7g})", where(layers[i]), found.first.x, found.first.y);
        total += found.count;
    }
    if (total > 0)
        findings.push_back(text(total, place));
    return total;
}

const char* plural(std::uint64_t n) {
    return n == 1 ? "" : "s";
}

std::string gaps_text(std::span<const Verification::OpenLayer> layers) {
    OpenGaps all;
    const Verification::OpenLayer* worst = &layers.front();
    for (const Verification::OpenLayer& layer : layers) {
        all += layer.gaps;
        if (layer.gaps.longest_mm > worst->gaps.longest_mm)
            worst = &layer;
    }
    return fmt::format(
        "{:.4g} mm are missing between their ends, in {} layer{}; the longest gap, of {:.4g} mm, is in "
        "layer {} (z {:.7g} mm) from ({:.7g}, {:.7g}) to ({:.7g}, {:.7g})",
        all.total_mm, layers.size(), plural(layers.size()), worst->gaps.longest_mm, worst->index, worst->z,
        worst->gaps.from.x, worst->gaps.from.y, worst->gaps.to.x, worst->gaps.to.y);
}

/// The areas that the section of a mesh has where the format may have moved the cut of a layer from.
struct SectionArea {
    double nominal = 0;
    double least = 0;
    double greatest = 0;
};

std::vector<SectionArea> areas_of_sections(std::span<const Layer> layers, const VerifyOptions& options,
                                           const Execution& execution) {
    std::map<double, double> moved_by; // z to how far it may have been moved
    for (const Layer& layer : layers) {
        double& most = moved_by[layer.z];
        most = std::max(most, moved_cut(layer, options.rounding));
    }
    const std::vector<std::pair<double, double>> z(moved_by.begin(), moved_by.end());

    const auto areas_at = [&](double direction) {
        Plan plan;
        plan.rule = options.rule;
        std::vector<std::size_t> plane_of(z.size());
        for (std::size_t i = 0; i < z.size(); ++i) {
            const double shifted = z[i].first + direction * z[i].second; // may round to the one before
            if (plan.layers.empty() || shifted > plan.layers.back().z)
                plan.layers.push_back({plan.layers.size(), shifted, shifted, shifted});
            plane_of[i] = plan.layers.size() - 1;
        }
        const std::vector<double> of_planes = section_areas(*options.mesh, plan, execution);
        std::vector<double> result;
        for (const std::size_t plane : plane_of)
            result.push_back(of_planes[plane]);
        return result;
    };
    std::vector<SectionArea> areas(z.size());
    const std::vector<double> nominal = areas_at(0);
    for (std::size_t i = 0; i < z.size(); ++i)
        areas[i] = {nominal[i], nominal[i], nominal[i]};
    if (options.rounding != Rounding{})
        for (const double direction : {-1.0, 1.0}) {
            const std::vector<double> shifted = areas_at(direction);
            for (std::size_t i = 0; i < z.size(); ++i) {
                areas[i].least = std::min(areas[i].least, shifted[i]);
                areas[i].greatest = std::max(areas[i].greatest, shifted[i]);
            }
        }

    std::vector<SectionArea> result;
    for (const Layer& layer : layers)
        result.push_back(areas[static_cast<std::size_t>(
            std::lower_bound(z.begin(), z.end(), layer.z,
                             [](const auto& at, double value) { return at.first < value; }) -
            z.begin())]);
    return result;
}

/// How far the area of a layer may be off from that of the mesh's section, when each of its points is off by
/// up to half a step of the format in x and y. `extent` is the mesh's.
double area_tolerance(const Layer& layer, const LayerMeasure& measure, const Rounding& rounding,
                      double extent) {
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    const double largest = largest_coordinate(layer.points.span());
    const double quantum = rounding.step_at(largest) / 2;
    const auto points = static_cast<double>(measure.points);
    // Rings smaller than a unit may have vanished: hence the perimeter of a few units more.
    const double moved_points =
        (measure.perimeter_mm + 8 * quantum) * (std::sqrt(2.0) * quantum + 16 * epsilon * largest) +
        2 * points * quantum * quantum;
    // Both areas are sums of products of coordinates, as many as there are points, which cancel all but the
    // area. Errors of sums grow with the root of the number of terms.
    return moved_points + epsilon * extent * extent * (16 + 4 * std::sqrt(points));
}

void compare_areas(std::span<const Layer> layers, std::span<const LayerCheck> checks,
                   const VerifyOptions& options, const Execution& execution, Verification& result) {
    const std::vector<SectionArea> sections = areas_of_sections(layers, options, execution);
    const Box3 box = bounding_box(*options.mesh, execution);
    const double extent = box.empty() ? 0 : std::max(box.max.x - box.min.x, box.max.y - box.min.y);
    double largest_error = 0;
    std::uint64_t differing = 0;
    std::size_t first = 0;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        if (checks[i].open_chains.count > 0)
            continue; // its area is not known
        const double area = checks[i].measure.area_mm2;
        const SectionArea& section = sections[i];
        largest_error = std::max(largest_error, std::abs(area - section.nominal));
        const double beyond = std::max(section.least - area, area - section.greatest);
        if (beyond > area_tolerance(layers[i], checks[i].measure, options.rounding, extent)) {
            if (differing == 0)
                first = i;
            ++differing;
        }
    }
    result.max_area_error_mm2 = largest_error;
    if (differing > 0) {
        result.areas_agree = false;
        result.findings.push_back(fmt::format("{} layer{} of another area than the mesh's section, the first "
                                              "is {}: {:.7g} mm^2 instead of {:.7g} mm^2",
                                              differing, differing == 1 ? " is" : "s are",
                                              where(layers[first]), checks[first].measure.area_mm2,
                                              sections[first].nominal));
    }
}

} // namespace

Verification verify(std::span<const Layer> layers, const VerifyOptions& options, const Execution& execution) {
    std::vector<LayerCheck> checks(layers.size());
    Executor executor(execution);
    ProgressMeter progress(execution, Stage::polygon, layers.size());
    executor.for_chunks(layers.size(), 1, [&](std::uint64_t begin, std::uint64_t end, unsigned) {
        for (std::uint64_t i = begin; i < end; ++i) {
            checks[i] = check(layers[i], options.rounding);
            progress.add(1);
        }
    });
    progress.finish();

    Verification result;
    result.layers = layers.size();
    for (std::size_t i = 0; i < layers.size(); ++i) {
        result.contours += checks[i].measure.contours;
        result.points += checks[i].measure.points;
        result.volume_mm3 += checks[i].measure.area_mm2 * layers[i].thickness();
        if (checks[i].open_gaps.count > 0)
            result.open_layers.push_back({layers[i].index, layers[i].z, checks[i].open_gaps});
    }
    const auto total = [&](Occurrences LayerCheck::*kind, const auto& text) {
        return summed(layers, checks, kind, text, result.findings);
    };
    result.open_chains = total(&LayerCheck::open_chains, [](std::uint64_t n, const std::string& place) {
        return fmt::format("{} contour{} not closed, the first in {}", n, n == 1 ? " is" : "s are", place);
    });
    if (!result.open_layers.empty())
        result.findings.push_back(gaps_text(result.open_layers));
    result.crossings = total(&LayerCheck::crossings, [](std::uint64_t n, const std::string& place) {
        return fmt::format("{} crossing{} of contours, the first in {}", n, plural(n), place);
    });
    result.misoriented = total(&LayerCheck::misoriented, [](std::uint64_t n, const std::string& place) {
        return fmt::format("{} ring{} the wrong way round, the first in {}", n, n == 1 ? " runs" : "s run",
                           place);
    });
    result.overlapping = total(&LayerCheck::overlapping, [](std::uint64_t n, const std::string& place) {
        return fmt::format("{} ring{} within material: bodies that overlap, or holes that run the wrong way "
                           "round; the first in {}",
                           n, n == 1 ? " lies" : "s lie", place);
    });
    if (options.mesh)
        compare_areas(layers, checks, options, execution, result);
    return result;
}

} // namespace lamella

#include "lamella/jobs/verify.hpp"
#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/inverted_rings.hpp"
#include "lamella/polygon/offset.hpp"

#include "contour/distance.hpp"
#include "core/executor.hpp"
#include "jobs/exposure_groups.hpp"
#include "jobs/layer_check.hpp"
#include "jobs/layer_heights.hpp"
#include "jobs/moved_cuts.hpp"
#include "jobs/vector_reach.hpp"
#include "polygon/edge_tree.hpp"
#include "scan/hatch.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

namespace lamella {

namespace {

/// Figures and findings of a plane.
struct CheckedPlane {
    std::uint64_t contour_vectors = 0;
    std::uint64_t hatch_vectors = 0;
    Findings found;
};

class VectorCheck {
  public:
    /// `rounding` is the tolerance of ends.
    VectorCheck(const VerifyOptions& options, double rounding, const LayerLimits& limits)
        : options_(options), rounding_(rounding), tolerance_(rounding + options.steps.simplify_mm),
          limits_(limits) {}

    void check(const PlaneGroup& group, const MaterialBounds& bounds, CheckedPlane& checked) const {
        Findings& found = checked.found;
        std::uint64_t all = 0;
        for (const PlaneExposure& part : group) {
            const Layer& vectors = part.polylines;
            if (part.exposure.kind == VectorKind::contour)
                check_exposure(part.exposure, vectors, found);
            std::uint64_t of_contours = 0;
            for (std::size_t i = 0; i < vectors.contours(); ++i)
                of_contours += vectors.contour(i).size() - (vectors.closed(i) ? 0 : 1);
            checked.contour_vectors += of_contours;
            const std::span<const Point2> hatches = part.hatches;
            checked.hatch_vectors += hatches.size() / 2;
            all += of_contours + hatches.size() / 2;
            if (options_.strategy)
                check_lines(part.exposure, vectors, hatches, found);
        }
        if (bounds.sections.empty() || bounds.sections.front().open_chains() > 0) {
            if (all > 0)
                found.add({.kind = FindingKind::unbounded_vectors, .count = all});
            return;
        }
        find_outside(group, bounds, found);
        if (options_.strategy)
            check_reach(group, bounds, *options_.strategy, options_.granted(), options_.steps.simplify_mm,
                        limits_, found);
    }

  private:
    /// Checks contours of one number. These must not cross, and none may lie within the material of another.
    void check_exposure(const Exposure& exposure, const Layer& vectors, Findings& found) const {
        Findings of_contours = check_layer(vectors, options_.granted(), limits_).found;
        for (Finding& finding : of_contours.by_file) {
            const bool overlapping = finding.kind == FindingKind::overlapping_rings;
            if (overlapping && exposure.contour == 0)
                continue;
            if (overlapping || finding.kind == FindingKind::tangled_rings)
                finding.kind = FindingKind::misoriented_rings;
            found.add(std::move(finding));
        }
    }

    /// Finds hatch lines that are too short.
    void check_lines(const Exposure& exposure, const Layer& layer, std::span<const Point2> hatches,
                     Findings& found) const {
        // Lines of a contour run along the middle of thin walls.
        if (exposure.kind == VectorKind::contour &&
            contours_of(*options_.strategy, exposure.region).thin_walls == ThinWalls::line)
            return;
        const double shortest = hatch_of(*options_.strategy, exposure.region).shortest - 2 * rounding_;
        for (std::size_t i = 0; i + 1 < hatches.size(); i += 2)
            if (distance(hatches[i], hatches[i + 1]) < shortest)
                found.note(FindingKind::short_lines, [&] { return where(layer, hatches[i]); });
    }

    void find_outside(const PlaneGroup& group, const MaterialBounds& bounds, Findings& found) const {
        // The material is grown a little, so that points on an edge are inside.
        Layer material = bounds.sections.front();
        for (std::size_t i = 1; i < bounds.sections.size(); ++i)
            material = combine(material, bounds.sections[i], BooleanOperation::unite, limits_);
        const double grown = 2 * tolerance_;
        const FindingKind kind =
            options_.strategy ? FindingKind::misplaced_vectors : FindingKind::outside_vectors;
        const EdgeTree edges(offset(material, grown, {.limits = limits_}));
        for (const PlaneExposure& part : group) {
            const double depth =
                options_.strategy ? depth_of(part.exposure, *options_.strategy) - bounds.depth : 0;
            // Lines of a contour run along the middle of walls that are too thin for the contour.
            const bool in_walls = part.exposure.kind == VectorKind::contour;
            if (part.outermost && !options_.mesh)
                continue;
            const Layer& vectors = part.polylines;
            const double nearest = std::max(0.0, depth) + grown - tolerance_;
            Followed followed(edges, nearest, vectors, kind, found);
            for (std::size_t i = 0; i < vectors.contours(); ++i) {
                const auto contour = vectors.contour(i);
                for (std::size_t k = 1; k < contour.size(); ++k)
                    followed.mark(contour[k - 1], contour[k]);
                if (vectors.closed(i))
                    followed.mark(contour.back(), contour.front());
            }
            Followed lines(edges, in_walls ? grown - tolerance_ : nearest, vectors, kind, found);
            const std::span<const Point2> hatches = part.hatches;
            for (std::size_t i = 0; i + 1 < hatches.size(); i += 2)
                lines.mark(hatches[i], hatches[i + 1]);
        }
    }

    /// The position of a beam. After a jump across an edge, it has to be determined again whether the beam is
    /// within the material.
    class Followed {
      public:
        /// Adds vectors outside, or nearer to the edges than the distance, to `found`.
        Followed(const EdgeTree& edges, double distance, const Layer& layer, FindingKind kind,
                 Findings& found)
            : edges_(edges), squared_(distance * distance), layer_(layer), kind_(kind), found_(found) {}

        void mark(const Point2& from, const Point2& to) {
            if (!known_ || (from != at_ && edges_.distance_squared(segment_between(at_, from), 0) == 0))
                inside_ = edges_.winding(from) > 0;
            const double nearest = edges_.distance_squared(segment_between(from, to), squared_ / 2);
            if (!inside_ || nearest < squared_)
                found_.note(kind_, [&] { return where(layer_, from); });
            known_ = nearest >= squared_; // otherwise the beam may have crossed an edge
            at_ = to;
        }

      private:
        const EdgeTree& edges_;
        double squared_;
        const Layer& layer_;
        FindingKind kind_;
        Findings& found_;
        bool known_ = false;
        bool inside_ = false; ///< at at_
        Point2 at_;
    };

    const VerifyOptions& options_;
    double rounding_;  ///< tolerance of ends of lines
    double tolerance_; ///< tolerance of edges of the material, including simplification
    LayerLimits limits_;
};

} // namespace

VectorVerification verify_vectors(const PlaneSource& file, const VerifyOptions& options,
                                  const Execution& execution) {
    Executor executor(file.for_planes(execution));
    const std::vector<ExposureGroup> groups = groups_of(file, options.mesh.has_value(), execution);
    VectorVerification result;
    const auto check_number = [&] {
        if (options.strategy && result.contour_vectors + result.hatch_vectors == 0)
            result.findings.add({.kind = FindingKind::no_vectors, .count = 1});
    };
    if (groups.empty()) {
        check_number();
        return result;
    }
    const LayerStack& planes = file.planes;
    result.layers = planes.size();
    const double largest = std::max(file.largest_coordinate, file.largest_hatch_coordinate);
    // Tolerance of ends of lines and points of contours, each moved along both axes, and of arithmetic.
    const double rounding = std::sqrt(2.0) * options.granted().step_at(largest) + 0x1p-34 * largest;

    const LayerLimits limits = layer_limits(execution, options.max_memory, executor.workers());
    const VectorCheck checked(options, rounding, limits);
    std::vector<CheckedPlane> checks(planes.size());
    ProgressMeter progress(execution, Stage::polygon, planes.size());
    std::vector<std::vector<Layer>> sections; // of a range of planes, with a mesh
    std::uint64_t first = 0;                  // of the range
    const auto check_plane = [&](std::uint64_t i) {
        const Plane vectors = file.plane(i);
        const auto bounds_of = [&](const ExposureGroup& group) {
            MaterialBounds bounds;
            if (options.mesh)
                bounds.sections = sections[i - first];
            else if (group.outermost)
                bounds = {{vectors.polylines[*group.outermost]},
                          options.strategy
                              ? depth_of(*file.parts[*group.outermost].exposure, *options.strategy)
                              : 0};
            return bounds;
        };
        for (const ExposureGroup& group : groups)
            checked.check(on_plane(group, file, vectors), bounds_of(group), checks[i]);
        if (options.mesh) {
            const InvertedRings inverted =
                inverted_rings(sections[i - first].front(), options.granted(), InversionSearch::full, limits);
            if (inverted.rings > 0)
                checks[i].found.add({.kind = FindingKind::rings_without_vectors,
                                     .count = inverted.rings,
                                     .amount = inverted.area_mm2 * planes[i].thickness(),
                                     .place = where(planes[i], inverted.at)});
        }
        progress.add(1);
    };
    std::vector<PlaneRange> ranges{{0, static_cast<std::uint32_t>(planes.size())}};
    if (options.mesh)
        ranges = ranges_of_sections(planes, options, execution);
    for (const PlaneRange range : ranges) {
        first = range.begin;
        sections.clear();
        if (options.mesh)
            sections =
                at_moved_cuts(std::span(planes).subspan(range.begin, range.size()), options.granted(),
                              options.rule, options.snap_mm, [&](const Plan& plan) {
                                  return layers_of(options, plan, steps_to_repeat(options, execution), execution);
                              });
        executor.for_chunks(range.size(), 1,
                            [&](std::uint64_t i, std::uint64_t, unsigned) { check_plane(range.begin + i); });
    }
    progress.finish();

    for (const CheckedPlane& check : checks) {
        result.contour_vectors += check.contour_vectors;
        result.hatch_vectors += check.hatch_vectors;
        result.findings.add(check.found);
    }
    check_number();
    add_height_overlaps(result.findings, planes, options.granted());
    if (options.mesh)
        result.heights =
            covered_heights(planes, *options.mesh, options.granted(), execution, result.findings);
    return result;
}

} // namespace lamella

#include "lamella/pipeline/verify.hpp"
#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/inverted_rings.hpp"
#include "lamella/polygon/offset.hpp"

#include "contour/distance.hpp"
#include "core/counted.hpp"
#include "core/executor.hpp"
#include "pipeline/exposure_groups.hpp"
#include "pipeline/layer_check.hpp"
#include "pipeline/layer_heights.hpp"
#include "pipeline/moved_cuts.hpp"
#include "pipeline/vector_findings.hpp"
#include "pipeline/vector_reach.hpp"
#include "polygon/edge_tree.hpp"
#include "scan/hatch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace lamella {

namespace {

class VectorCheck {
  public:
    /// `rounding` is the tolerance of ends.
    VectorCheck(const VerifyOptions& options, double rounding, const LayerLimits& limits)
        : options_(options), rounding_(rounding), tolerance_(rounding + options.steps.simplify_mm),
          limits_(limits) {}

    void check(const PlaneGroup& group, const MaterialBounds& bounds, PlaneFindings& found) const {
        std::uint64_t all = 0;
        for (const PlaneExposure& part : group) {
            const Layer& vectors = part.polylines;
            if (part.exposure.kind == VectorKind::contour)
                found.add(of_one_exposure(part.exposure, vectors));
            std::uint64_t of_contours = 0;
            for (std::size_t i = 0; i < vectors.contours(); ++i)
                of_contours += vectors.contour(i).size() - (vectors.closed(i) ? 0 : 1);
            found.contour_vectors += of_contours;
            const std::span<const Point2> hatches = part.hatches;
            found.hatch_vectors += hatches.size() / 2;
            all += of_contours + hatches.size() / 2;
            if (options_.strategy)
                check_lines(part.exposure, vectors, hatches, found);
        }
        if (bounds.sections.empty() || bounds.sections.front().open_chains() > 0) {
            found.unbounded += all;
            return;
        }
        find_outside(group, bounds, found);
        if (options_.strategy)
            check_reach(group, bounds, *options_.strategy, options_.granted(), options_.steps.simplify_mm,
                        limits_, found);
    }

  private:
    /// Returns findings about contours of one number. These must not cross, and none may lie within the
    /// material of another.
    [[nodiscard]] ContourFindings of_one_exposure(const Exposure& exposure, const Layer& vectors) const {
        ContourFindings found = check_layer(vectors, options_.granted(), limits_).found;
        found.misoriented.add(found.tangled);
        if (exposure.contour > 0)
            found.misoriented.add(found.overlapping);
        return found;
    }

    /// Finds hatch lines that are too short.
    void check_lines(const Exposure& exposure, const Layer& layer, std::span<const Point2> hatches,
                     PlaneFindings& found) const {
        // Lines of a contour run along the middle of thin walls.
        if (exposure.kind == VectorKind::contour &&
            contours_of(*options_.strategy, exposure.region).thin_walls == ThinWalls::line)
            return;
        const double shortest = hatch_of(*options_.strategy, exposure.region).shortest - 2 * rounding_;
        for (std::size_t i = 0; i + 1 < hatches.size(); i += 2)
            if (distance(hatches[i], hatches[i + 1]) < shortest)
                found.too_short.add(layer, hatches[i]);
    }

    void find_outside(const PlaneGroup& group, const MaterialBounds& bounds, PlaneFindings& found) const {
        // The material is grown a little, so that points on an edge are inside.
        Layer material = bounds.sections.front();
        for (std::size_t i = 1; i < bounds.sections.size(); ++i)
            material = combine(material, bounds.sections[i], BooleanOperation::unite, limits_);
        const double grown = 2 * tolerance_;
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
            Followed followed(edges, nearest, vectors, found.outside);
            for (std::size_t i = 0; i < vectors.contours(); ++i) {
                const auto contour = vectors.contour(i);
                for (std::size_t k = 1; k < contour.size(); ++k)
                    followed.mark(contour[k - 1], contour[k]);
                if (vectors.closed(i))
                    followed.mark(contour.back(), contour.front());
            }
            Followed lines(edges, in_walls ? grown - tolerance_ : nearest, vectors, found.outside);
            const std::span<const Point2> hatches = part.hatches;
            for (std::size_t i = 0; i + 1 < hatches.size(); i += 2)
                lines.mark(hatches[i], hatches[i + 1]);
        }
    }

    /// The position of a beam. After a jump across an edge, it has to be determined again whether the beam is
    /// within the material.
    class Followed {
      public:
        Followed(const EdgeTree& edges, double distance, const Layer& layer, LocatedCount& outside)
            : edges_(edges), squared_(distance * distance), layer_(layer), outside_(outside) {}

        void mark(const Point2& from, const Point2& to) {
            if (!known_ || (from != at_ && edges_.distance_squared(segment_between(at_, from), 0) == 0))
                inside_ = edges_.winding(from) > 0;
            const double nearest = edges_.distance_squared(segment_between(from, to), squared_ / 2);
            if (!inside_ || nearest < squared_)
                outside_.add(layer_, from);
            known_ = nearest >= squared_; // otherwise the beam may have crossed an edge
            at_ = to;
        }

      private:
        const EdgeTree& edges_;
        double squared_;
        const Layer& layer_;
        LocatedCount& outside_;
        bool known_ = false;
        bool inside_ = false; ///< at at_
        Point2 at_;
    };

    const VerifyOptions& options_;
    double rounding_;  ///< tolerance of ends of lines
    double tolerance_; ///< tolerance of edges of the material, including simplification
    LayerLimits limits_;
};

/// A kind of finding, its member in the checks of planes, and its count for the file.
struct KindOfFinding {
    LocatedCount PlaneFindings::*found;
    std::uint64_t VectorVerification::*total;
    FindingWords words;
};

std::array<KindOfFinding, 7> kinds_of_findings(bool strategy) {
    return {
        {{&PlaneFindings::open_chains, &VectorVerification::open_chains, open_chains_words},
         {&PlaneFindings::crossings, &VectorVerification::crossings, crossings_words},
         {&PlaneFindings::misoriented, &VectorVerification::misoriented, misoriented_words},
         {&PlaneFindings::outside, &VectorVerification::outside,
          strategy ? FindingWords{"vector is nearer to the edge of the material than the strategy says, or "
                                  "outside;",
                                  "vectors are nearer to the edge of the material than the strategy says, or "
                                  "outside;"}
                   : FindingWords{"vector leaves the material;", "vectors leave the material;"}},
         {&PlaneFindings::too_short,
          &VectorVerification::too_short,
          {"hatch line is shorter than the strategy says;",
           "hatch lines are shorter than the strategy says;"}},
         {&PlaneFindings::unreached,
          &VectorVerification::unreached_layers,
          {"layer has more material that no vector reaches than the strategy accepts;",
           "layers have more material that no vector reaches than the strategy accepts;"}},
         {&PlaneFindings::inverted,
          &VectorVerification::inverted_rings,
          {"ring of the mesh bounds no material and has no vectors, as triangles face inwards;",
           "rings of the mesh bound no material and have no vectors, as triangles face inwards;"}}}};
}

} // namespace

VectorVerification verify_vectors(const LayerFile& file, const VerifyOptions& options,
                                  const Execution& execution) {
    Executor executor(file.for_planes(execution));
    const std::vector<ExposureGroup> groups = groups_of(file, options.mesh.has_value(), execution);
    VectorVerification result;
    const auto check_number = [&] {
        result.none = options.strategy && result.contour_vectors + result.hatch_vectors == 0;
        if (result.none)
            result.findings.emplace_back("there are no scan vectors, and the strategy makes some");
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
    std::vector<PlaneFindings> checks(planes.size());
    ProgressMeter progress(execution, Stage::polygon, planes.size());
    std::vector<std::vector<Layer>> sections; // of a range of planes, with a mesh
    std::uint64_t first = 0;                  // of the range
    const auto check_plane = [&](std::uint64_t i) {
        const ScanVectors vectors = file.plane(i);
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
                checks[i].inverted.add(planes[i], inverted.at, inverted.rings);
            checks[i].inverted_mm3 = inverted.area_mm2 * planes[i].thickness();
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
                                  return layers_of(options, plan, steps_to_repeat(options.steps), execution);
                              });
        executor.for_chunks(range.size(), 1,
                            [&](std::uint64_t i, std::uint64_t, unsigned) { check_plane(range.begin + i); });
    }
    progress.finish();

    for (const KindOfFinding& kind : kinds_of_findings(options.strategy.has_value())) {
        LocatedCount all;
        for (const PlaneFindings& check : checks)
            all.add(check.*kind.found);
        result.*kind.total = all.total;
        append_finding(all, kind.words, result.findings);
    }
    for (const PlaneFindings& check : checks) {
        result.contour_vectors += check.contour_vectors;
        result.hatch_vectors += check.hatch_vectors;
        result.unbounded += check.unbounded;
        result.inverted_mm3 += check.inverted_mm3;
        result.unreached_mm2 += check.unreached_mm2;
    }
    check_number();
    result.height_overlaps = overlapping_heights(planes, options.granted(), result.findings);
    if (options.mesh)
        result.heights =
            covered_heights(planes, *options.mesh, options.granted(), execution, result.findings);
    if (result.unbounded > 0)
        result.findings.push_back(
            fmt::format("{} have no closed contour around them that would bound the material",
                        counted(result.unbounded, "vector")));
    return result;
}

} // namespace lamella

#include "lamella/contour/measure.hpp"
#include "lamella/pipeline/verify.hpp"
#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/fill.hpp"
#include "lamella/polygon/inverted_rings.hpp"
#include "lamella/polygon/offset.hpp"

#include "contour/distance.hpp"
#include "core/counted.hpp"
#include "core/executor.hpp"
#include "pipeline/layer_check.hpp"
#include "pipeline/layer_heights.hpp"
#include "pipeline/length_around.hpp"
#include "pipeline/moved_cuts.hpp"
#include "polygon/edge_tree.hpp"
#include "scan/hatch.hpp"
#include "scan/hatch_lines.hpp"
#include "scan/unreached.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <utility>

namespace lamella {

namespace {

/// Exposures whose vectors fill the same material.
struct Group {
    std::vector<const LayerPart*> exposures;
    const LayerPart* outermost = nullptr; ///< of its contours
};

double area_of(const LayerPart& part) {
    double area = 0;
    for (const Layer& layer : part.layers)
        area += measure(layer).area_mm2;
    return area;
}

/// Compares contours of one part by number or, since some files do not number them, by area.
bool lies_outside(const LayerPart& part, const LayerPart& other) {
    return part.exposure->contour != other.exposure->contour
               ? part.exposure->contour < other.exposure->contour
               : area_of(part) > area_of(other);
}

std::vector<Group> groups_of(std::span<const LayerPart> parts, bool all_together) {
    std::map<std::string, Group> groups;
    for (const LayerPart& part : parts) {
        if (!part.exposure)
            continue;
        Group& group = groups[all_together ? std::string() : part.exposure->part];
        group.exposures.push_back(&part);
        if (part.exposure->kind == VectorKind::contour &&
            (group.outermost == nullptr || lies_outside(part, *group.outermost)))
            group.outermost = &part;
    }
    std::vector<Group> result;
    for (auto& [name, group] : groups)
        result.push_back(std::move(group));
    return result;
}

const ContourRule& contours_of(const ScanStrategy& strategy, ScanRegion region) noexcept {
    return region == ScanRegion::support ? strategy.support.contours : strategy.contours;
}

const HatchRule& hatch_of(const ScanStrategy& strategy, ScanRegion region) noexcept {
    switch (region) {
    case ScanRegion::upskin:
        return strategy.upskin.hatch;
    case ScanRegion::downskin:
        return strategy.downskin.hatch;
    case ScanRegion::support:
        return strategy.support.hatch;
    default:
        return strategy.hatch;
    }
}

/// Returns the required distance of the vectors of an exposure from the outline of the part.
double depth_of(const Exposure& exposure, const ScanStrategy& strategy) noexcept {
    const ContourRule& contours = contours_of(strategy, exposure.region);
    return exposure.kind == VectorKind::contour ? contour_depth(contours, std::max(1U, exposure.contour))
                                                : hatch_depth(contours, hatch_of(strategy, exposure.region));
}

/// Returns the largest distance of the lines of a contour from the outline of the part.
double deepest_line(const Exposure& exposure, const ScanStrategy& strategy) noexcept {
    const ContourRule& contours = contours_of(strategy, exposure.region);
    double depth = depth_of(exposure, strategy);
    if (exposure.contour != 0 && exposure.contour < contours.count)
        return depth; // number 0 means that the number is unknown
    const auto too_thin_for = [&](const HatchRule& hatch) {
        depth = std::max(depth, hatch_depth(contours, hatch) + surely_hatched(hatch) / 2);
    };
    too_thin_for(hatch_of(strategy, exposure.region));
    if (exposure.region != ScanRegion::support)
        for (const SkinRule* const skin : {&strategy.upskin, &strategy.downskin})
            if (skin->layers > 0)
                too_thin_for(skin->hatch);
    return depth;
}

/// Findings about the contours of one number.
struct ContourRow {
    Finding missing;
    Finding elsewhere; ///< the area is not that at the depth of the contour

    void add(const ContourRow& other) {
        missing.add(other.missing);
        elsewhere.add(other.elsewhere);
    }
};

struct PlaneCheck : ContourFindings {
    Finding outside;
    Finding too_short;
    Finding misplaced;
    Finding miscovered;
    Finding unreached;
    Finding inverted;
    std::map<std::uint32_t, ContourRow> rows; ///< by contour number; only contours with findings
    std::uint64_t contour_vectors = 0;
    std::uint64_t hatch_vectors = 0;
    std::uint64_t unbounded = 0;
    double covered_mm2 = 0;
    double filled_mm2 = 0; ///< area that had to be covered
    double unreached_mm2 = 0;
    double inverted_mm3 = 0;
};

/// Possible sections of the material of a plane. There are several if the format may have moved the cut.
struct Bounds {
    std::vector<Layer> sections; ///< the first is at the height in the file
    double depth = 0;            ///< distance of their outlines from that of the part
};

class Slack {
  public:
    /// The area covered by lines may end half a line distance beside the edge of the filled area. Areas
    /// narrower than the shortest line have no lines. Stripes and islands overlap, and each leaves out lines
    /// that are too short.
    void add(const HatchRule& rule) {
        const bool cells = rule.pattern != HatchPattern::lines && rule.pattern != HatchPattern::meander;
        strip_less_ = std::max(strip_less_, rule.distance / 2 + rule.shortest);
        strip_more_ = std::max(strip_more_, rule.distance / 2 + (cells ? rule.overlap : 0));
        if (!cells)
            return;
        const double longer = 1 + rule.overlap / rule.cell;
        // A square has all lines whose width reaches into it; lines in hexagons end at the border.
        constexpr double rounding = 1e-9;
        const double wider = rule.pattern == HatchPattern::chessboard
                                 ? std::ceil((rule.cell + std::max(rule.overlap, rule.distance)) /
                                             rule.distance * (1 - rounding)) *
                                       rule.distance / rule.cell
                             : rule.pattern == HatchPattern::hexagons
                                 ? 1 + 2 * std::max(rule.overlap, rule.distance) / rule.cell
                                 : longer;
        share_more_ = std::max(share_more_, longer * wider - 1);
        share_less_ = std::max(share_less_, (rule.shortest / rule.cell) * (rule.shortest / rule.cell));
    }
    [[nodiscard]] double less(const LayerMeasure& area) const noexcept {
        return strip_less_ * area.perimeter_mm + share_less_ * area.area_mm2;
    }
    [[nodiscard]] double more(const LayerMeasure& area) const noexcept {
        return strip_more_ * area.perimeter_mm + share_more_ * area.area_mm2;
    }

  private:
    double strip_less_ = 0;
    double strip_more_ = 0;
    double share_less_ = 0;
    double share_more_ = 0;
};

double length_of(std::span<const Point2> hatches) {
    double length = 0;
    for (std::size_t i = 0; i + 1 < hatches.size(); i += 2)
        length += distance(hatches[i], hatches[i + 1]);
    return length;
}

/// The lines that a strategy prescribes for a layer.
class AskedLines {
  public:
    /// `tolerance` applies to the ends of lines.
    AskedLines(const HatchRule& rule, std::uint64_t layer, double tolerance)
        : distance_(rule.distance), phase_(line_phase(rule.pattern)), tolerance_(tolerance) {
        for (const CosSin& angle : line_angles(rule, layer))
            frames_.push_back({angle});
    }

    [[nodiscard]] bool have(const Point2& a, const Point2& b) const {
        return std::any_of(frames_.begin(), frames_.end(), [&](const LineFrame& frame) {
            const double across = frame.across(a);
            const double v = (std::nearbyint(across / distance_ - phase_) + phase_) * distance_;
            return std::abs(across - v) <= tolerance_ && std::abs(frame.across(b) - v) <= tolerance_;
        });
    }

  private:
    std::vector<LineFrame> frames_;
    double distance_;
    double phase_;
    double tolerance_;
};

struct HatchLine {
    const Point2* ends = nullptr;
    const HatchRule* rule = nullptr;
    std::uint64_t layer = 0;

    [[nodiscard]] double length() const noexcept { return ends == nullptr ? 0 : distance(ends[0], ends[1]); }
};

/// Returns the longest line for each plane and rule with lines. Begins with the lowest plane and stops when
/// there are enough lines.
std::vector<HatchLine> longest_lines(const std::vector<Group>& groups, const ScanStrategy& strategy,
                                     std::size_t planes) {
    constexpr std::size_t enough = 32;
    std::vector<HatchLine> lines;
    for (std::size_t plane = 0; plane < planes && lines.size() < enough; ++plane) {
        std::map<const HatchRule*, HatchLine> longest;
        for (const Group& group : groups)
            for (const LayerPart* const part : group.exposures) {
                const std::span<const Point2> hatches = part->hatches_of(plane);
                const HatchRule& rule = hatch_of(strategy, part->exposure->region);
                for (std::size_t i = 0; i + 1 < hatches.size(); i += 2)
                    if (const HatchLine line{&hatches[i], &rule, part->layers[plane].index};
                        line.length() > longest[&rule].length())
                        longest[&rule] = line;
            }
        for (const auto& of_rule : longest)
            if (of_rule.second.ends != nullptr)
                lines.push_back(of_rule.second);
    }
    return lines;
}

/// Returns the number of layers of the plan below the first layer of the file. It is the number for which the
/// most lines are at their expected positions.
std::uint64_t layers_before(const std::vector<HatchLine>& lines, double tolerance, const Executor& executor) {
    constexpr std::uint64_t most = 1 << 17;
    std::uint64_t best = 0;
    std::ptrdiff_t most_fit = 0;
    for (std::uint64_t before = 0; before < most && most_fit < std::ssize(lines); ++before) {
        if (before % 1024 == 0)
            executor.check_cancelled();
        const auto fit = std::count_if(lines.begin(), lines.end(), [&](const HatchLine& line) {
            return AskedLines(*line.rule, before + line.layer, tolerance).have(line.ends[0], line.ends[1]);
        });
        if (fit > most_fit) {
            most_fit = fit;
            best = before;
        }
    }
    return best;
}

class VectorCheck {
  public:
    /// `before` is the number of layers of the plan before the first checked one. `rounding` is the tolerance
    /// of ends.
    VectorCheck(const VerifyOptions& options, double rounding, std::uint64_t before)
        : options_(options), rounding_(rounding), tolerance_(rounding + options.steps.simplify_mm),
          before_(before) {}

    void check(const Group& group, std::size_t plane, const Bounds& bounds, PlaneCheck& found) const {
        std::uint64_t all = 0;
        for (const LayerPart* const part : group.exposures) {
            const Layer& vectors = part->layers[plane];
            if (part->exposure->kind == VectorKind::contour)
                found.add(of_one_exposure(*part->exposure, vectors));
            std::uint64_t of_contours = 0;
            for (std::size_t i = 0; i < vectors.contours(); ++i)
                of_contours += vectors.contour(i).size() - (vectors.closed(i) ? 0 : 1);
            found.contour_vectors += of_contours;
            const std::span<const Point2> hatches = part->hatches_of(plane);
            found.hatch_vectors += hatches.size() / 2;
            all += of_contours + hatches.size() / 2;
            if (options_.strategy)
                check_lines(*part->exposure, vectors, hatches, found);
        }
        if (bounds.sections.empty() || bounds.sections.front().open_chains() > 0) {
            found.unbounded += all;
            return;
        }
        find_outside(group, plane, bounds, found);
        if (options_.strategy) {
            measure_cover(group, plane, bounds, found);
            measure_unreached(group, plane, bounds, found);
        }
    }

    /// Checks that each contour that the strategy prescribes for a part is present and encloses the area at
    /// its depth.
    void check_rows(const Group& group, std::size_t plane, const Bounds& bounds, PlaneCheck& found) const {
        if (bounds.sections.empty() || bounds.sections.front().open_chains() > 0)
            return;
        const ContourRule& rule = contours_of(*options_.strategy, group.exposures.front()->exposure->region);
        const Layer& header = group.exposures.front()->layers[plane];
        for (std::uint32_t number = 1; number <= rule.count; ++number) {
            LayerMeasure row;
            Point2 at;
            for (const LayerPart* const part : group.exposures) {
                const Exposure& exposure = *part->exposure;
                if (exposure.kind != VectorKind::contour || std::max(1U, exposure.contour) != number)
                    continue;
                row.add(measure(part->layers[plane]));
                if (!part->layers[plane].points.empty())
                    at = part->layers[plane].points[0];
            }
            double least = std::numeric_limits<double>::infinity();
            double greatest = -least;
            const auto agrees = [&] {
                return least <= row.area_mm2 && row.area_mm2 <= greatest;
            };
            for (const double limit : limits_of_mitres(OffsetCorners{}.mitre_limit, options_.granted())) {
                for (const Layer& section : bounds.sections) {
                    const LayerMeasure expected = measure(moved_inwards(
                        section, contour_depth(rule, number) - bounds.depth, {.mitre_limit = limit}));
                    const double slack = 4 * tolerance_ * (expected.perimeter_mm + row.perimeter_mm);
                    least = std::min(least, expected.area_mm2 - slack);
                    greatest = std::max(greatest, expected.area_mm2 + slack);
                    if (row.contours == 0 && !section.points.empty())
                        at = section.points[0];
                }
                if (agrees())
                    break;
            }
            if (agrees())
                continue;
            ContourRow& wrong = found.rows[number];
            (row.contours == 0 ? wrong.missing : wrong.elsewhere).add(header, at);
        }
    }

  private:
    /// Overlapping bodies are united even if the depth is 0, as in `scan`.
    static Layer moved_inwards(const Layer& section, double depth, const OffsetCorners& corners = {}) {
        return depth == 0 ? fill(section, FillRule::positive).layer : offset(section, -depth, corners);
    }

    /// Returns findings about contours of one number. These must not cross, and none may lie within the
    /// material of another.
    [[nodiscard]] ContourFindings of_one_exposure(const Exposure& exposure, const Layer& vectors) const {
        ContourFindings found = check_layer(vectors, options_.granted()).found;
        found.misoriented.add(found.tangled);
        if (exposure.contour > 0)
            found.misoriented.add(found.overlapping);
        return found;
    }

    /// Returns whether the strategy prescribes lines for an exposure.
    [[nodiscard]] bool asks_for_lines(const Exposure& exposure) const noexcept {
        const ScanStrategy& strategy = *options_.strategy;
        return exposure.kind == VectorKind::hatch &&
               (exposure.region != ScanRegion::upskin || strategy.upskin.layers > 0) &&
               (exposure.region != ScanRegion::downskin || strategy.downskin.layers > 0);
    }

    void check_lines(const Exposure& exposure, const Layer& layer, std::span<const Point2> hatches,
                     PlaneCheck& found) const {
        const HatchRule& rule = hatch_of(*options_.strategy, exposure.region);
        // Lines of a contour run along the middle of thin walls.
        if (exposure.kind == VectorKind::contour &&
            contours_of(*options_.strategy, exposure.region).thin_walls == ThinWalls::line)
            return;
        const bool asked = asks_for_lines(exposure);
        const AskedLines lines(rule, before_ + layer.index, rounding_);
        for (std::size_t i = 0; i + 1 < hatches.size(); i += 2) {
            const Point2& a = hatches[i];
            const Point2& b = hatches[i + 1];
            if (distance(a, b) < rule.shortest - 2 * rounding_)
                found.too_short.add(layer, a);
            if (!asked || !lines.have(a, b))
                found.misplaced.add(layer, a);
        }
    }

    void find_outside(const Group& group, std::size_t plane, const Bounds& bounds, PlaneCheck& found) const {
        // The material is grown a little, so that points on an edge are inside.
        Layer material = bounds.sections.front();
        for (std::size_t i = 1; i < bounds.sections.size(); ++i)
            material = combine(material, bounds.sections[i], BooleanOperation::unite);
        const double grown = 2 * tolerance_;
        const EdgeTree edges(offset(material, grown));
        for (const LayerPart* const part : group.exposures) {
            const double depth =
                options_.strategy ? depth_of(*part->exposure, *options_.strategy) - bounds.depth : 0;
            // Lines of a contour run along the middle of walls that are too thin for the contour. Lines of
            // the innermost contour also run along the middle of areas that are too thin for a hatch.
            const bool in_walls = part->exposure->kind == VectorKind::contour;
            if (in_walls && options_.strategy)
                find_in_thick(
                    edges,
                    std::max(0.0, deepest_line(*part->exposure, *options_.strategy) - bounds.depth) + grown +
                        tolerance_,
                    part->layers[plane], part->hatches_of(plane), found.misplaced);
            if (part == group.outermost && !options_.mesh)
                continue;
            const Layer& vectors = part->layers[plane];
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
            const std::span<const Point2> hatches = part->hatches_of(plane);
            for (std::size_t i = 0; i + 1 < hatches.size(); i += 2)
                lines.mark(hatches[i], hatches[i + 1]);
        }
    }

    /// Finds lines whose midpoints are farther within the material than `depth`.
    static void find_in_thick(const EdgeTree& edges, double depth, const Layer& layer,
                              std::span<const Point2> hatches, Finding& found) {
        for (std::size_t i = 0; i + 1 < hatches.size(); i += 2) {
            const Point2& a = hatches[i];
            const Point2& b = hatches[i + 1];
            const Point2 middle{a.x + (b.x - a.x) / 2, a.y + (b.y - a.y) / 2};
            if (edges.winding(middle) > 0 && edges.distance_squared(middle, depth * depth) > depth * depth)
                found.add(layer, a);
        }
    }

    /// The position of a beam. After a jump across an edge, it has to be determined again whether the beam is
    /// within the material.
    class Followed {
      public:
        Followed(const EdgeTree& edges, double distance, const Layer& layer, Finding& outside)
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
        Finding& outside_;
        bool known_ = false;
        bool inside_ = false; ///< at at_
        Point2 at_;
    };

    void measure_cover(const Group& group, std::size_t plane, const Bounds& bounds, PlaneCheck& found) const {
        const ScanStrategy& strategy = *options_.strategy;
        Slack slack;
        double shallow = std::numeric_limits<double>::infinity();
        double deep = -shallow;
        const auto expect = [&](ScanRegion region) {
            const HatchRule& rule = hatch_of(strategy, region);
            slack.add(rule);
            const double depth = hatch_depth(contours_of(strategy, region), rule) - bounds.depth;
            shallow = std::min(shallow, depth);
            deep = std::max(deep, depth);
        };
        // Files may list only regions that are not empty, and skins may cover all of the core.
        if (group.exposures.front()->exposure->region == ScanRegion::support) {
            expect(ScanRegion::support);
        } else {
            expect(ScanRegion::core);
            if (strategy.upskin.layers > 0)
                expect(ScanRegion::upskin);
            if (strategy.downskin.layers > 0)
                expect(ScanRegion::downskin);
        }
        double covered = 0;
        double around_skins = 0; // mm; skins overlap adjacent regions
        double over_others = 0;
        for (const LayerPart* const part : group.exposures) {
            const Exposure& exposure = *part->exposure;
            if (exposure.kind != VectorKind::hatch)
                continue;
            expect(exposure.region);
            const HatchRule& rule = hatch_of(strategy, exposure.region);
            const double area = length_of(part->hatches_of(plane)) * rule.distance;
            covered += area;
            if (exposure.region == ScanRegion::upskin || exposure.region == ScanRegion::downskin) {
                const double around = length_around(part->hatches_of(plane), rule.distance);
                around_skins += around;
                over_others += around * (exposure.region == ScanRegion::upskin ? strategy.upskin.overlap
                                                                               : strategy.downskin.overlap);
            }
        }
        const Layer* section = &bounds.sections.front();
        LayerMeasure
            to_fill; // of the first section with material, since rounded heights may be outside of the part
        LayerMeasure largest;
        double least = std::numeric_limits<double>::infinity();
        for (const Layer& moved : bounds.sections) {
            const LayerMeasure area = measure(offset(moved, -shallow));
            if (to_fill.area_mm2 == 0 && area.area_mm2 != 0) {
                to_fill = area;
                section = &moved;
            }
            largest.area_mm2 = std::max(largest.area_mm2, area.area_mm2);
            largest.perimeter_mm = std::max(largest.perimeter_mm, area.perimeter_mm);
            least = std::min(least, measure(offset(moved, -deep)).area_mm2);
        }
        const double moved_edges = tolerance_ * largest.perimeter_mm;
        LayerMeasure edges = largest; // including those of skins
        edges.perimeter_mm += around_skins;
        least -= slack.less(edges) + moved_edges;
        const double greatest = largest.area_mm2 + slack.more(edges) + over_others + moved_edges;
        if (covered < least || covered > greatest)
            found.miscovered.add(group.exposures.front()->layers[plane],
                                 section->points.empty() ? Point2{} : section->points[0]);
        found.covered_mm2 += covered;
        found.filled_mm2 += to_fill.area_mm2;
    }

    /// Measures the unreached material of each possible section, and keeps the smallest result.
    void measure_unreached(const Group& group, std::size_t plane, const Bounds& bounds,
                           PlaneCheck& found) const {
        const ScanStrategy& strategy = *options_.strategy;
        const ScanRegion region = group.exposures.front()->exposure->region;
        const ContourRule& contours = contours_of(strategy, region);
        const HatchRule& hatch = region == ScanRegion::support ? strategy.support.hatch : strategy.hatch;
        std::vector<Stroke> strokes;
        double least = std::numeric_limits<double>::infinity();
        Point2 at;
        for (const Layer& section : bounds.sections) {
            const Layer positions = narrow_points(moved_inwards(section, 0), bounds.depth, contours, hatch);
            if (positions.rings > 0 && strokes.empty())
                for (const LayerPart* const part : group.exposures)
                    add_strokes(part->layers[plane], part->hatches_of(plane),
                                2 * tolerance_ +
                                    (part->exposure->kind == VectorKind::hatch
                                         ? hatch_of(strategy, part->exposure->region).distance
                                         : contour_reach(contours_of(strategy, part->exposure->region))),
                                strokes);
            if (const double left = unreached_area(positions, strokes); left < least) {
                least = left;
                at = positions.points.empty() ? Point2{} : positions.points[0];
            }
        }
        if (least > strategy.accepted_mm2)
            found.unreached.add(group.exposures.front()->layers[plane], at);
        found.unreached_mm2 += least;
    }

    const VerifyOptions& options_;
    double rounding_;  ///< tolerance of ends of lines
    double tolerance_; ///< tolerance of edges of the material, including simplification
    std::uint64_t before_;
};

/// A kind of finding, its member in the checks of planes, and its count for the file.
struct KindOfFinding {
    Finding PlaneCheck::*found;
    std::uint64_t VectorVerification::*total;
    FindingWords words;
};

std::array<KindOfFinding, 9> kinds_of_findings(bool strategy) {
    return {
        {{&PlaneCheck::open_chains, &VectorVerification::open_chains, open_chains_words},
         {&PlaneCheck::crossings, &VectorVerification::crossings, crossings_words},
         {&PlaneCheck::misoriented, &VectorVerification::misoriented, misoriented_words},
         {&PlaneCheck::outside, &VectorVerification::outside,
          strategy ? FindingWords{"vector is nearer to the edge of the material than the strategy says, or "
                                  "outside;",
                                  "vectors are nearer to the edge of the material than the strategy says, or "
                                  "outside;"}
                   : FindingWords{"vector leaves the material;", "vectors leave the material;"}},
         {&PlaneCheck::too_short,
          &VectorVerification::too_short,
          {"hatch line is shorter than the strategy says;",
           "hatch lines are shorter than the strategy says;"}},
         {&PlaneCheck::misplaced,
          &VectorVerification::misplaced,
          {"hatch line lies beside those of the strategy, has another angle or another exposure;",
           "hatch lines lie beside those of the strategy, have another angle or another exposure;"}},
         {&PlaneCheck::miscovered,
          &VectorVerification::miscovered,
          {"layer has lines that cover more or less than they should fill;",
           "layers have lines that cover more or less than they should fill;"}},
         {&PlaneCheck::unreached,
          &VectorVerification::unreached_layers,
          {"layer has more material that no vector reaches than the strategy accepts;",
           "layers have more material that no vector reaches than the strategy accepts;"}},
         {&PlaneCheck::inverted,
          &VectorVerification::inverted_rings,
          {"ring of the mesh bounds no material and has no vectors, as triangles face inwards;",
           "rings of the mesh bound no material and have no vectors, as triangles face inwards;"}}}};
}

void append_row(std::uint32_t number, const ContourRow& row, std::vector<std::string>& findings) {
    const auto append_finding_of = [&](const Finding& finding, const char* what) {
        if (finding.total > 0)
            findings.push_back(fmt::format("contour {} {} on {}, the first is {}", number, what,
                                           counted(finding.total, "layer"), finding.position));
    };
    append_finding_of(row.missing, "is missing");
    append_finding_of(row.elsewhere, "encloses another area than the material has at its depth");
}

} // namespace

VectorVerification verify_vectors(std::span<const LayerPart> parts, const VerifyOptions& options,
                                  const Execution& execution) {
    for (const LayerPart& part : parts)
        for (const Layer& layer : part.layers)
            check(layer);
    const std::vector<Group> groups = groups_of(parts, options.mesh.has_value());
    // Requirements on contours apply to each part. A mesh does not distinguish parts.
    const std::vector<Group> of_parts = options.strategy ? groups_of(parts, false) : std::vector<Group>();
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
    const LayerStack& planes = groups.front().exposures.front()->layers;
    result.layers = planes.size();
    std::vector<std::vector<Layer>> sections;
    if (options.mesh)
        sections =
            at_moved_cuts(planes, options.granted(), options.rule, options.snap_mm, [&](const Plan& plan) {
                return layers_of(options, plan, steps_to_repeat(options.steps), execution);
            });

    double largest = 0;
    for (const Group& group : groups)
        for (const LayerPart* const part : group.exposures)
            for (std::size_t i = 0; i < part->layers.size(); ++i)
                largest = std::max({largest, largest_coordinate(part->layers[i].points.span()),
                                    largest_coordinate(part->hatches_of(i))});
    // Tolerance of ends of lines and points of contours, each moved along both axes, and of arithmetic.
    const double rounding = std::sqrt(2.0) * options.granted().step_at(largest) + 0x1p-34 * largest;

    Executor executor(execution);
    const VectorCheck vectors(
        options, rounding,
        options.strategy
            ? layers_before(longest_lines(groups, *options.strategy, planes.size()), rounding, executor)
            : 0);
    std::vector<PlaneCheck> checks(planes.size());
    ProgressMeter progress(execution, Stage::polygon, planes.size());
    executor.for_chunks(planes.size(), 1, [&](std::uint64_t i, std::uint64_t, unsigned) {
        const auto bounds_of = [&](const Group& group, bool by_mesh) {
            Bounds bounds;
            if (by_mesh)
                bounds.sections = sections[i];
            else if (group.outermost != nullptr)
                bounds = {{group.outermost->layers[i]},
                          options.strategy ? depth_of(*group.outermost->exposure, *options.strategy) : 0};
            return bounds;
        };
        for (const Group& group : groups)
            vectors.check(group, i, bounds_of(group, options.mesh.has_value()), checks[i]);
        if (options.mesh) {
            const InvertedRings inverted =
                inverted_rings(sections[i].front(), options.granted(), InversionSearch::full);
            if (inverted.rings > 0)
                checks[i].inverted.add(planes[i], inverted.at, inverted.rings);
            checks[i].inverted_mm3 = inverted.area_mm2 * planes[i].thickness();
        }
        for (const Group& group : of_parts)
            vectors.check_rows(group, i, bounds_of(group, options.mesh && of_parts.size() == 1), checks[i]);
        progress.add(1);
    });
    progress.finish();

    for (const KindOfFinding& kind : kinds_of_findings(options.strategy.has_value())) {
        Finding all;
        for (const PlaneCheck& check : checks)
            all.add(check.*kind.found);
        result.*kind.total = all.total;
        append_finding(all, kind.words, result.findings);
    }
    std::map<std::uint32_t, ContourRow> rows;
    double covered_mm2 = 0;
    double filled_mm2 = 0;
    for (const PlaneCheck& check : checks) {
        for (const auto& row : check.rows)
            rows[row.first].add(row.second);
        result.contour_vectors += check.contour_vectors;
        result.hatch_vectors += check.hatch_vectors;
        result.unbounded += check.unbounded;
        result.inverted_mm3 += check.inverted_mm3;
        covered_mm2 += check.covered_mm2;
        filled_mm2 += check.filled_mm2;
        result.unreached_mm2 += check.unreached_mm2;
    }
    check_number();
    if (options.strategy && filled_mm2 > 0)
        result.cover = covered_mm2 / filled_mm2;
    for (const auto& row : rows) {
        result.wrong_contours += row.second.missing.total + row.second.elsewhere.total;
        append_row(row.first, row.second, result.findings);
    }
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

#pragma once

// The exposure strategy of a powder-bed machine: contours, hatches, skins. Lengths are in mm.

#include "lamella/contour/exposure.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// The order and division of lines that fill an area.
enum class HatchPattern : std::uint8_t {
    lines,      ///< one by one, all in one direction
    meander,    ///< one by one, in alternating directions
    stripes,    ///< cut into stripes; lines run across them in alternating directions, stripe by stripe
    chessboard, ///< cut into squares, each hatched across the direction of its neighbours
    hexagons,   ///< cut into hexagons, each hatched in one of three directions; neighbours differ
};
[[nodiscard]] std::string_view hatch_pattern_name(HatchPattern pattern) noexcept;

/// The order in which squares or hexagons are hatched.
enum class IslandOrder : std::uint8_t {
    rows,   ///< row by row, in alternating directions
    random, ///< by the seed of the strategy, in another order on each layer
};
[[nodiscard]] std::string_view island_order_name(IslandOrder order) noexcept;

/// Parallel lines that fill an area.
///
/// Lines lie at multiples of `distance` from a line through the origin of the machine; in squares, they are
/// shifted by half of `distance`. Stripes and islands form a grid from the same origin. Lines and grid are
/// the same for all parts and shards. Angles are measured counter-clockwise from the x axis.
struct HatchRule {
    HatchPattern pattern = HatchPattern::stripes;
    double distance = 0.1;    ///< between lines, above 0
    double angle_degrees = 0; ///< of the lines of layer 0
    double turn_degrees = 67; ///< from each layer to the next
    double border = 0.05;  ///< from the innermost contour, or the outline of the part, to the ends of lines
    double shortest = 0.1; ///< shorter lines are left out
    /// Width of a stripe or square, or of a hexagon from side to side; above 0. For patterns with cells, it
    /// must also be above `shortest` and at most 1e9.
    double cell = 5;
    /// Overlap of neighbouring stripes or islands, for patterns with cells; less than half of `cell`.
    double overlap = 0.1;
    IslandOrder order = IslandOrder::rows;
    ParameterSet parameters;
};

/// The start point of a contour.
enum class StartPoint : std::uint8_t {
    aligned,  ///< the corner that is farthest in a direction
    sharpest, ///< the sharpest convex corner; if there is none, the least sharp concave corner
    random,   ///< a corner chosen by the seed of the strategy
};
[[nodiscard]] std::string_view start_point_name(StartPoint start) noexcept;

/// The contour that comes first.
enum class ContourOrder : std::uint8_t { inside_out, outside_in };
[[nodiscard]] std::string_view contour_order_name(ContourOrder order) noexcept;

/// The treatment of walls that are too thin for a contour on either side.
enum class ThinWalls : std::uint8_t {
    line,      ///< a single line along their middle
    leave_out, ///< nothing
};
[[nodiscard]] std::string_view thin_walls_name(ThinWalls walls) noexcept;

/// Largest numbers of contours and of skin layers.
inline constexpr std::uint32_t most_contours = 100;
inline constexpr std::uint32_t most_skin_layers = 1000;

/// Lines along the outline of the part.
struct ContourRule {
    std::uint32_t count = 1; ///< at most `most_contours`; 0 leaves contours out
    double beam_offset =
        0.05; ///< from the outline of the part inwards to the outermost contour: half of the melt pool width
    double distance = 0.1; ///< from each contour to the next one inwards
    ContourOrder order = ContourOrder::inside_out;
    bool before_hatch = false;
    StartPoint start = StartPoint::aligned;
    double start_direction_degrees = 90; ///< of StartPoint::aligned
    /// Treatment of walls thinner than twice the beam's offset. With ThinWalls::line, walls at least
    /// `thinnest` wide get lines. These are stored as hatches (two points each) in the exposure of the
    /// outermost contour. Where an inner contour does not fit and the previous contour does not reach all
    /// material, the exposure of the inner contour has such lines, too. The exposure of the innermost contour
    /// also has lines in narrow areas that hatch lines miss.
    ThinWalls thin_walls = ThinWalls::line;
    double thinnest = 0.05;
    ParameterSet parameters{.name = "contour", .power_w = 120, .speed_mm_s = 500};
};

/// A region of a layer with fewer than `layers` layers of material above it (upskin) or below it (downskin).
struct SkinRule {
    std::uint32_t layers = 0; ///< at most `most_skin_layers`; 0: no such region
    /// Strips narrower than this are not skin: rounding and sloping walls leave such strips at edges, in
    /// grooves and on ribs. The limit is accurate to 1 %. The default is the default hatch distance.
    double narrowest = 0.1;
    double overlap = 0.1; ///< distance by which the region is grown into the core
    HatchRule hatch;
};

/// Rules for support parts. These need not be dense, so the default is a larger hatch distance and less
/// energy.
struct SupportRule {
    ContourRule contours{.parameters = {.name = "support", .power_w = 120, .speed_mm_s = 1000}};
    HatchRule hatch{.pattern = HatchPattern::meander,
                    .distance = 0.2,
                    .parameters = {.name = "support", .power_w = 120, .speed_mm_s = 1000}};
};

/// The entire strategy. The default values suit 316L steel and layers of 0.03 mm.
struct ScanStrategy {
    ContourRule contours;
    HatchRule hatch; ///< of the core
    SkinRule upskin{.hatch = {.parameters = {.name = "upskin", .power_w = 180, .speed_mm_s = 900}}};
    SkinRule downskin{.hatch = {.parameters = {.name = "downskin", .power_w = 120, .speed_mm_s = 1200}}};
    SupportRule support; ///< for support parts, which have no skins
    std::uint64_t seed = 1;
    /// Largest area of a part on a layer that causes no warning, mm^2: of unreached material, and of overlaps
    /// with other parts.
    double accepted_mm2 = 0.005;
    /// True if parts that overlap get the vectors of their union. The first of them gets all of these. Parts
    /// are not united with supports. Overlapping components of one object are always united.
    bool unite_parts = false;
};

/// Returns the distance of a contour from the outline of the part. `number` is 1 for the outermost contour.
[[nodiscard]] double contour_depth(const ContourRule& rule, std::uint32_t number) noexcept;
/// Returns the distance from the outline of the part at which hatch lines end.
[[nodiscard]] double hatch_depth(const ContourRule& contours, const HatchRule& rule) noexcept;

/// Throws Error{usage} that names the field for values out of range.
void check_strategy(const ScanStrategy& strategy);

/// Returns the exposures of each layer of a part, in the order in which they are executed.
[[nodiscard]] std::vector<Exposure> exposures(const ScanStrategy& strategy, const std::string& part);

/// Returns the exposures of each layer of a support part.
[[nodiscard]] std::vector<Exposure> support_exposures(const ScanStrategy& strategy, const std::string& part);

} // namespace lamella
LAMELLA_API_END

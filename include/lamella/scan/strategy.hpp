#pragma once

// How a powder-bed machine is to expose a part: contours, hatches, skins. Lengths are in mm.

#include "lamella/contour/exposure.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// How lines that fill an area follow one another.
enum class HatchPattern : std::uint8_t {
    lines,      ///< one by one, all in one direction
    meander,    ///< one by one, back and forth
    stripes,    ///< cut into stripes, across which they go back and forth; stripe by stripe
    chessboard, ///< cut into squares, each hatched across the direction of its neighbours
    hexagons,   ///< cut into hexagons, hatched in three directions, other ones in neighbours
};
[[nodiscard]] std::string_view hatch_pattern_name(HatchPattern pattern) noexcept;

/// In what order squares or hexagons are hatched.
enum class IslandOrder : std::uint8_t {
    rows,   ///< row by row, back and forth
    random, ///< by the seed of the strategy, another order on each layer
};
[[nodiscard]] std::string_view island_order_name(IslandOrder order) noexcept;

/// Parallel lines that fill an area.
///
/// They lie at multiples of the distance from a line through the origin of the machine, whatever part, shard
/// or neighbour they are for; stripes and islands likewise. Angles are from the x axis to the y axis.
struct HatchRule {
    HatchPattern pattern = HatchPattern::stripes;
    double distance = 0.1;    ///< from line to line, above 0
    double angle_degrees = 0; ///< of the lines of layer 0
    double turn_degrees = 67; ///< from each layer to the next
    double border = 0.05;     ///< from the innermost contour, or the outline of the part, to where lines end
    double shortest = 0.1;    ///< shorter lines are left out
    /// Width of a stripe or a square, of a hexagon from side to side; above 0, and above `shortest` and at
    /// most 1e9 where the pattern has any of these.
    double cell = 5;
    /// Of neighbouring stripes or islands, where there are any; less than half of `cell`.
    double overlap = 0.1;
    IslandOrder order = IslandOrder::rows;
    ParameterSet parameters;
};

/// Where a beam begins to follow a contour.
enum class StartPoint : std::uint8_t {
    aligned,  ///< at the corner that is farthest in a direction
    sharpest, ///< at the sharpest convex corner; where there is none, at the concave one that turns least
    random,   ///< at a corner by the seed of the strategy
};
[[nodiscard]] std::string_view start_point_name(StartPoint start) noexcept;

/// Which contour of several comes first.
enum class ContourOrder : std::uint8_t { inside_out, outside_in };
[[nodiscard]] std::string_view contour_order_name(ContourOrder order) noexcept;

/// What becomes of walls that are too thin for a contour on either side.
enum class ThinWalls : std::uint8_t {
    line,      ///< a single line along their middle
    leave_out, ///< nothing
};
[[nodiscard]] std::string_view thin_walls_name(ThinWalls walls) noexcept;

/// The most that a strategy can ask for.
inline constexpr std::uint32_t most_contours = 100;
inline constexpr std::uint32_t most_skin_layers = 1000;

/// Lines along the outline of the part.
struct ContourRule {
    std::uint32_t count = 1; ///< at most `most_contours`; 0 leaves contours out
    double beam_offset =
        0.05; ///< from the outline of the part inwards to the outermost contour: half of the melt
    double distance = 0.1; ///< from each contour to the next one inwards
    ContourOrder order = ContourOrder::inside_out;
    bool before_hatch = false;
    StartPoint start = StartPoint::aligned;
    double start_direction_degrees = 90; ///< of StartPoint::aligned
    /// Of walls thinner than twice the beam's offset: of those, lines are for the ones that are at least so
    /// wide. They follow the outermost contour, as its hatches, two points each. Further contours have lines
    /// where they do not fit, and the innermost one also where a hatch leaves narrow places bare.
    ThinWalls thin_walls = ThinWalls::line;
    double thinnest = 0.05;
    ParameterSet parameters{.name = "contour", .power_w = 120, .speed_mm_s = 500};
};

/// A region of the layer that has less than `layers` layers of material above it, or below.
struct SkinRule {
    std::uint32_t layers = 0; ///< at most `most_skin_layers`; 0: there is no such region
    /// Strips that are narrower, to a hundredth, are none, whether along an edge, as grooves or as ribs:
    /// walls differ from layer to layer by roundings, and by their slope. By default as wide as a line.
    double narrowest = 0.1;
    double overlap = 0.1; ///< by which it is grown into the core
    HatchRule hatch;
};

/// All of what is a support, which need not be dense: by default wider lines, with less energy.
struct SupportRule {
    ContourRule contours{.parameters = {.name = "support", .power_w = 120, .speed_mm_s = 1000}};
    HatchRule hatch{.pattern = HatchPattern::meander,
                    .distance = 0.2,
                    .parameters = {.name = "support", .power_w = 120, .speed_mm_s = 1000}};
};

/// All of it. By default what makes sense for 316L steel and layers of 0.03 mm.
struct ScanStrategy {
    ContourRule contours;
    HatchRule hatch; ///< of the core
    SkinRule upskin{.hatch = {.parameters = {.name = "upskin", .power_w = 180, .speed_mm_s = 900}}};
    SkinRule downskin{.hatch = {.parameters = {.name = "downskin", .power_w = 120, .speed_mm_s = 1200}}};
    SupportRule support; ///< of parts that are supports, which have no skins
    std::uint64_t seed = 1;
    /// As much of a part's layer, in mm^2, may be out of reach of all vectors before somebody is told.
    double accepted_mm2 = 0.005;
};

/// How far inside of the outline of the part a contour is, of those counted from 1 at the outermost one.
[[nodiscard]] double contour_depth(const ContourRule& rule, std::uint32_t number) noexcept;
/// How far inside of it lines end.
[[nodiscard]] double hatch_depth(const ContourRule& contours, const HatchRule& rule) noexcept;

/// Throws Error{usage} that names the field for values out of range.
void check_strategy(const ScanStrategy& strategy);

/// What each layer of a part has, in the order in which it is executed.
[[nodiscard]] std::vector<Exposure> exposures(const ScanStrategy& strategy, const std::string& part);

/// The same of a part that is a support.
[[nodiscard]] std::vector<Exposure> support_exposures(const ScanStrategy& strategy, const std::string& part);

} // namespace lamella
LAMELLA_API_END

#include "lamella/scan/strategy_fields.hpp"

#include <array>

namespace lamella {

// The texts omit default values, which are printed from a default strategy.

std::span<const StrategyField<ContourRule>> contour_fields() noexcept {
    static constexpr std::array<StrategyField<ContourRule>, 9> fields{
        {{"count", "", "how many contours; 0 leaves them out", &ContourRule::count},
         {"beam_offset", "mm", "from the outline of the part inwards to the outermost contour",
          &ContourRule::beam_offset},
         {"distance", "mm", "from each contour to the next one inwards", &ContourRule::distance},
         {"order", "", "which of several comes first", &ContourRule::order},
         {"before_hatch", "", "contours before the hatch instead of after it", &ContourRule::before_hatch},
         {"start", "", "where the beam begins to follow a contour", &ContourRule::start},
         {"start_direction_degrees", "degrees", "of an aligned start: the corner that is farthest this way",
          &ContourRule::start_direction_degrees},
         {"thin_walls", "", "what becomes of walls thinner than twice the beam offset",
          &ContourRule::thin_walls},
         {"thinnest", "mm", "thinner walls have no line either", &ContourRule::thinnest}}};
    return fields;
}

std::span<const StrategyField<HatchRule>> hatch_fields() noexcept {
    static constexpr std::array<StrategyField<HatchRule>, 9> fields{
        {{"pattern", "", "how lines follow one another", &HatchRule::pattern},
         {"distance", "mm", "from line to line", &HatchRule::distance},
         {"angle_degrees", "degrees", "of the lines of layer 0, from the x axis to the y axis",
          &HatchRule::angle_degrees},
         {"turn_degrees", "degrees", "from each layer to the next", &HatchRule::turn_degrees},
         {"border", "mm", "from the innermost contour to where lines end", &HatchRule::border},
         {"shortest", "mm", "shorter lines are left out", &HatchRule::shortest},
         {"cell", "mm", "width of a stripe, a square or a hexagon", &HatchRule::cell},
         {"overlap", "mm", "of neighbouring stripes, squares or hexagons", &HatchRule::overlap},
         {"order", "", "in what order squares or hexagons are hatched", &HatchRule::order}}};
    return fields;
}

std::span<const StrategyField<SkinRule>> skin_fields() noexcept {
    static constexpr std::array<StrategyField<SkinRule>, 3> fields{
        {{"layers", "", "skin has less than this many layers of material above or below; 0: there is no skin",
          &SkinRule::layers},
         {"narrowest", "mm", "narrower strips are no skin, as walls differ from layer to layer",
          &SkinRule::narrowest},
         {"overlap", "mm", "by which skin is grown into the core", &SkinRule::overlap}}};
    return fields;
}

std::span<const StrategyField<ParameterSet>> parameter_fields() noexcept {
    static constexpr std::array<StrategyField<ParameterSet>, 7> fields{
        {{"power_w", "W", "of the beam", &ParameterSet::power_w},
         {"speed_mm_s", "mm/s", "along a line", &ParameterSet::speed_mm_s},
         {"jump_speed_mm_s", "mm/s", "from line to line, without the beam", &ParameterSet::jump_speed_mm_s},
         {"focus_mm", "mm", "how far the focus is above the layer", &ParameterSet::focus_mm},
         {"spot_mm", "mm", "diameter of the beam on the layer", &ParameterSet::spot_mm},
         {"mark_delay_us", "us", "after each line, or run of lines without a jump",
          &ParameterSet::mark_delay_us},
         {"jump_delay_us", "us", "after each jump", &ParameterSet::jump_delay_us}}};
    return fields;
}

std::span<const StrategyField<ScanStrategy>> strategy_fields() noexcept {
    static constexpr std::array<StrategyField<ScanStrategy>, 2> fields{
        {{"seed", "", "of all that is drawn by lot: random orders and starts", &ScanStrategy::seed},
         {"accepted_mm2", "mm2",
          "material of a layer that may be left without vectors; more is a warning, an error where jobs are "
          "strict",
          &ScanStrategy::accepted_mm2}}};
    return fields;
}

NamedValues<HatchPattern> named_values(HatchPattern) noexcept {
    static constexpr std::array values{HatchPattern::lines, HatchPattern::meander, HatchPattern::stripes,
                                       HatchPattern::chessboard, HatchPattern::hexagons};
    return {values, hatch_pattern_name};
}

NamedValues<IslandOrder> named_values(IslandOrder) noexcept {
    static constexpr std::array values{IslandOrder::rows, IslandOrder::random};
    return {values, island_order_name};
}

NamedValues<StartPoint> named_values(StartPoint) noexcept {
    static constexpr std::array values{StartPoint::aligned, StartPoint::sharpest, StartPoint::random};
    return {values, start_point_name};
}

NamedValues<ContourOrder> named_values(ContourOrder) noexcept {
    static constexpr std::array values{ContourOrder::inside_out, ContourOrder::outside_in};
    return {values, contour_order_name};
}

NamedValues<ThinWalls> named_values(ThinWalls) noexcept {
    static constexpr std::array values{ThinWalls::line, ThinWalls::leave_out};
    return {values, thin_walls_name};
}

} // namespace lamella

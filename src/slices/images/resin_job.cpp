#include "slices/images/resin_job.hpp"

#include "slices/images/resin_plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace lamella {

namespace {

constexpr double same_s = 1e-3; // files have single precision, or milliseconds

void keep_positive(double& value, double preset) {
    if (!(value > 0) || !std::isfinite(value))
        value = preset;
}

void keep_not_negative(double& value) {
    if (!(value >= 0) || !std::isfinite(value))
        value = 0;
}

PlateTravel usable_travel(PlateTravel travel) {
    const PlateTravel preset;
    keep_positive(travel.lift_mm_min, preset.lift_mm_min);
    keep_positive(travel.lift2_mm_min, preset.lift2_mm_min);
    keep_positive(travel.retract_mm_min, preset.retract_mm_min);
    keep_positive(travel.retract2_mm_min, preset.retract2_mm_min);
    for (double PlateTravel::*const member :
         {&PlateTravel::lift_mm, &PlateTravel::lift2_mm, &PlateTravel::retract2_mm,
          &PlateTravel::wait_before_lift_s, &PlateTravel::wait_after_lift_s,
          &PlateTravel::wait_after_retract_s})
        keep_not_negative(travel.*member);
    travel.retract2_mm = std::min(travel.retract2_mm, lift_mm_of(travel));
    return travel;
}

void keep_exposure(std::optional<double>& seconds) {
    if (seconds && (!(*seconds > 0) || !std::isfinite(*seconds)))
        seconds.reset();
}

/// Returns the number of layers above the bottom layers over which the exposure changes in equal steps; 0 if
/// it does not.
std::uint32_t transition_of(const ResinSettings& settings, std::span<const double> exposures_s) {
    const std::size_t bottom = settings.bottom_layers.value_or(0);
    if (!settings.exposure_s || !settings.bottom_exposure_s || bottom >= exposures_s.size())
        return 0;
    const double change = *settings.exposure_s - *settings.bottom_exposure_s;
    const double step = exposures_s[bottom] - *settings.bottom_exposure_s;
    const double steps = std::round(change / step);
    if (!(steps >= 2 && steps <= static_cast<double>(exposures_s.size() - bottom)))
        return 0;
    for (std::size_t i = 1; i <= static_cast<std::size_t>(steps); ++i)
        if (std::abs(*settings.bottom_exposure_s + static_cast<double>(i) / steps * change -
                     exposures_s[bottom + i - 1]) > same_s)
            return 0;
    return static_cast<std::uint32_t>(steps) - 1;
}

} // namespace

ResinSettings usable_settings(ResinSettings settings) {
    constexpr unsigned most_power = 255;
    keep_exposure(settings.exposure_s);
    keep_exposure(settings.bottom_exposure_s);
    settings.bottom_travel = usable_travel(settings.bottom_travel);
    settings.travel = usable_travel(settings.travel);
    keep_not_negative(settings.light_off_s);
    settings.light_power = std::min(settings.light_power, most_power);
    settings.bottom_light_power = std::min(settings.bottom_light_power, most_power);
    keep_positive(settings.density_g_ml, ResinSettings{}.density_g_ml);
    keep_not_negative(settings.price_per_litre);
    constexpr std::size_t longest_currency = 7;
    if (settings.currency.size() > longest_currency)
        settings.currency = ResinSettings{}.currency;
    return settings;
}

ResinSettings settings_of(const ResinJob& job, std::span<const Layer> planes) {
    ResinSettings settings = usable_settings(job.settings);
    settings.ranges.clear();
    if (const std::uint32_t layers = transition_of(settings, job.exposures_s); layers > 0)
        settings.transition_layers = layers;
    const ResinPlan plan(settings, {});
    const std::size_t layers = std::min(planes.size(), job.exposures_s.size());
    const double plate = planes.empty() ? 0 : planes.front().bottom;
    double last = 0; // exposure of the range that reaches up to this layer
    for (std::size_t i = 0; i < layers; ++i) {
        const double exposure = job.exposures_s[i];
        const double bottom = planes[i].bottom - plate;
        const double top = planes[i].top - plate;
        if (!(exposure > 0) || std::abs(plan.exposure_s(i, bottom + (top - bottom) / 2) - exposure) <= same_s)
            last = 0;
        else if (last > 0 && exposure == last)
            settings.ranges.back().to_mm = top;
        else
            settings.ranges.push_back({bottom, top, last = exposure});
    }
    return settings;
}

} // namespace lamella

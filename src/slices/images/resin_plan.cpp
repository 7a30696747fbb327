#include "slices/images/resin_plan.hpp"

#include "lamella/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string_view>

namespace lamella {

namespace {

[[noreturn]] void refuse_setting(std::string_view what, double value, std::string_view unit,
                                 std::string_view expected) {
    throw Error(ErrorKind::usage, fmt::format("{} of {} {}: choose {}", what, value, unit, expected));
}

void check_above_zero(double value, std::string_view what, std::string_view unit) {
    if (!(value > 0) || !std::isfinite(value))
        refuse_setting(what, value, unit, "a positive number");
}

void check_not_below_zero(double value, std::string_view what, std::string_view unit) {
    if (!(value >= 0) || !std::isfinite(value))
        refuse_setting(what, value, unit, "0 or a positive number");
}

void check_travel(const PlateTravel& travel) {
    check_not_below_zero(travel.lift_mm, "a lift", "mm");
    check_not_below_zero(travel.lift2_mm, "a second lift", "mm");
    check_not_below_zero(travel.retract2_mm, "a second retract", "mm");
    check_above_zero(travel.lift_mm_min, "a lift speed", "mm/min");
    check_above_zero(travel.lift2_mm_min, "a second lift speed", "mm/min");
    check_above_zero(travel.retract_mm_min, "a retract speed", "mm/min");
    check_above_zero(travel.retract2_mm_min, "a second retract speed", "mm/min");
    check_not_below_zero(travel.wait_before_lift_s, "a wait before the lift", "s");
    check_not_below_zero(travel.wait_after_lift_s, "a wait after the lift", "s");
    check_not_below_zero(travel.wait_after_retract_s, "a wait after the retract", "s");
    if (travel.retract2_mm > lift_mm_of(travel))
        refuse_setting("a second retract", travel.retract2_mm, "mm",
                       fmt::format("at most the {} mm of the lift", lift_mm_of(travel)));
}

void check_range(const ExposureRange& range) {
    check_above_zero(range.exposure_s, "an exposure of a range", "s");
    if (!(range.from_mm < range.to_mm))
        throw Error(ErrorKind::usage,
                    fmt::format("a range of heights from {} to {} mm: choose an end above its "
                                "beginning",
                                range.from_mm, range.to_mm));
}

void check_power(unsigned power) {
    if (power > 255)
        refuse_setting("a light power", power, "PWM", "a number from 0 to 255");
}

double travel_s(const PlateTravel& travel, double light_off_s) {
    const double moving_min = travel.lift_mm / travel.lift_mm_min + travel.lift2_mm / travel.lift2_mm_min +
                              retract_mm_of(travel) / travel.retract_mm_min +
                              travel.retract2_mm / travel.retract2_mm_min;
    const double waiting_s =
        travel.wait_before_lift_s + travel.wait_after_lift_s + travel.wait_after_retract_s;
    return 60 * moving_min + (light_off_s > 0 ? light_off_s : waiting_s);
}

} // namespace

PlateTravel in_one_stage(const PlateTravel& travel) {
    PlateTravel whole = travel;
    whole.lift_mm = lift_mm_of(travel);
    if (travel.lift2_mm > 0)
        whole.lift_mm_min = std::min(travel.lift_mm_min, travel.lift2_mm_min);
    if (travel.retract2_mm > 0)
        whole.retract_mm_min = std::min(travel.retract_mm_min, travel.retract2_mm_min);
    whole.lift2_mm = whole.retract2_mm = 0;
    return whole;
}

void check_resin_settings(const ResinSettings& settings) {
    check_above_zero(settings.exposure_s.value_or(1), "an exposure", "s");
    check_above_zero(settings.bottom_exposure_s.value_or(1), "a bottom exposure", "s");
    check_travel(settings.bottom_travel);
    check_travel(settings.travel);
    check_not_below_zero(settings.light_off_s, "a time without light", "s");
    check_power(settings.bottom_light_power);
    check_power(settings.light_power);
    check_above_zero(settings.density_g_ml, "a density", "g/ml");
    check_not_below_zero(settings.price_per_litre, "a price", "for a litre");
    if (settings.currency.size() > 7)
        throw Error(ErrorKind::usage,
                    fmt::format("a currency of {} bytes: choose one of at most 7", settings.currency.size()));
    for (const ExposureRange& range : settings.ranges)
        check_range(range);
}

ResinPlan::ResinPlan(const ResinSettings& settings, const ResinPrinter& printer)
    : settings_(settings), exposure_s_(settings.exposure_s.value_or(printer.exposure_s)),
      bottom_exposure_s_(settings.bottom_exposure_s.value_or(printer.bottom_exposure_s)),
      bottom_layers_(settings.bottom_layers.value_or(printer.bottom_layers)),
      transition_layers_(settings.transition_layers.value_or(printer.transition_layers)),
      small_pause_s_(printer.small_pause_s), large_pause_s_(printer.large_pause_s) {
    check_resin_settings(settings);
}

double ResinPlan::exposure_s(std::uint64_t layer, double middle_mm) const noexcept {
    for (std::size_t i = settings_.ranges.size(); i-- > 0;)
        if (const ExposureRange& range = settings_.ranges[i];
            range.from_mm <= middle_mm && middle_mm < range.to_mm)
            return range.exposure_s;
    if (layer < bottom_layers_)
        return bottom_exposure_s_;
    const std::uint64_t faded = layer - bottom_layers_ + 1;
    if (faded > transition_layers_)
        return exposure_s_;
    return bottom_exposure_s_ +
           static_cast<double>(faded) / (transition_layers_ + 1.0) * (exposure_s_ - bottom_exposure_s_);
}

double ResinPlan::layer_time_s(std::uint64_t layer, double exposure_s, bool large) const noexcept {
    if (small_pause_s_ > 0 || large_pause_s_ > 0)
        return exposure_s + (large ? large_pause_s_ : small_pause_s_);
    return exposure_s + travel_s(travel(layer), settings_.light_off_s);
}

std::string utc_text(std::int64_t seconds, std::string_view between) {
    using namespace std::chrono;
    const sys_seconds time{std::chrono::seconds(seconds)};
    const sys_days day = floor<days>(time);
    const year_month_day date(day);
    const hh_mm_ss clock(time - day);
    return fmt::format("{:04}-{:02}-{:02}{}{:02}:{:02}:{:02}", static_cast<int>(date.year()),
                       static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()), between,
                       clock.hours().count(), clock.minutes().count(), clock.seconds().count());
}

} // namespace lamella

#pragma once

// Exposure, movements and time of each layer in a printer.

#include "lamella/slices/resin_printer.hpp"
#include "lamella/slices/resin_settings.hpp"

#include <cstdint>
#include <string>

namespace lamella {

/// Returns a travel in one stage in each direction, at the lower of the two speeds.
[[nodiscard]] PlateTravel in_one_stage(const PlateTravel& travel);

/// Returns the length of both stages of the lift, which is that of the way back, too.
[[nodiscard]] inline double lift_mm_of(const PlateTravel& travel) noexcept {
    return travel.lift_mm + travel.lift2_mm;
}
/// Returns the length of the first stage of the way back.
[[nodiscard]] inline double retract_mm_of(const PlateTravel& travel) noexcept {
    return lift_mm_of(travel) - travel.retract2_mm;
}

/// Settings, completed by those of the printer.
class ResinPlan {
  public:
    /// Throws Error{usage} for settings that no printer could follow.
    ResinPlan(const ResinSettings& settings, const ResinPrinter& printer);

    [[nodiscard]] const ResinSettings& settings() const noexcept { return settings_; }
    [[nodiscard]] double exposure_s() const noexcept { return exposure_s_; }
    [[nodiscard]] double bottom_exposure_s() const noexcept { return bottom_exposure_s_; }
    [[nodiscard]] std::uint32_t bottom_layers() const noexcept { return bottom_layers_; }
    [[nodiscard]] std::uint32_t transition_layers() const noexcept { return transition_layers_; }

    /// Returns the exposure time of a layer, the first of which is layer 0, whose middle is at this height
    /// above the plate.
    [[nodiscard]] double exposure_s(std::uint64_t layer, double middle_mm) const noexcept;
    /// Returns the travel before and the power of the light in a layer.
    [[nodiscard]] const PlateTravel& travel(std::uint64_t layer) const noexcept {
        return layer < bottom_layers_ ? settings_.bottom_travel : settings_.travel;
    }
    [[nodiscard]] unsigned light_power(std::uint64_t layer) const noexcept {
        return layer < bottom_layers_ ? settings_.bottom_light_power : settings_.light_power;
    }
    /// Returns the time without light before an exposure, in which a printer without waits rests.
    [[nodiscard]] double rest_s(const PlateTravel& travel) const noexcept {
        return settings_.light_off_s > 0 ? settings_.light_off_s : travel.wait_after_retract_s;
    }
    /// Returns the time that a layer takes with this exposure. `large` is true if it covers
    /// more than ResinPrinter::large_area of the display.
    [[nodiscard]] double layer_time_s(std::uint64_t layer, double exposure_s, bool large) const noexcept;

    [[nodiscard]] double mass_g(double volume_ml) const noexcept {
        return volume_ml * settings_.density_g_ml;
    }
    [[nodiscard]] double price(double volume_ml) const noexcept {
        return volume_ml * settings_.price_per_litre / 1000;
    }

  private:
    ResinSettings settings_;
    double exposure_s_;
    double bottom_exposure_s_;
    std::uint32_t bottom_layers_;
    std::uint32_t transition_layers_;
    double small_pause_s_;
    double large_pause_s_;
};

/// Returns a time such as "2026-11-30 16:00:00", in UTC, with this text between date and clock.
[[nodiscard]] std::string utc_text(std::int64_t seconds, std::string_view between);

} // namespace lamella

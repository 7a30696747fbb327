#pragma once

// Collects the layers of a Common Layer Interface file from the commands of its geometry section.

#include "lamella/contour/exposure.hpp"
#include "lamella/contour/layer.hpp"
#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/slices/layer_file.hpp"

#include "core/executor.hpp"
#include "core/farthest.hpp"
#include "slices/engine/common_layer_format.hpp"
#include "slices/engine/slice_engine.hpp"
#include "slices/formats/common_layer_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace lamella {

/// Returns the direction with this number, or none if there is no such direction.
[[nodiscard]] constexpr std::optional<CommonLayerDirection> common_layer_direction(std::int64_t number) {
    if (number < 0 || number > 2)
        return std::nullopt;
    return static_cast<CommonLayerDirection>(number);
}

/// The permitted values, for the error about any other number.
inline constexpr const char* common_layer_directions =
    "it must be 0 (clockwise), 1 (counter-clockwise) or 2 (open)";

/// Finds the largest number of decimals of the numbers in a file.
class Decimals {
  public:
    void note(double number) noexcept {
        if (places_ == steps.size() - 1 || is_whole(number / steps[places_]))
            return;
        std::size_t needed = 0;
        while (needed < steps.size() - 1 && !is_whole(number / steps[needed]))
            ++needed;
        places_ = std::max(places_, needed);
    }
    /// Adds the numbers of another piece of the file.
    void add(const Decimals& other) noexcept { places_ = std::max(places_, other.places_); }
    /// Returns the unit of the last decimal: 1, 0.1 and so on; 0 if there are more decimals than supported.
    [[nodiscard]] double step() const noexcept { return steps[places_]; }

  private:
    static constexpr std::array steps{1.0, 0.1, 0.01, 0.001, 1e-4, 1e-5, 0.0};

    /// Tolerates the binary rounding of decimal fractions. May return false for numbers beyond 2^51.
    static bool is_whole(double number) noexcept {
        constexpr double no_fractions = 0x1.8p52;
        return std::abs(number - ((number + no_fractions) - no_fractions)) <= 1e-5;
    }

    std::size_t places_ = 0;
};

/// Exposure settings of the non-standard commands of CLI+. They apply to the vectors that follow, until they
/// are changed.
struct BeamSettings {
    std::optional<double> power_w;
    std::optional<double> speed_mm_s;
    std::optional<double> focus_mm;

    /// Stands for a setting that is made before a piece of the file begins.
    static constexpr double inherited = -std::numeric_limits<double>::infinity();
    static constexpr BeamSettings all_inherited() noexcept { return {inherited, inherited, inherited}; }
    /// Returns these settings if those before the piece are `before`.
    [[nodiscard]] BeamSettings after(const BeamSettings& before) const noexcept {
        const auto of = [](const std::optional<double>& own, const std::optional<double>& other) {
            return own == inherited ? other : own;
        };
        return {of(power_w, before.power_w), of(speed_mm_s, before.speed_mm_s),
                of(focus_mm, before.focus_mm)};
    }

    [[nodiscard]] bool any() const noexcept { return power_w || speed_mm_s || focus_mm; }
    friend bool operator==(const BeamSettings&, const BeamSettings&) = default;
    friend bool operator<(const BeamSettings& a, const BeamSettings& b) noexcept {
        return std::tie(a.power_w, a.speed_mm_s, a.focus_mm) < std::tie(b.power_w, b.speed_mm_s, b.focus_mm);
    }
};

/// Key of a part of the result, which is a part of the file or, if the file specifies exposures, the vectors
/// of a part that have the same kind and settings.
struct CommonLayerPart {
    std::int64_t number = 0;
    BeamSettings beam = {};
    VectorKind kind = VectorKind::contour; ///< of vectors with settings

    friend bool operator==(const CommonLayerPart&, const CommonLayerPart&) = default;
    friend bool operator<(const CommonLayerPart& a, const CommonLayerPart& b) noexcept {
        return std::tie(a.number, a.beam, a.kind) < std::tie(b.number, b.beam, b.kind);
    }
};

/// The settings before a layer.
struct LayerBeam {
    std::size_t begin = 0; ///< offset of the layer
    BeamSettings beam = {};
};

/// Collects the contents of a piece of the geometry section, in either coding.
class CommonLayerGeometry {
  public:
    /// `beam` are the settings before the piece.
    CommonLayerGeometry(const CommonLayerHeader& header, const std::string& name, ReadLimits& limits,
                        const BeamSettings& beam = BeamSettings::all_inherited())
        : units_(header.units_mm), name_(name), limits_(limits), beam_(beam), parts_(limits) {}

    /// Appends the contents of the next piece.
    void append(CommonLayerGeometry&& piece) {
        parts_.add(
            piece.parts_, piece.layers,
            [&](const CommonLayerPart& part) {
                const BeamSettings beam = part.beam.after(beam_);
                return CommonLayerPart{part.number, beam, beam.any() ? part.kind : VectorKind::contour};
            },
            [] { return std::string_view("the geometry"); });
        for (const auto& [begin, beam] : piece.beams_)
            note_beam(begin, beam.after(beam_));
        beam_ = piece.beam_.after(beam_);
        append_layers(layers, std::move(piece.layers), limits_);
        end = piece.end;
        decimals_.add(piece.decimals_);
        found_.add(piece.found_);
    }

    /// Takes a non-standard command, with its number if it has one. Commands that set the exposure apply to
    /// the vectors that follow; others are skipped and counted.
    template <class Location>
    void take_setting(std::string_view command, std::optional<double> number, const Location& location) {
        const bool usable = number && !is_too_far(*number) && (*number >= 0 || command == "FOCUS");
        std::optional<double>* const setting = command == "POWER"   ? &beam_.power_w
                                               : command == "SPEED" ? &beam_.speed_mm_s
                                               : command == "FOCUS" ? &beam_.focus_mm
                                                                    : nullptr;
        if (setting == nullptr || !usable) {
            found_.note(FindingKind::unknown_commands,
                        [&] { return fmt::format("{}, $${}", location(), excerpt(command)); });
            if (setting != nullptr)
                setting->reset();
            return;
        }
        *setting = *number + 0.0;
    }

    /// `begin` is the offset of the layer in the file.
    void start_layer(std::size_t begin, double units, std::string location) {
        note_beam(begin, beam_);
        const double z = in_mm(units, location);
        limits_.make_room(layers, 1, [&] { return std::string_view(location); });
        layers.emplace_back();
        layers.back().z = z;
        layers.back().location = std::move(location);
        layers.back().begin = begin;
    }
    [[nodiscard]] bool in_layer() const { return !layers.empty(); }
    /// Reserves memory for ends of hatch lines, or for points of a polyline, and returns the list to which
    /// they must be added.
    template <class Location>
    std::vector<Point2>& expect_points(bool hatches, std::uint64_t count, const Location& location) {
        RawLayer& layer = layers.back();
        std::vector<Point2>& points = hatches ? layer.hatches : layer.points;
        limits_.make_room(points, count, location);
        layer.drawn = layer.drawn || count != 0;
        return points;
    }
    void add_point(std::vector<Point2>& to, double x, double y) {
        const std::string& location = layers.back().location;
        decimals_.note(x);
        decimals_.note(y);
        to.push_back({in_mm(x, location) + 0.0, in_mm(y, location) + 0.0});
    }
    template <class Location>
    void end_hatches(std::int64_t part, const Location& location) {
        layers.back().end_hatches(number_of(part, VectorKind::hatch, location), limits_, location);
    }

    /// Ends a polyline with the given direction.
    template <class Location>
    void end_polyline(std::int64_t part, CommonLayerDirection direction, const Location& location) {
        RawLayer& layer = layers.back();
        const std::size_t begin = layer.contour_begin();
        const bool returns = layer.returns();
        const bool returning_chain = direction == CommonLayerDirection::open && layer.is_returning_chain();
        const bool closed = direction != CommonLayerDirection::open || returning_chain;
        if (!layer.end_contour(closed, number_of(part, VectorKind::contour, location), limits_, location,
                               found_) ||
            !closed)
            return;
        if (returning_chain) {
            found_.note(FindingKind::returning_chains, location);
            return;
        }
        if (!returns)
            found_.note(FindingKind::unclosed_rings, location);
        // If the points run in the opposite direction, the stated direction prevails.
        const std::span<Point2> ring = std::span(layer.points).subspan(begin);
        const double area = ring_area(ring);
        if (direction == CommonLayerDirection::counter_clockwise ? area < 0 : area > 0) {
            std::reverse(ring.begin(), ring.end());
            found_.note(FindingKind::reversed_by_direction, location);
        }
    }

    /// Puts the parts into `file` in the order of their numbers, including parts that only have a label, and
    /// returns their keys.
    std::vector<CommonLayerPart> number_parts(const CommonLayerHeader& header, LayerFile& file) {
        const auto at_end = [] {
            return std::string_view("the end");
        };
        for (const auto& [number, label] : header.labels)
            if (const CommonLayerPart* const known = parts_.first_from({number});
                known == nullptr || known->number != number)
                parts_.number_of({number}, at_end);
        if (parts_.empty())
            parts_.number_of({1}, at_end);
        ReadLabels labels;
        std::vector<CommonLayerPart> parts;
        parts_.put(file, layers, [&](const CommonLayerPart& part) {
            parts.push_back(part);
            const auto label = header.labels.find(part.number);
            return PartInfo{.label = label == header.labels.end() ? std::string() : labels.of(label->second)};
        });
        labels.append_to(file.warnings);
        return parts;
    }

    /// Returns the only layer of a piece that is read again, with indices of these parts, which are those of
    /// the file. This is the geometry of the file.
    [[nodiscard]] RawLayer layer_again(CommonLayerGeometry&& piece, const CommonLayerHeader& header,
                                       const std::vector<CommonLayerPart>& parts) const {
        const auto later =
            std::upper_bound(beams_.begin(), beams_.end(), piece.layers.front().begin,
                             [](std::size_t at, const LayerBeam& beam) { return at < beam.begin; });
        CommonLayerGeometry whole(header, piece.name_, piece.limits_,
                                  later == beams_.begin() ? BeamSettings{} : std::prev(later)->beam);
        whole.append(std::move(piece));
        RawLayer layer = only_layer(std::move(whole.layers));
        whole.parts_.put(layer, parts);
        return layer;
    }

    /// Returns the rounding of the coordinates. Not all files use whole units; numbers of single precision
    /// that are not whole have many meaningless decimals.
    [[nodiscard]] Rounding rounding(bool single_precision) const noexcept {
        const bool known = !single_precision || decimals_.step() == 1;
        return {known ? units_ * decimals_.step() : 0, single_precision};
    }

    [[nodiscard]] const Findings& found() const { return found_; }

    std::vector<RawLayer> layers;
    std::size_t end = 0; ///< offset at which the piece ends

  private:
    void note_beam(std::size_t begin, const BeamSettings& beam) {
        if (limits_.in_memory() || beam == (beams_.empty() ? BeamSettings{} : beams_.back().beam))
            return;
        limits_.make_room(beams_, 1, at_byte(begin));
        beams_.push_back({begin, beam});
    }
    template <class Location>
    std::uint32_t number_of(std::int64_t part, VectorKind kind, const Location& location) {
        return parts_.number_of({part, beam_, kind}, location);
    }
    [[nodiscard]] double in_mm(double units, const std::string& location) const {
        const double mm = units * units_;
        if (is_too_far(mm))
            throw Error(ErrorKind::input,
                        fmt::format("{}, layer at {}: found {} units of {} mm; heights and coordinates must "
                                    "lie within {} mm",
                                    name_, location, units, units_, farthest_mm));
        return mm;
    }

    double units_;
    const std::string& name_;
    ReadLimits& limits_;
    BeamSettings beam_; ///< of the vectors that follow
    /// Settings before layers, with the offset of the first layer that each applies to. Not listed are those
    /// before which there is no setting.
    std::vector<LayerBeam> beams_;
    Decimals decimals_;
    PartNumbers<CommonLayerPart> parts_;
    Findings found_;
};

/// Reads a piece of an ASCII file, from `begin`, which is on this line, up to the first layer at or after
/// `limit`. Errors state the line.
[[nodiscard]] CommonLayerGeometry read_ascii_piece(std::string_view bytes, const std::string& name,
                                                   const CommonLayerHeader& header, std::size_t begin,
                                                   std::size_t limit, std::uint64_t line,
                                                   const Reading& reading);
/// Returns where pieces of an ASCII file begin.
[[nodiscard]] TextPieces ascii_pieces(std::string_view bytes, const std::string& name,
                                      const CommonLayerHeader& header, Executor& executor);

/// The same for binary files; errors state the offset.
[[nodiscard]] CommonLayerGeometry read_binary_piece(std::string_view bytes, const std::string& name,
                                                    const CommonLayerHeader& header, std::size_t begin,
                                                    std::size_t limit, const Reading& reading);
[[nodiscard]] PieceBegins binary_pieces(std::string_view bytes, const CommonLayerHeader& header);

} // namespace lamella

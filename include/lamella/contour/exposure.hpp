#pragma once

// What a machine is told of vectors besides where they are, and what they take: lengths, time, energy.

#include "lamella/contour/layer.hpp"
#include "lamella/core/point.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

LAMELLA_API_BEGIN
namespace lamella {

/// Of what vectors are, in a layer of a part.
enum class ScanRegion : std::uint8_t {
    core,
    upskin,   ///< with no material above, or little
    downskin, ///< with no material below, or little
    support,
};

/// "core", "upskin", "downskin", "support".
[[nodiscard]] std::string_view scan_region_name(ScanRegion region) noexcept;

enum class VectorKind : std::uint8_t {
    contour, ///< vectors one after the other, along the outline
    hatch,   ///< apart from one another, to fill the inside
};

/// "contour", "hatch".
[[nodiscard]] std::string_view vector_kind_name(VectorKind kind) noexcept;

/// What a beam does along vectors and between them. Called by its name in files and by machines. The values
/// preset are those that a strategy begins with: for the hatch of 316L steel, layers of 0.03 mm; a place to
/// begin at, not a promise for a certain machine.
struct ParameterSet {
    std::string name = "hatch";
    double power_w = 200;
    double speed_mm_s = 800;
    double jump_speed_mm_s = 5000;
    double focus_mm = 0;        ///< how far the focus is above the layer
    double spot_mm = 0.08;      ///< diameter of the beam on the layer
    double mark_delay_us = 100; ///< after each line, or run of lines without a jump
    double jump_delay_us = 100; ///< after each jump

    friend bool operator==(const ParameterSet&, const ParameterSet&) = default;
};

/// Those of vectors that nothing is known of but where they are: without a name, all 0.
[[nodiscard]] ParameterSet unknown_parameters();

/// What the vectors of one part on one layer have in common that a machine executes in one go. Slice files
/// have it as a part of their own: layers with rings and chains for contours, with hatches for a hatch.
struct Exposure {
    std::string part = "part"; ///< its label
    ScanRegion region = ScanRegion::core;
    VectorKind kind = VectorKind::contour;
    std::uint32_t contour = 0; ///< its number, of the outermost one 1; 0 for hatches
    ParameterSet parameters;

    /// Such as "core contour 1" and "upskin hatch".
    [[nodiscard]] std::string name() const;
    /// The part and the name: "bracket core contour 1".
    [[nodiscard]] std::string label() const;
};

/// What a label says, the other way round: for formats that have nothing else to say it with. Its parameters
/// are unknown.
[[nodiscard]] std::optional<Exposure> labelled_exposure(std::string_view label);

/// What a machine does for vectors.
struct ScanFigures {
    std::uint64_t vectors = 0;
    double marked_mm = 0;
    double jumped_mm = 0;
    double build_seconds =
        0; ///< by the speeds and delays of the parameter sets alone: what accelerates is left out
    double energy_j = 0; ///< power by the time of marking
    double unreached_mm2 =
        0; ///< material that these vectors are for, and that no vector of the layer reaches

    ScanFigures& operator+=(const ScanFigures& other) noexcept;
};

/// Of vectors executed one after the other with one parameter set, from where the beam was before, and that
/// is moved to where it ends. Some files do not tell all speeds, and have 0 instead: what goes at such a
/// speed counts as if it took no time. O(vectors).
[[nodiscard]] ScanFigures measure_vectors(const Layer& vectors, const ParameterSet& parameters,
                                          std::optional<Point2>& beam);

} // namespace lamella
LAMELLA_API_END

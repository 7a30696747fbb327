#pragma once

// Scan vectors, their parameters for the machine, their lengths, time and energy.

#include "lamella/contour/layer.hpp"
#include "lamella/core/point.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// The region of a layer of a part to which vectors belong.
enum class ScanRegion : std::uint8_t {
    core,
    upskin,   ///< with little or no material above
    downskin, ///< with little or no material below
    support,
};

/// Returns "core", "upskin", "downskin" or "support".
[[nodiscard]] std::string_view scan_region_name(ScanRegion region) noexcept;

enum class VectorKind : std::uint8_t {
    contour, ///< consecutive vectors along the outline
    hatch,   ///< separate vectors that fill the inside
};

/// Returns "contour" or "hatch".
[[nodiscard]] std::string_view vector_kind_name(VectorKind kind) noexcept;

/// Parameters of the beam along vectors and between them. Files and machines refer to a set by its name. The
/// default values suit the hatch of 316L steel in layers of 0.03 mm. They are a starting point, not a
/// recommendation for a particular machine.
struct ParameterSet {
    std::string name = "hatch";
    double power_w = 200;
    double speed_mm_s = 800;
    double jump_speed_mm_s = 5000;
    double focus_mm = 0;        ///< height of the focus above the layer
    double spot_mm = 0.08;      ///< diameter of the beam on the layer
    double mark_delay_us = 100; ///< after each polyline: consecutive lines without a jump
    double jump_delay_us = 100; ///< after each jump

    friend bool operator==(const ParameterSet&, const ParameterSet&) = default;
};

/// Returns parameters for vectors of unknown parameters: no name, and all values 0.
[[nodiscard]] ParameterSet unknown_parameters();

/// Properties of the vectors of one part that a machine executes together, with the same parameters.
struct Exposure {
    std::string part = "part"; ///< label of the part
    ScanRegion region = ScanRegion::core;
    VectorKind kind = VectorKind::contour;
    std::uint32_t contour = 0; ///< number of the contour; 1 for the outermost, 0 for hatches
    ParameterSet parameters;

    /// Returns a name such as "core contour 1" or "upskin hatch".
    [[nodiscard]] std::string name() const;
    /// Returns the part and the name: "bracket core contour 1".
    [[nodiscard]] std::string label() const;
};

/// Parses a label, as the inverse of `label`, for formats that store nothing else. The parameters are
/// `unknown_parameters`. Returns nullopt for any other text.
[[nodiscard]] std::optional<Exposure> labelled_exposure(std::string_view label);

/// Lengths, time and energy that a machine needs for vectors.
struct ScanFigures {
    std::uint64_t vectors = 0;
    double marked_mm = 0;
    double jumped_mm = 0;
    /// Time from the speeds and delays of the parameter sets; acceleration is not considered.
    double build_seconds = 0;
    double energy_j = 0;      ///< power times marking time
    double unreached_mm2 = 0; ///< material that these vectors should scan, but no vector of the layer reaches

    ScanFigures& operator+=(const ScanFigures& other) noexcept;
};

struct MeasuredVectors {
    ScanFigures figures;
    std::optional<Point2> beam; ///< position of the beam after the last vector
};

/// Measures vectors executed one after the other with one parameter set: polylines, then hatch lines. `beam`
/// is the position before the first vector. A speed of 0 means that the file does not specify it; such moves
/// take no time. O(vectors).
[[nodiscard]] MeasuredVectors measure_vectors(const Layer& polylines, std::span<const Point2> hatches,
                                              const ParameterSet& parameters,
                                              std::optional<Point2> beam = {});

} // namespace lamella
LAMELLA_API_END

#pragma once

// The header of a Common Layer Interface file. It is text, even in binary files.

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

inline constexpr std::string_view common_layer_start = "$$HEADERSTART";

class ReadLimits;

/// Contents of the header.
struct CommonLayerHeader {
    bool binary = false;
    double units_mm = 0;
    bool aligned = false;
    std::map<std::int64_t, std::string> labels;     ///< labels of the parts by their numbers, as written
    std::optional<std::array<double, 6>> dimension; ///< mm
    std::optional<std::uint64_t> layers;
    std::size_t end = 0;               ///< offset after $$HEADEREND
    std::vector<std::string> warnings; ///< about skipped commands
};

/// Reads the header of a file that has one. Throws Error{input} with the line, and Error{limit}.
[[nodiscard]] CommonLayerHeader read_common_layer_header(std::string_view bytes, const std::string& name,
                                                         ReadLimits& limits);

} // namespace lamella

#pragma once

// The geometry commands of the Common Layer Interface, for its reader and its writer.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

namespace lamella {

/// Commands of the binary form. Short commands have 16-bit numbers, long ones 32-bit integers and floats.
enum class CommonLayerCommand : std::uint16_t {
    layer_long = 127,
    layer_short = 128,
    polyline_short = 129,
    polyline_long = 130,
    hatches_short = 131,
    hatches_long = 132,
};

/// Returns the size in bytes of the command at the beginning of `bytes`. 16-bit numbers take two bytes each,
/// or four if the file is aligned, except coordinates. Returns nullopt if there is no command or if it is
/// truncated.
[[nodiscard]] inline std::optional<std::uint64_t> common_layer_command_size(std::string_view bytes,
                                                                            bool aligned = false) noexcept {
    const auto number = [&]<class T>(std::size_t at, T value) -> std::uint64_t {
        if (bytes.size() < at + sizeof value)
            return bytes.size(); // the number is truncated
        std::memcpy(&value, bytes.data() + at, sizeof value);
        return value;
    };
    const std::size_t word = aligned ? 4 : 2;
    std::uint64_t size = 0;
    switch (static_cast<CommonLayerCommand>(number(0, std::uint16_t{}))) {
    case CommonLayerCommand::layer_long:
        size = word + 4;
        break;
    case CommonLayerCommand::layer_short:
        size = 2 * word;
        break;
    case CommonLayerCommand::polyline_long:
        size = word + 12 + 8 * number(word + 8, std::uint32_t{});
        break;
    case CommonLayerCommand::polyline_short:
        size = 4 * word + 4 * number(3 * word, std::uint16_t{});
        break;
    case CommonLayerCommand::hatches_long:
        size = word + 8 + 16 * number(word + 4, std::uint32_t{});
        break;
    case CommonLayerCommand::hatches_short:
        size = 3 * word + 8 * number(2 * word, std::uint16_t{});
        break;
    default:
        return std::nullopt;
    }
    return size <= bytes.size() ? std::optional(size) : std::nullopt;
}

/// Direction of a polyline; both forms use these numbers.
enum class CommonLayerDirection : std::uint8_t { clockwise = 0, counter_clockwise = 1, open = 2 };

} // namespace lamella

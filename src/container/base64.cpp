#include "container/base64.hpp"

#include <cstdint>

namespace lamella {

void append_base64(std::string_view bytes, std::string& out) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const auto byte = [&](std::size_t i) -> std::uint32_t {
        return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0;
    };
    std::size_t at = out.size();
    out.resize(at + base64_size(bytes.size()), '=');
    for (std::size_t i = 0; i < bytes.size(); i += 3, at += 4) {
        const std::uint32_t three = byte(i) << 16U | byte(i + 1) << 8U | byte(i + 2);
        out[at] = digits[three >> 18U];
        out[at + 1] = digits[three >> 12U & 63U];
        if (i + 1 < bytes.size())
            out[at + 2] = digits[three >> 6U & 63U];
        if (i + 2 < bytes.size())
            out[at + 3] = digits[three & 63U];
    }
}

} // namespace lamella

// Any bytes as a slice file: an error of the input kind, or layers in normal form that can be checked and
// written.

#include "promises.hpp"

#include <span>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lamella;
    try {
        fuzz::require_sound(read_layers(std::as_bytes(std::span(data, size)), "fuzz", {.threads = 1}));
    } catch (const Error& error) {
        fuzz::require(error.kind() == ErrorKind::input);
    }
    return 0;
}

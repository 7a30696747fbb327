// Any bytes as a slice file: an error of the input kind or a limit that is met, or layers in normal form that
// can be checked and written.

#include "promises.hpp"

#include <span>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lamella;
    try {
        fuzz::require_sound(read_layers(std::as_bytes(std::span(data, size)), "fuzz",
                                        {.max_memory = 100'000'000}, {.threads = 1}));
    } catch (const Error& error) {
        fuzz::require(error.kind() == ErrorKind::input || error.kind() == ErrorKind::limit);
    }
    return 0;
}

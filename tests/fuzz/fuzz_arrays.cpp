// Any bytes as the arrays of layers of a NumPy archive, behind its checksums: an error of the input kind or a
// limit that is met, or sound layers.

#include "archive.hpp"
#include "promises.hpp"

#include <span>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lamella;
    const std::string bytes = fuzz::archive_of(
        {reinterpret_cast<const char*>(data), size},
        {"points.npy", "offsets.npy", "closed.npy", "layer.npy", "part.npy", "index.npy", "z.npy",
         "bottom.npy", "top.npy", "labels.npy", "hatches.npy", "hatch_layer.npy", "hatch_part.npy"});
    try {
        fuzz::require_sound(read_layers(std::as_bytes(std::span(bytes)), "fuzz", {.max_memory = 100'000'000},
                                        {.threads = 1}));
    } catch (const Error& error) {
        fuzz::require(error.kind() == ErrorKind::input || error.kind() == ErrorKind::limit);
    }
    return 0;
}

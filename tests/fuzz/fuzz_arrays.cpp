// Any bytes as the arrays of layers of a NumPy archive, behind its checksums: an error of the input kind or a
// limit that is met, or sound layers. Each array has its length in front, two bytes, the lower one first.

#include "archive.hpp"
#include "promises.hpp"

#include <algorithm>
#include <span>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lamella;
    std::string_view rest(reinterpret_cast<const char*>(data), size);
    fuzz::Archive archive;
    for (const char* name : {"points", "offsets", "closed", "layer", "part", "index", "z", "bottom", "top",
                             "labels", "hatches", "hatch_layer", "hatch_part"}) {
        if (rest.size() < 2)
            break;
        const auto low = static_cast<unsigned char>(rest[0]);
        const auto high = static_cast<unsigned char>(rest[1]);
        rest.remove_prefix(2);
        const std::string_view array = rest.substr(0, low + 256U * high);
        archive.add(std::string(name) + ".npy", array);
        rest.remove_prefix(array.size());
    }
    const std::string bytes = archive.take();
    try {
        fuzz::require_sound(read_layers(std::as_bytes(std::span(bytes)), "fuzz", {.max_memory = 100'000'000},
                                        {.threads = 1}));
    } catch (const Error& error) {
        fuzz::require(error.kind() == ErrorKind::input || error.kind() == ErrorKind::limit);
    }
    return 0;
}

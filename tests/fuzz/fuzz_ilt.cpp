// Any bytes as the files of an ILT archive, behind its checksums: an error of the input kind or a limit that
// is met, or sound scan vectors.

#include "archive.hpp"
#include "promises.hpp"

#include <span>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lamella;
    const std::string bytes = fuzz::archive_of({reinterpret_cast<const char*>(data), size},
                                               {"modelsection_param.txt", "modelsection_001_s1_vs.cli",
                                                "modelsection_001_s1_vk.cli", "modelsection_002_st_vs.cli"});
    try {
        fuzz::require_sound(read_layers(std::as_bytes(std::span(bytes)), "fuzz", {.max_memory = 100'000'000},
                                        {.threads = 1}));
    } catch (const Error& error) {
        fuzz::require(error.kind() == ErrorKind::input || error.kind() == ErrorKind::limit);
    }
    return 0;
}

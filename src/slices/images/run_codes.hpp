#pragma once

// The codes of images in the files of resin printers (see docs/formats.md).

#include "slices/images/run_builder.hpp"
#include "slices/images/run_encoder.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lamella {

/// Elegoo .goo: 8 bits of grey, with a checksum. Runs are never written as differences.
[[nodiscard]] const RunCode& goo_runs();
/// Chitubox .ctb: 7 bits of grey. Runs are formed of values with 8 bits, as CHITUBOX does.
[[nodiscard]] const RunCode& ctb_runs();
/// Anycubic "pw0": 4 bits of grey.
[[nodiscard]] const RunCode& pw0_runs();
/// Chitubox .cbddlp: pixels of at least this value are white, the others black.
[[nodiscard]] RunCode bit_runs(std::uint8_t threshold);

/// Encrypts or decrypts the image of a layer of a .ctb file, in place. The layers count from 0. Key 0 changes
/// nothing.
void apply_ctb_cipher(std::uint32_t key, std::uint64_t layer, char* bytes, std::size_t size) noexcept;

/// The place in a code that breaks its rules.
struct RunFault {
    std::size_t at = 0; ///< position in the code
    std::string found = {};
    std::string expected = {};
};

/// Decodes the image in these bytes, and returns the first fault. Runs may end before the last pixel.
using DecodeRuns = std::optional<RunFault>(std::string_view bytes, RunBuilder& image);

/// These decode what is encoded by the codes above, in the values that a printer shows; .goo also with runs
/// as differences. `decode_bit_runs` gives 255 for white.
DecodeRuns decode_goo_runs;
DecodeRuns decode_ctb_runs;
DecodeRuns decode_pw0_runs;
DecodeRuns decode_bit_runs;

} // namespace lamella

#pragma once

// The codes of images in the files of resin printers (see docs/formats.md).

#include "slices/images/run_encoder.hpp"

#include <cstddef>
#include <cstdint>

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

} // namespace lamella

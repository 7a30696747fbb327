#pragma once

// Slice files of consecutive layers, put together to one.

#include "lamella/core/execution.hpp"
#include "lamella/read/layer_file.hpp"
#include "lamella/write/layer_writer.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

struct MergeResult {
    std::string format; ///< of the files that were read
    std::uint64_t layers = 0;
    double bottom = 0;       ///< of the first layer
    double top = 0;          ///< of the last one
    std::uint64_t bytes = 0; ///< written
    /// What was odd about the files where they are written anew, and rings of them that bound no material.
    /// Each line begins with the path of the file.
    std::vector<std::string> file_warnings;
    std::vector<std::string> warnings; ///< what the format has no place for
};

/// Merges slice files of one format whose layers lie on one another, such as the shards of one job; they may
/// come in any order. Files of the Common Layer Interface are put together as they are when that is the
/// format written, too (`options` do not count then): the result is, byte for byte, the file of a single run.
/// Layers of other formats are read and written anew. Memory holds one of the files at a time.
///
/// `format`: by name; "" goes by the extension of `output`. Throws Error{input} when files differ in their
/// parts (but formats of scan vectors know only parts that have something), the parameters of a part, their
/// units or their head, when one begins above the end of the one below it (a layer gap) or below it (an
/// overlap), naming both; for files that are put together as they are and whose reading met anything odd;
/// Error{usage} for what can be read once only, such as pipes, and where `output` is there and holds layers
/// that adjoin those of the files: it is one of them; and what reading and writing throw.
MergeResult merge_layer_files(std::span<const std::string> paths, const std::string& output,
                              std::string_view format = {}, const LayerWriteOptions& options = {},
                              const LayerReadOptions& reading = {}, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END

#pragma once

// Merges slice files of consecutive layers into one.

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
    /// Warnings about files that are rewritten, and about their rings that bound no material. Each line
    /// begins with the path of the file.
    std::vector<std::string> file_warnings;
    std::vector<std::string> warnings; ///< content that the format cannot hold
};

/// Merges slice files of one format with adjoining layers, such as the shards of one job; they may be in any
/// order. Layers of the Common Layer Interface are copied unchanged if that is also the output format
/// (`options` then have no effect): the result is, byte for byte, the file of a single run. Layers of other
/// formats are read and rewritten. Memory holds one of the files at a time.
///
/// `format` is a name; "" selects by the extension of `output`. Throws
///
/// - Error{input}, naming both files, if they differ in their parts (formats of scan vectors list only parts
///   that are not empty), the parameters of a part, units or header, or if one begins above the end of the
///   one below it (a layer gap) or below it (an overlap);
/// - Error{input} for files to be copied whose reading gives a warning;
/// - Error{usage} for inputs that can be read only once, such as pipes, and if `output` exists and its layers
///   adjoin those of the files, since it then is one of them;
/// - the errors of reading and writing.
MergeResult merge_layer_files(std::span<const std::string> paths, const std::string& output,
                              std::string_view format = {}, const LayerWriteOptions& options = {},
                              const LayerReadOptions& reading = {}, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END

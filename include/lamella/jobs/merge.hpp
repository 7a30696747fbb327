#pragma once

// Merges slice files of consecutive layers into one.

#include "lamella/core/execution.hpp"
#include "lamella/slices/layer_file.hpp"
#include "lamella/slices/layer_writer.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

struct MergeOptions {
    std::string_view format = {}; ///< name of the output format; if "", the extension selects the format
    LayerWriteOptions writing = {};
    LayerReadOptions reading = {};
};

struct MergeResult {
    std::string format; ///< of the files that were read
    std::uint64_t layers = 0;
    double bottom = 0;       ///< of the first layer
    double top = 0;          ///< of the last one
    std::uint64_t bytes = 0; ///< written
    /// Warnings about files that are rewritten, and about their rings that bound no material. Each line
    /// begins with the path of the file.
    std::vector<std::string> file_warnings;
    Findings losses; ///< content that the format cannot represent; see LayerWriter::findings
};

/// Merges slice files of one format with adjoining layers, such as the shards of one job, in any order. If
/// input and output have the format Common Layer Interface, layers are copied unchanged, and
/// `options.writing` has no effect. The result is then, byte for byte, the file that a job without shards
/// writes. Layers of other formats are read and rewritten. One file at a time is held in memory.
///
/// Throws
///
/// - Error{input} that names two files if they differ in the parameters of a part, in units or header, or in
///   their parts (except in formats of scan vectors, which list only parts that are not empty); or if there
///   is a gap between their layers, or an overlap;
/// - Error{input} if layers would be copied from a file whose reading gives a warning;
/// - Error{usage} for inputs that can be read only once, such as pipes; and if `output` exists and its layers
///   adjoin the layers of the inputs, because `output` then counts as an input;
/// - the errors of read_layers and of the writer.
MergeResult merge_layer_files(std::span<const std::string> paths, const std::string& output,
                              const MergeOptions& options = {}, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END

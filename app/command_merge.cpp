#include "lamella/jobs/merge.hpp"

#include "command_line.hpp"
#include "commands.hpp"
#include "numbers.hpp"
#include "options.hpp"
#include "page_notes.hpp"
#include "shard_stamp.hpp"
#include "standard_streams.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

namespace lamella::app {
namespace {

struct MergeArguments {
    std::string output;
    std::vector<std::string> shards;
    LayerOutputOptions writing;
    ReadLimits limits;
    RunOptions run;
};

int run_merge(const MergeArguments& arguments, const Context& context) {
    check_outputs(context.command);
    const LayerFormat& format = arguments.writing.chosen(arguments.output);
    LayerWriteOptions options = arguments.writing.write_options(format);
    options.page.title = title_of(arguments.output);
    const Execution execution = arguments.run.execution(context);
    arguments.limits.prepare_memory();
    options.limits = layer_limits(execution, arguments.limits.max_memory.value_or(0), 0);
    check_stamps(arguments.shards, execution);
    const MergeResult result = merge_layer_files(
        arguments.shards, arguments.output,
        {.format = format.name, .writing = options, .reading = arguments.limits.of_layers()}, execution);
    for (const std::string& warning : result.file_warnings)
        context.messages.warn(warning);
    context.messages.warn_of(output_name(arguments.output), result.losses.texts());
    const std::string text =
        fmt::format("{}: {} from z = {} to {} mm, from {}, {}\n", one_line(output_name(arguments.output)),
                    counted(result.layers, "layer"), height(result.bottom), height(result.top),
                    counted(arguments.shards.size(), "file"), byte_size(result.bytes));
    context.messages.written(text, arguments.output);
    return 0;
}

} // namespace

Command merge_command() {
    const auto arguments = std::make_shared<MergeArguments>();
    return {
        .name = "merge",
        .summary = "join slice files of consecutive layers",
        .description =
            "Joins slice files with consecutive layers, such as the shards of a job (lamella slice --shard), "
            "named in any order. Files that overlap, leave gaps or belong to different jobs are refused. An "
            "exposure may be missing in some files; in ilt, ovf and 3mf-toolpath also a whole part. Files in "
            "the formats cli and cli-ascii become the file of a single run, byte for byte, unless other "
            "units, the short form or compression are requested; layers of other formats are read and "
            "written again.",
        .operands = {{.placeholder = "OUT",
                      .help =
                          "the slice file to write; its extension determines the format, and .gz after it "
                          "compresses it; - is standard output",
                      .written = true,
                      .set =
                          [arguments](const std::string& text) {
                              arguments->output = text;
                          }},
                     {.placeholder = "SHARD",
                      .help = "a slice file to read",
                      .repeated = true,
                      .set =
                          [arguments](const std::string& text) {
                              arguments->shards.push_back(text);
                          }}},
        .groups = {{"output", "Output", layer_output_options(arguments->writing)},
                   image_options(arguments->writing.image),
                   run_options(arguments->run,
                               {max_memory_option(arguments->limits, "the layers of one file take")}),
                   common_options(true)},
        .examples = {{"lamella merge part.cli part.*.cli", "one file from all shards"}},
        .run = [arguments](const Context& context) {
            return run_merge(*arguments, context);
        }};
}

} // namespace lamella::app

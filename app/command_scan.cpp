#include "lamella/core/error.hpp"
#include "lamella/core/version.hpp"
#include "lamella/inputs/read_file.hpp"
#include "lamella/jobs/layer_findings.hpp"
#include "lamella/jobs/scan_layers.hpp"
#include "lamella/slices/layer_writer.hpp"
#include "lamella/system/whole_file.hpp"

#include "command_line.hpp"
#include "commands.hpp"
#include "config_file.hpp"
#include "failure.hpp"
#include "figures.hpp"
#include "layer_file.hpp"
#include "numbers.hpp"
#include "options.hpp"
#include "page_notes.hpp"
#include "scan_figures.hpp"
#include "scan_options.hpp"
#include "standard_streams.hpp"
#include "text_file.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lamella::app {
namespace {

struct ScanCommandArguments {
    std::string input;
    std::string output;
    LayerOutputOptions writing;
    ScanArguments scanning;
    std::string stats;
    bool strict = false;
    ReadLimits limits;
    RunOptions run;
};

OptionGroup output_options(ScanCommandArguments& target) {
    Option output = output_file("output",
                                "the slice file; its extension determines the format, and .gz after it "
                                "compresses it; - is standard output",
                                target.output);
    output.letter = 'o';
    OptionGroup group{"output", "Output", {std::move(output)}};
    for (Option& option : layer_output_options(target.writing))
        group.options.push_back(std::move(option));
    group.options.push_back(output_file(
        "stats", "write figures of the vectors of every layer as JSON; - is standard output", target.stats));
    group.options.push_back(flag(
        "strict", "treat as errors: defects of the file, data that the format cannot store; write no file",
        target.strict));
    return group;
}

/// Rejects scan vectors, because they do not describe material: hatches have no contours, and each contour
/// would be hatched again.
void check_layers(const LayerFile& file) {
    for (const PartInfo& part : file.parts)
        if (part.exposure)
            throw Error(ErrorKind::input,
                        fmt::format("{}: holds scan vectors already ({}); give the layers that they are made "
                                    "of",
                                    file.path, one_line(part.label)));
}

Json stats_of(const Command& command, const std::string& path, const LayerFile& file,
              const ScanStrategy& strategy, const FileResult& result) {
    Json stats = {{"lamella", version()},
                  {"options", options_in_effect(command)},
                  {"input", {{"path", path}, {"format", file.format}, {"parts", file.parts.size()}}},
                  {"seconds", {{"scan", result.seconds.scan}}},
                  {"volume_mm3", result.volume_mm3},
                  {"scan", scan_json(result, strategy)}};
    add_findings(stats, result);
    Json& layers = stats["layers"] = Json::array();
    for (const LayerStatistics& layer : result.layers)
        layers.push_back({{"index", layer.index},
                          {"z", layer.z},
                          {"thickness", layer.thickness},
                          {"area_mm2", layer.measure.area_mm2},
                          {"scan", scan_json(result.exposures, layer)}});
    return stats;
}

int run_scan(const ScanCommandArguments& arguments, const Context& context) {
    if (arguments.output.empty())
        throw Error(ErrorKind::usage, "where should the vectors go? Say -o job.cli");
    check_outputs(context.command);
    const LayerFormat& format = arguments.writing.chosen(arguments.output);
    LayerWriteOptions options = arguments.writing.write_options(format);
    options.strict = arguments.strict;
    options.page.title = title_of(arguments.input);
    const ScanStrategy strategy = arguments.scanning.strategy();
    const Execution execution = arguments.run.execution(context);
    arguments.limits.prepare_memory();
    if (!arguments.stats.empty())
        check_writable(arguments.stats);
    const LayerFile file = read_layers(arguments.input, arguments.limits.of_layers(), execution);
    check_layers(file);
    const std::uint64_t max_memory = arguments.limits.max_memory.value_or(0);
    warn_about(file, file.warnings, arguments.strict, context.messages);
    Findings of_file;
    if (const std::uint64_t lines = file.hatch_lines(); lines > 0)
        of_file.add({.kind = FindingKind::replaced_hatch_lines, .count = lines});
    warn_about(file, of_file.texts(), arguments.strict, context.messages);
    const FileResult result =
        scan_layers(arguments.output, format, file, strategy, options, execution, max_memory);
    warn_about(file, result.findings.texts(), false, context.messages);
    context.messages.warn_of(output_name(arguments.output), result.losses.texts());
    after_output(arguments.output, [&] {
        if (arguments.stats.empty())
            return;
        const std::string text =
            json_text(stats_of(context.command, arguments.input, file, strategy, result));
        if (arguments.stats == "-")
            context.messages.result(text);
        else
            write_text_file(arguments.stats, text);
    });
    const std::string text =
        fmt::format("{}: {} from {} ({}) as {}, {}\n  {}\n", one_line(output_name(arguments.output)),
                    counted(file.planes.size(), "layer"), one_line(file.path), file.format, format.name,
                    byte_size(result.bytes), scan_text(result.exposures));
    context.messages.written(text, arguments.stats == "-" ? "-" : arguments.output);
    return 0;
}

} // namespace

Command scan_command() {
    const auto arguments = std::make_shared<ScanCommandArguments>();
    return {
        .name = "scan",
        .summary = "make scan vectors from a slice file",
        .description =
            "Makes scan vectors for a powder-bed machine from the layers of a slice file: contours moved "
            "inwards, and hatch lines that fill the inside, separately for each part and each region of the "
            "strategy. lamella slice makes them directly from a mesh, with --scan or --strategy.",
        .operands = {{.placeholder = "FILE",
                      .help = "the slice file to read; - is standard input",
                      .set =
                          [arguments](const std::string& text) {
                              arguments->input = text;
                          }}},
        .groups = {output_options(*arguments), scan_options(arguments->scanning),
                   image_options(arguments->writing.image),
                   run_options(arguments->run, {max_memory_option(arguments->limits, "the layers take")}),
                   common_options(true)},
        .examples = {{"lamella scan part.cli -o job.cli", "with the default strategy"},
                     {"lamella scan part.3mf -o job.cli --strategy 316l.toml --hatch-distance 0.09",
                      "with a strategy file, of which one value is changed"}},
        .run = [arguments](const Context& context) {
            return run_scan(*arguments, context);
        }};
}

} // namespace lamella::app

#include "lamella/contour/layer.hpp"
#include "lamella/core/error.hpp"
#include "lamella/inputs/read_file.hpp"
#include "lamella/polygon/layer_steps.hpp"
#include "lamella/slices/layer_writer.hpp"

#include "command_line.hpp"
#include "commands.hpp"
#include "layer_file.hpp"
#include "numbers.hpp"
#include "options.hpp"
#include "page_notes.hpp"
#include "standard_streams.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lamella::app {
namespace {

struct ConvertArguments {
    std::string input;
    std::string output;
    LayerOutputOptions writing;
    LayerStepOptions making;
    std::string label;
    bool strict = false;
    ReadLimits limits;
    RunOptions run;
};

OptionGroup output_options(ConvertArguments& target) {
    OptionGroup group{"output", "Output", layer_output_options(target.writing)};
    group.options.push_back(text("label", "TEXT",
                                 "new name of the part in the slice file, which must have only one part",
                                 target.label));
    group.options.push_back(
        flag("strict",
             "treat as errors: defects of the file, data that the new format cannot store; write no file",
             target.strict));
    return group;
}

int run_convert(const ConvertArguments& arguments, const Context& context) {
    check_outputs(context.command);
    const LayerFormat& format = arguments.writing.chosen(arguments.output);
    LayerWriteOptions options = arguments.writing.write_options(format);
    options.strict = arguments.strict;
    const Execution execution = arguments.run.execution(context);
    arguments.limits.prepare_memory();
    const std::uint64_t max_memory = arguments.limits.max_memory.value_or(0);
    options.limits = layer_limits(execution, max_memory, 0);
    const LayerSteps steps = arguments.making.steps();
    LayerFile file = read_layers(arguments.input, arguments.limits.of_layers(), execution);
    options.page.title = title_of(arguments.input);
    warn_about(file, file.warnings, arguments.strict, context.messages);
    LayerChanges changes;
    if (steps.any())
        changes = take_steps(steps, file, arguments.strict, context.messages, execution, max_memory).all;
    LayerFileInfo info = info_of(file);
    if (!arguments.label.empty()) {
        if (file.parts.size() > 1)
            throw Error(ErrorKind::usage,
                        fmt::format("--label names one part, and {} holds {}", file.path, file.parts.size()));
        info.parts.front().label = arguments.label;
    }
    arguments.writing.image.apply_to(file, format, info, options);
    if (const auto warning = arguments.writing.image.other_printer(file, format)) {
        if (arguments.strict)
            throw Error(ErrorKind::defect, fmt::format("{}: {}", file.path, *warning));
        context.messages.warn_of(file.path, {*warning});
    }
    const std::unique_ptr<LayerWriter> writer = open_layer_writer(arguments.output, format, info, options);
    write_planes(*writer, file, !steps.any(), arguments.strict, context.messages, execution, max_memory);
    writer->finish();
    context.messages.warn_of(output_name(arguments.output), writer->warnings());

    std::string text =
        fmt::format("{}: {} from {} ({}) as {}\n", one_line(output_name(arguments.output)),
                    counted(info.layers, "layer"), one_line(file.path), file.format, format.name);
    if (steps.any())
        text += fmt::format("  changed {}\n", changes_text(steps, changes));
    context.messages.written(text, arguments.output);
    return 0;
}

} // namespace

Command convert_command() {
    const auto arguments = std::make_shared<ConvertArguments>();
    return {
        .name = "convert",
        .summary = "convert a slice file to another format",
        .description = "Writes the layers of a slice file in another format. Without layer steps, contours "
                       "remain as they "
                       "are, up to the rounding of the new format.",
        .operands = {{.placeholder = "IN",
                      .help = "the slice file to read; - is standard input",
                      .set =
                          [arguments](const std::string& text) {
                              arguments->input = text;
                          }},
                     {.placeholder = "OUT",
                      .help =
                          "the slice file to write; its extension determines the format, and .gz after it "
                          "compresses it; - is standard output",
                      .written = true,
                      .set =
                          [arguments](const std::string& text) {
                              arguments->output = text;
                          }}},
        .groups = {output_options(*arguments), image_options(arguments->writing.image),
                   layer_step_options(arguments->making),
                   run_options(arguments->run, {max_memory_option(arguments->limits, "the layers take")}),
                   common_options(true)},
        .examples = {{"lamella convert part.cli part.svg", "a file for a browser or a drawing program"},
                     {"lamella convert part.svg part.cli --short --units-mm 0.005",
                      "16-bit coordinates in units of 5 micrometres"}},
        .run = [arguments](const Context& context) {
            return run_convert(*arguments, context);
        }};
}

} // namespace lamella::app

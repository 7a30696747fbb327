#include "lamella/core/error.hpp"
#include "lamella/inputs/read_file.hpp"
#include "lamella/jobs/plate.hpp"
#include "lamella/jobs/slice_file.hpp"
#include "lamella/mesh/diagnose.hpp"
#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/polygon/layer_steps.hpp"
#include "lamella/slices/layer_page.hpp"

#include "command_line.hpp"
#include "commands.hpp"
#include "diagnosis_report.hpp"
#include "layer_file.hpp"
#include "layering_options.hpp"
#include "numbers.hpp"
#include "options.hpp"
#include "page_notes.hpp"
#include "run_warnings.hpp"
#include "standard_streams.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace lamella::app {
namespace {

struct ViewArguments {
    std::string input;
    std::string output;
    std::optional<double> layer_height;
    std::string slice_at; ///< "" if not given
    std::optional<double> snap;
    PlacementOptions placement;
    LayerStepOptions making;
    ReadLimits limits;
    RunOptions run;
};

PlateInput input_of(const ViewArguments& arguments) {
    PlateInput input{.path = arguments.input};
    input.unit_mm = arguments.placement.unit_mm();
    input.placement = arguments.placement.pose();
    return input;
}

Diagnosis diagnosis_of(const Plate& plate, const Execution& execution) {
    DiagnosisOptions options;
    options.keep = page_locations;
    return diagnose(weld(joined(plate, execution), execution), options, execution);
}

/// Writes the page of a mesh; returns the number of layers.
std::uint64_t view_mesh(const ViewArguments& arguments, MeshFile mesh, const std::string& output,
                        Messages& messages, const Execution& execution) {
    Plate plate = load_plate(input_of(arguments), std::move(mesh), execution);
    check_memory(plate, diagnosis_bytes_per_triangle, arguments.limits.max_memory.value_or(0));
    const Diagnosis diagnosis = diagnosis_of(plate, execution);
    FileJob job;
    job.inputs = {input_of(arguments)};
    job.layering.cut =
        UniformLayers{.layer_height = arguments.layer_height.value_or(UniformLayers{}.layer_height)};
    if (!arguments.slice_at.empty())
        job.layering.at = slice_at_named(arguments.slice_at);
    job.layering.snap_mm = arguments.snap.value_or(0);
    job.max_memory = arguments.limits.max_memory.value_or(0);
    job.steps = arguments.making.steps();
    job.layer_statistics = job.steps.any(); // the page shows the changes of each layer
    job.report = {
        .path = output, .page = page_options(arguments.input), .notes = [&](const FileResult& result) {
            PageNotes notes = run_notes(result);
            notes.sections.insert(notes.sections.begin(), mesh_section(diagnosis.counts));
            notes.locations = places_of(diagnosis);
            return notes;
        }};
    const FileResult result = slice_file(job, std::move(plate), execution);
    for (const std::string& warning : run_warnings(job, result))
        messages.warn(warning);
    return result.report.layers;
}

/// Writes the page of layers; returns their number.
std::uint64_t view_layers(const ViewArguments& arguments, LayerFile file, const std::string& output,
                          Messages& messages, const Execution& execution) {
    if (arguments.placement.given() || arguments.layer_height || !arguments.slice_at.empty() ||
        arguments.snap)
        refuse_options_of_meshes(file);
    warn_about(file, file.warnings, false, messages);
    PageNotes notes = file_notes(file);
    const LayerSteps steps = arguments.making.steps();
    const std::uint64_t max_memory = arguments.limits.max_memory.value_or(0);
    std::vector<LayerChanges> planes;
    if (steps.any())
        planes = take_steps(steps, file, false, messages, execution, max_memory).planes;
    for (std::size_t i = 0; i < planes.size(); ++i)
        if (planes[i].changed_layers > 0)
            notes.changes.push_back({file.planes[i].index, planes[i]});
    const LayerFileInfo info = info_of(file);
    const auto page = open_layer_page(output, info, page_options(arguments.input));
    write_planes(*page, file, !steps.any(), false, messages, execution, max_memory);
    page->add_notes(std::move(notes));
    page->finish();
    messages.warn_of(output_name(output), page->warnings());
    return info.layers;
}

/// Returns the default path of the page, which is in the working folder, not in that of the file:
/// "parts/rook.stl" gives rook.html.
std::string output_of(const ViewArguments& arguments) {
    if (!arguments.output.empty())
        return arguments.output;
    if (arguments.input == "-")
        throw Error(ErrorKind::usage,
                    "standard input has no name to call the page by; give one with --output");
    return std::filesystem::path(arguments.input).stem().string() + ".html";
}

int run_view(const ViewArguments& arguments, const Context& context) {
    const std::string output = output_of(arguments);
    check_outputs(context.command, arguments.output.empty() ? std::vector<NamedFile>{{"the page", output}}
                                                            : std::vector<NamedFile>{});
    const Execution execution = arguments.run.execution(context);
    arguments.limits.prepare_memory();
    auto read = read_any(arguments.input, arguments.limits.of_meshes(), execution);
    auto* const file = std::get_if<LayerFile>(&read);
    const std::uint64_t layers =
        file != nullptr
            ? view_layers(arguments, std::move(*file), output, context.messages, execution)
            : view_mesh(arguments, std::move(std::get<MeshFile>(read)), output, context.messages, execution);
    const std::string text =
        fmt::format("{}: {} of {}; open it with a browser\n", one_line(output_name(output)),
                    counted(layers, "layer"), one_line(input_name(arguments.input)));
    context.messages.written(text, output);
    return 0;
}

OptionGroup cutting_options(ViewArguments& target) {
    Option layer_height = length("layer-height", "thickness of a layer", target.layer_height);
    layer_height.preset = exact(UniformLayers{}.layer_height);
    Option slice_at = choice("slice-at", "WHERE", "height within a layer at which it is cut",
                             slice_at_names(), target.slice_at);
    slice_at.preset = "middle";
    return {"layers",
            "Layers (of a mesh)",
            {std::move(layer_height), std::move(slice_at), snap_option(target.snap)}};
}

} // namespace

Command view_command() {
    const auto arguments = std::make_shared<ViewArguments>();
    Option output = output_file(
        "output", "the page; - is standard output (default: the name of FILE with .html, in this folder)",
        arguments->output, page_extensions());
    output.letter = 'o';
    return {.name = "view",
            .summary = "write a page that shows the layers in a browser",
            .description =
                "Writes one HTML page that shows all layers of a mesh or a slice file, one by one and as a "
                "stack, "
                "with figures over the height and the locations of defects. The page needs no network and no "
                "other "
                "file. lamella slice writes such a page with all of its own options: by -o page.html, or by "
                "--report in addition to a slice file.",
            .operands = {{.placeholder = "FILE",
                          .help = "a mesh or a slice file; - is standard input",
                          .set =
                              [arguments](const std::string& text) {
                                  arguments->input = text;
                              }}},
            .groups = {{"output", "Output", {std::move(output)}},
                       cutting_options(*arguments),
                       placement_options(arguments->placement, {include_option(arguments->limits)}),
                       layer_step_options(arguments->making),
                       run_options(arguments->run, {max_triangles_option(arguments->limits),
                                                    max_memory_option(arguments->limits, "the file takes")}),
                       common_options(true)},
            .examples = {{"lamella view part.stl", "writes part.html, with layers of 0.1 mm"},
                         {"lamella view part.cli -o look.html", "the layers of a slice file"}},
            .run = [arguments](const Context& context) {
                return run_view(*arguments, context);
            }};
}

} // namespace lamella::app

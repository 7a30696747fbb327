#include "lamella/core/error.hpp"
#include "lamella/inputs/read_file.hpp"
#include "lamella/jobs/plate.hpp"
#include "lamella/jobs/print_check.hpp"
#include "lamella/jobs/slice_file.hpp"
#include "lamella/slices/layer_page.hpp"
#include "lamella/system/whole_file.hpp"

#include "command_line.hpp"
#include "commands.hpp"
#include "config_file.hpp"
#include "failure.hpp"
#include "figures.hpp"
#include "layer_file.hpp"
#include "layering_options.hpp"
#include "numbers.hpp"
#include "options.hpp"
#include "page_notes.hpp"
#include "print_check_report.hpp"
#include "repair_options.hpp"
#include "run_warnings.hpp"
#include "standard_streams.hpp"
#include "text_file.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>
#include <variant>

namespace lamella::app {
namespace {

struct CheckArguments {
    std::string input;
    PrintCheckArguments checking;
    std::string stats;
    std::string report;
    bool strict = false;
    bool json = false;
    LayeringOptions layering;
    PlacementOptions placement;
    RepairPolicies repair;
    LayerStepOptions making;
    ReadLimits limits;
    RunOptions run;

    [[nodiscard]] std::uint64_t max_memory() const { return limits.max_memory.value_or(0); }
};

/// Slices a mesh, and checks its layers.
PrintCheck check_mesh(const CheckArguments& arguments, MeshFile mesh, Messages& messages,
                      const Execution& execution) {
    FileJob job;
    PlateInput input{.path = arguments.input};
    input.unit_mm = arguments.placement.unit_mm();
    input.placement = arguments.placement.pose();
    job.inputs = {input};
    job.layering = arguments.layering.layering(arguments.max_memory());
    job.max_memory = arguments.max_memory();
    job.repair = arguments.repair;
    job.steps = arguments.making.steps();
    job.check = arguments.checking.options(job.max_memory);
    if (!arguments.report.empty()) {
        job.layer_statistics = job.steps.any(); // the page shows the changes of each layer
        job.report = {.path = arguments.report, .page = page_options(arguments.input), .notes = run_notes};
    }
    FileResult result = slice_file(job, load_plate(input, std::move(mesh), execution), execution);
    PrintCheck check = std::move(*result.check);
    result.check.reset(); // its findings are part of the output
    for (const std::string& warning : run_warnings(job, result))
        messages.warn(warning);
    return check;
}

/// Writes a page that shows the layers of a slice file, with marks of what the check found.
void write_report(const CheckArguments& arguments, const LayerFile& file, const PrintCheck& check,
                  Messages& messages, const Execution& execution) {
    const auto page = open_layer_page(arguments.report, info_of(file), page_options(arguments.input));
    write_planes(*page, file, !arguments.making.steps().any(), false, messages, execution,
                 arguments.max_memory());
    PageNotes notes = file_notes(file);
    notes.sections.push_back(print_check_section(check));
    notes.locations = places_of(check);
    page->add_notes(std::move(notes));
    page->finish();
    messages.warn_of(output_name(arguments.report), page->warnings());
}

/// Checks the layers of a slice file.
PrintCheck check_layers(const CheckArguments& arguments, LayerFile file, Messages& messages,
                        const Execution& execution) {
    if (arguments.placement.given() || arguments.layering.given())
        refuse_options_of_meshes(file);
    for (const PartInfo& part : file.parts)
        if (part.exposure)
            throw Error(ErrorKind::input,
                        fmt::format("{}: has scan vectors ({}), not the material of layers; check the mesh, "
                                    "or the layers that the vectors are made of",
                                    file.path, one_line(part.label)));
    warn_about(file, file.warnings, false, messages);
    if (const LayerSteps steps = arguments.making.steps(); steps.any())
        take_steps(steps, file, false, messages, execution, arguments.max_memory());
    PrintCheck check = check_print(file, arguments.checking.options(arguments.max_memory()), execution);
    if (!arguments.report.empty())
        write_report(arguments, file, check, messages, execution);
    return check;
}

Json check_stats(const Command& command, const CheckArguments& arguments, const PrintCheck& check) {
    Json stats = {{"options", options_in_effect(command)}, {"input", arguments.input}};
    stats["check"] = print_check_json(check);
    Json& layers = stats["layers"] = Json::array();
    for (const PeelArea& layer : check.layers)
        layers.push_back(peel_json(layer));
    return stats;
}

int run_check(const CheckArguments& arguments, const Context& context) {
    check_outputs(context.command);
    static_cast<void>(arguments.checking.options(0)); // before large files are read
    const Execution execution = arguments.run.execution(context);
    arguments.limits.prepare_memory();
    if (!arguments.stats.empty())
        check_writable(arguments.stats);
    MeshReadOptions reading = arguments.limits.of_meshes();
    reading.kept = KeptPlanes::if_faster;
    auto read = read_any(arguments.input, reading, execution);
    auto* const file = std::get_if<LayerFile>(&read);
    const PrintCheck check =
        file != nullptr
            ? check_layers(arguments, std::move(*file), context.messages, execution)
            : check_mesh(arguments, std::move(std::get<MeshFile>(read)), context.messages, execution);
    const bool ok = check.findings.first(Severity::warning) == nullptr;
    if (!arguments.stats.empty()) {
        const std::string text = json_text(check_stats(context.command, arguments, check));
        if (arguments.stats == "-")
            context.messages.result(text);
        else
            write_text_file(arguments.stats, text);
    }
    if (arguments.json) {
        Json object = {{"path", arguments.input}, {"ok", ok}, {"layers", check.layers.size()}};
        object.update(print_check_json(check));
        context.messages.result(json_text(object));
    } else if (arguments.stats != "-" && arguments.report != "-") {
        context.messages.result(fmt::format(
            "{}: {}, {}\n{}", one_line(input_name(arguments.input)), counted(check.layers.size(), "layer"),
            ok ? "no errors found" : "not sound to print", print_check_text(check)));
    }
    if (arguments.strict && !ok)
        throw Error(ErrorKind::defect, fmt::format("{}: the check failed", input_name(arguments.input)));
    return 0;
}

} // namespace

Command check_command() {
    const auto arguments = std::make_shared<CheckArguments>();
    OptionGroup checking{"checks", "Checks", print_check_options(arguments->checking)};
    checking.options.push_back(
        output_file("stats", "write the findings and the areas of every layer as JSON; - is standard output",
                    arguments->stats));
    checking.options.push_back(output_file(
        "report",
        "write a page that shows the layers, with a mark at each of the first 500 regions of each kind",
        arguments->report, page_extensions()));
    checking.options.push_back(flag("strict",
                                    "end with exit code 4 if there is an island, a loose support, a cup, a "
                                    "trap, an empty layer or an open contour",
                                    arguments->strict));
    checking.options.push_back(flag("json", "print JSON", arguments->json));
    return {
        .name = "check",
        .summary = "find islands, overhangs and enclosed resin in a print",
        .description =
            "Checks whether layers can be printed one on the other, as a resin printer does it. Islands are "
            "material that begins in the resin, without material in the layer below. Overhangs reach farther "
            "beyond the layer below than a surface at --overhang-angle does. Cups are hollows that open "
            "later, or that the plate closes: while they grow, the film of the vat closes them, and lifting "
            "the plate makes a vacuum in them. Traps are hollows that never open, so resin stays in them. "
            "FILE is a mesh, which is cut, a slice file, or a job for a resin printer. Contours are compared "
            "exactly, without pixels.",
        .operands = {{.placeholder = "FILE",
                      .help = "a mesh or a slice file; - is standard input",
                      .set =
                          [arguments](const std::string& text) {
                              arguments->input = text;
                          }}},
        .groups = {std::move(checking), layering_options(arguments->layering),
                   placement_options(arguments->placement, {include_option(arguments->limits)}),
                   repair_options(arguments->repair), layer_step_options(arguments->making),
                   run_options(arguments->run, {max_triangles_option(arguments->limits),
                                                max_memory_option(arguments->limits, "the file takes")}),
                   common_options(true)},
        .examples = {{"lamella check part.stl --layer-height 0.05", "before a part is printed"},
                     {"lamella check part.stl --rotate-x 35 --strict", "in a script, for another pose"},
                     {"lamella check job.goo --report job.html",
                      "the pixels of a job, with a page to look at"},
                     {"lamella check part.cli --touch 0.05 --json", "layers of a slice file"}},
        .run = [arguments](const Context& context) {
            return run_check(*arguments, context);
        }};
}

} // namespace lamella::app

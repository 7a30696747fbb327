#include "lamella/contour/exposure.hpp"
#include "lamella/core/error.hpp"
#include "lamella/inputs/read_file.hpp"
#include "lamella/jobs/layer_files.hpp"
#include "lamella/mesh/diagnose.hpp"
#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/slices/layer_page.hpp"

#include "command_line.hpp"
#include "commands.hpp"
#include "diagnosis_report.hpp"
#include "failure.hpp"
#include "figures.hpp"
#include "messages.hpp"
#include "numbers.hpp"
#include "options.hpp"
#include "page_notes.hpp"
#include "resin_figures.hpp"
#include "scan_figures.hpp"
#include "standard_streams.hpp"
#include "text_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace lamella::app {
namespace {

struct InfoArguments {
    std::vector<std::string> inputs;
    bool json = false;
    bool strict = false;
    bool self_intersections = false;
    std::string report;
    PlacementOptions placement; ///< only the unit is used
    ReadLimits limits;
    RunOptions run;
};

/// Warns of defects of negative volumes, which are no part of the mesh that is described. Returns whether
/// there are none.
bool negatives_are_sound(const Plate& plate, const std::string& name, Messages& messages,
                         const Execution& execution) {
    std::set<std::size_t> shapes;
    for (const PlateNegative& negative : plate.negatives)
        shapes.insert(negative.shape);
    bool sound = true;
    for (const std::size_t shape : shapes) {
        const Inspection found = inspect(weld(plate.shapes[shape].mesh, execution), execution);
        if (found.sound())
            continue;
        sound = false;
        messages.warn(fmt::format("{}: a negative volume of {} triangles has defects: {}", name,
                                  found.triangles, describe_defects(found)));
    }
    return sound;
}

/// Returns the object on several lines, or on one line if there are several objects.
std::string json_of(const InfoArguments& arguments, const Json& object) {
    return arguments.inputs.size() == 1 ? json_text(object) : compact_json(object) + "\n";
}

int describe_mesh(const InfoArguments& arguments, const MeshFile& file, const Context& context,
                  const Execution& execution) {
    context.messages.warn_of(input_name(file.path), file.warnings);
    const Plate plate =
        load_plate({.path = file.path, .unit_mm = arguments.placement.unit_mm()}, file, execution);
    check_memory(plate, diagnosis_bytes_per_triangle, arguments.limits.max_memory.value_or(0));
    const IndexedMesh mesh = weld(joined(plate, execution), execution);
    DiagnosisOptions options;
    options.self_intersections = arguments.self_intersections;
    if (!arguments.report.empty())
        options.keep = page_locations;
    const Diagnosis found = diagnose(mesh, options, execution);
    if (!arguments.report.empty())
        write_mesh_page(arguments.report, mesh, found, mesh_notes(file, found), page_options(file.path),
                        execution);
    const std::string text =
        arguments.json ? json_of(arguments, mesh_json(file, found, plate)) : mesh_text(file, found, plate);
    if (arguments.report == "-")
        context.messages.note(text);
    else
        context.messages.result(text);
    const bool sound = negatives_are_sound(plate, input_name(file.path), context.messages, execution);
    if (arguments.strict && !(sound && found.counts.sound()))
        throw Error(ErrorKind::defect, fmt::format("{}: the mesh has defects", input_name(file.path)));
    return 0;
}

bool holds_vectors(const LayerFile& file) {
    return std::any_of(file.parts.begin(), file.parts.end(),
                       [](const PartInfo& part) { return part.exposure.has_value(); });
}

/// Returns the figures of vectors. Times and energies are included if the file contains speeds and powers;
/// jumps at an unknown speed take no time.
Figures vector_figures(const std::vector<ExposureResult>& exposures) {
    const auto all_have = [&](double ParameterSet::*number) {
        return std::all_of(exposures.begin(), exposures.end(), [&](const ExposureResult& one) {
            return one.figures.vectors == 0 || one.exposure.parameters.*number > 0;
        });
    };
    const bool timed = all_have(&ParameterSet::speed_mm_s);
    const bool powered = all_have(&ParameterSet::power_w);
    Figures figures = scan_figures(exposures);
    std::erase_if(figures, [](const Figure& figure) { return figure.key == "unreached_mm2"; }); // not known
    for (Figure& figure : figures)
        if ((figure.key == "build_seconds" && !timed) || (figure.key == "energy_j" && !(timed && powered))) {
            figure.value = nullptr;
            figure.text = fmt::format("not known: the file does not say {}{}{}", timed ? "" : "speeds",
                                      timed || powered || figure.key != "energy_j" ? "" : " and ",
                                      powered || figure.key != "energy_j" ? "" : "powers");
        }
    return figures;
}

Figures figures_of(const LayerFile& file, const FileFigures& measured) {
    std::uint64_t other_hatches = 0; // without an exposure
    for (const PartInfo& part : file.parts)
        other_hatches += part.exposure ? 0 : part.hatch_lines;
    const LayerStack& layers = file.planes;
    Figures figures = layer_figures(layers.size(), measured.contours, measured.volume_mm3);
    Figure range{"z_range", Json(), "from"};
    if (!layers.empty()) {
        const double bottom = layers.front().bottom;
        const double top = layers.back().top;
        range.value = {bottom, top};
        range.text = fmt::format("z = {} to {} mm", height(bottom), height(top));
    }
    figures.insert(figures.begin() + 1, std::move(range));
    const Figures job = resin_figures(file);
    figures.insert(figures.begin(), job.begin(), job.end());
    if (other_hatches > 0)
        figures.push_back(
            {"hatches", other_hatches, "hatched", counted(other_hatches, "line") + " of no exposure"});
    if (holds_vectors(file)) {
        // Contours of some exposures lie within those of others, so all contours together do not bound a
        // volume.
        std::erase_if(figures, [](const Figure& figure) { return figure.key == "volume_mm3"; });
        for (Figure& figure : vector_figures(measured.exposures))
            figures.push_back(std::move(figure));
    }
    return figures;
}

std::vector<std::string> labels_of(const LayerFile& file) {
    std::vector<std::string> labels;
    for (const PartInfo& part : file.parts)
        labels.push_back(part.label);
    return labels;
}

std::string layers_text(const LayerFile& file, const Figures& figures,
                        const std::vector<RegionFigures>& regions) {
    std::string text = fmt::format("{}: slice file, {}\n", one_line(file.path), file.format);
    std::string_view name = file.parts.size() == 1 ? "label" : "parts";
    for (const std::string& label : labels_of(file)) {
        if (file.parts.size() == 1 && label.empty())
            continue;
        text += result_line(name, label.empty() ? "(without a label)" : one_line(label));
        name = "";
    }
    text += as_lines(figures);
    for (const RegionFigures& region : regions)
        text += result_line(region.name, region.text);
    return text;
}

Json layers_json(const std::string& path, const LayerFile& file, const Figures& figures,
                 const std::vector<RegionFigures>& regions) {
    Json json = {{"path", path},
                 {"format", file.format},
                 {"label", file.parts.front().label},
                 {"parts", labels_of(file)},
                 {"units_mm", file.units_mm}};
    json.update(as_json(figures));
    for (const RegionFigures& region : regions)
        json["regions"][region.name] = region.json;
    return json;
}

int describe_layers(const InfoArguments& arguments, const LayerFile& file, const Context& context,
                    const Execution& execution) {
    context.messages.warn_of(input_name(file.path), file.warnings);
    if (arguments.placement.given())
        throw Error(ErrorKind::usage,
                    fmt::format("{}: --unit is for meshes; a slice file knows its unit", file.path));
    if (arguments.self_intersections || !arguments.report.empty())
        throw Error(
            ErrorKind::usage,
            fmt::format("{}: --self-intersections and --report are for meshes; lamella view writes a page of "
                        "a slice file",
                        file.path));
    const FileFigures measured = measure(file, execution);
    const Figures figures = figures_of(file, measured);
    const std::vector<RegionFigures> regions = region_figures(measured.exposures);
    context.messages.result(arguments.json
                                ? json_of(arguments, layers_json(file.path, file, figures, regions))
                                : layers_text(file, figures, regions));
    if (const std::size_t chains = measured.contours.open_chains; arguments.strict && chains > 0)
        throw Error(ErrorKind::defect, fmt::format("{}: has {}", file.path, counted(chains, "open chain")));
    return 0;
}

int describe(const std::string& input, const InfoArguments& arguments, const Context& context,
             const Execution& execution) {
    MeshReadOptions options = arguments.limits.of_meshes();
    options.strict = arguments.strict;
    const auto file = read_any(input, options, execution);
    if (const auto* mesh = std::get_if<MeshFile>(&file))
        return describe_mesh(arguments, *mesh, context, execution);
    return describe_layers(arguments, std::get<LayerFile>(file), context, execution);
}

int run_info(const InfoArguments& arguments, const Context& context) {
    check_outputs(context.command);
    check_conflict(arguments.inputs.size() > 1, !arguments.report.empty(), "several files and --report",
                   "a page shows one mesh");
    const Execution execution = arguments.run.execution(context);
    arguments.limits.prepare_memory();
    if (arguments.inputs.size() == 1)
        return describe(arguments.inputs.front(), arguments, context, execution);
    int code = 0; // of the first file that fails
    for (const std::string& input : arguments.inputs) {
        try {
            describe(input, arguments, context, execution);
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::cancelled || error.kind() == ErrorKind::output)
                throw;
            const Failure failure = failure_of(std::current_exception());
            const std::string name = input_name(input);
            const bool is_named = failure.text.find(name) != std::string::npos;
            context.messages.error(is_named ? failure.text : name + ": " + failure.text, failure.exit_code);
            code = code == 0 ? failure.exit_code : code;
        }
    }
    return code;
}

} // namespace

Command info_command() {
    const auto arguments = std::make_shared<InfoArguments>();
    return {
        .name = "info",
        .summary = "describe a mesh or slice file: size, volume, defects",
        .description = fmt::format(
            "Describes the contents of files. For a mesh (.{}): size, volume, area, shells, and every kind "
            "of defect with its location and its effect on slicing. For a slice file: layers, contours, "
            "points and volume; for scan vectors, lengths and times; for jobs of resin printers, pixels and "
            "exposures. Nothing is repaired.",
            fmt::join(mesh_extensions(), ", .")),
        .operands = {{.placeholder = "FILE",
                      .help = "meshes and slice files; - is standard input",
                      .repeated = true,
                      .set =
                          [arguments](const std::string& text) {
                              arguments->inputs.push_back(text);
                          }}},
        .groups =
            {{"output",
              "Output",
              {flag("json", "print JSON", arguments->json),
               flag("self-intersections",
                    "also look for triangles that cross, overlap or touch one another (takes longer)",
                    arguments->self_intersections),
               output_file("report",
                           "also write an HTML page that shows the mesh, its shells and its defects",
                           arguments->report, page_extensions()),
               flag("strict", "exit with code 4 if a mesh has any defect, or a slice file an open contour",
                    arguments->strict)}},
             {"input", "Input", {unit_option(arguments->placement.unit), include_option(arguments->limits)}},
             run_options(arguments->run, {max_triangles_option(arguments->limits),
                                          max_memory_option(arguments->limits, "the file takes")}),
             common_options(true)},
        .examples = {{"lamella info part.stl", "size, volume and defects of a mesh"},
                     {"lamella info scan.stl --self-intersections --report scan.html",
                      "all checks, and a page that shows the locations of defects"},
                     {"lamella info part.cli --json", "the same for programs"}},
        .run = [arguments](const Context& context) {
            return run_info(*arguments, context);
        }};
}

} // namespace lamella::app

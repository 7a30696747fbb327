#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"
#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/inspect.hpp"

#include "command_line.hpp"
#include "commands.hpp"
#include "input_kind.hpp"
#include "numbers.hpp"
#include "options.hpp"
#include "stats_json.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace lamella::app {
namespace {

using Json = nlohmann::ordered_json;

struct InfoArguments {
    std::string input;
    bool json = false;
    bool strict = false;
    PlacementOptions placement; ///< the unit only
    RunOptions run;
};

struct Defect {
    std::uint64_t count;
    std::string_view one;
    std::string_view many;
    std::string_view meaning;
};

std::array<Defect, 6> defects_of(const Inspection& found) {
    return {{{found.boundary_edges, "boundary edge", "boundary edges",
              "the surface has holes; contours stay open there"},
             {found.orientation_conflicts, "orientation conflict", "orientation conflicts",
              "neighbouring triangles face opposite ways; contours stay open there"},
             {found.nonmanifold_edges, "crowded edge", "crowded edges",
              "more than two triangles share an edge; contours part or touch there"},
             {found.duplicate_triangles, "duplicate triangle", "duplicate triangles",
              "the same triangle more than once"},
             {found.degenerate_triangles, "degenerate triangle", "degenerate triangles",
              "two equal corners; left out of everything"},
             {found.inverted_shells, "inverted shell", "inverted shells",
              "inside out; contours run the wrong way round there"}}};
}

std::string line(std::string_view name, std::string_view value) {
    return fmt::format("  {:<11} {}\n", name, value);
}

std::string point(const Point3& p) {
    return fmt::format("({}, {}, {})", brief(p.x), brief(p.y), brief(p.z));
}

std::string shells_text(const Inspection& found) {
    if (found.cavities == 0)
        return grouped(found.shells);
    return fmt::format("{}, {} of them {}", grouped(found.shells), grouped(found.cavities),
                       found.cavities == 1 ? "a cavity" : "cavities");
}

/// "3 of 2 meshes: gear, gear 2, axle".
std::string parts_text(const MeshFile& file, const Plate& plate) {
    constexpr std::size_t most = 8;
    std::string text = fmt::format(
        "{} of {}: ", grouped(plate.parts.size()),
        file.objects.size() == 1 ? "one mesh" : fmt::format("{} meshes", grouped(file.objects.size())));
    for (std::size_t i = 0; i < std::min(most, plate.parts.size()); ++i)
        text.append(i == 0 ? "" : ", ").append(one_line(plate.parts[i].label));
    return plate.parts.size() > most ? text + ", ..." : text;
}

std::string mesh_text(const MeshFile& file, const Inspection& found, const Plate& plate) {
    const Box3& box = found.box;
    std::string text = fmt::format("{}: mesh, {}\n", one_line(file.path), format_name(file.format));
    if (file.unit_mm)
        text += line("unit", fmt::format("{} mm, as the file says", brief(*file.unit_mm)));
    if (plate.parts.size() > 1)
        text += line("parts", parts_text(file, plate));
    text += line("triangles", grouped(file.stored_triangles));
    text += line("vertices", grouped(found.vertices));
    text += line("size", fmt::format("{} x {} x {} mm", brief(box.max.x - box.min.x),
                                     brief(box.max.y - box.min.y), brief(box.max.z - box.min.z)));
    text += line("from", fmt::format("{} to {}", point(box.min), point(box.max)));
    text += line("volume", found.closed() ? fmt::format("{} mm3", brief(found.volume_mm3))
                                          : "none: the surface is not closed");
    text += line("area", fmt::format("{} mm2", brief(found.area_mm2)));
    text += line("shells", shells_text(found));
    text += line("closed", found.closed() ? "yes" : "no");
    if (found.sound())
        return text + line("defects", "none");
    std::string_view name = "defects";
    for (const Defect& defect : defects_of(found)) {
        if (defect.count == 0)
            continue;
        text += line(name, fmt::format("{} {}: {}", grouped(defect.count),
                                       defect.count == 1 ? defect.one : defect.many, defect.meaning));
        name = "";
    }
    return text;
}

Json parts_json(const Plate& plate) {
    Json parts = Json::array();
    for (const PlatePart& part : plate.parts)
        parts.push_back({{"label", part.label},
                         {"triangles", plate.shapes[part.shape].mesh.size()},
                         {"bbox", box_json(part.box)}});
    return parts;
}

Json mesh_json(const MeshFile& file, const Inspection& found, const Plate& plate) {
    Json json = {{"path", file.path},
                 {"format", format_name(file.format)},
                 {"unit", unit_name(plate.files.front().unit_mm)},
                 {"triangles", file.stored_triangles},
                 {"vertices", found.vertices},
                 {"bbox", box_json(found.box)},
                 {"volume_mm3", found.volume_mm3},
                 {"area_mm2", found.area_mm2},
                 {"closed", found.closed()},
                 {"shells", found.shells},
                 {"cavities", found.cavities},
                 {"defects", defects_json(found)}};
    if (plate.parts.size() > 1)
        json["parts"] = parts_json(plate);
    return json;
}

int tell_mesh(const InfoArguments& arguments, const MeshFile& file, const Context& context,
              const Execution& execution) {
    for (const std::string& warning : file.warnings)
        context.messages.warn(warning);
    const Plate plate =
        load_plate({.path = file.path, .unit_mm = arguments.placement.unit_mm()}, file, execution);
    const Inspection found = inspect(weld(joined(plate, execution), execution), execution);
    context.messages.result(arguments.json ? json_text(mesh_json(file, found, plate))
                                           : mesh_text(file, found, plate));
    if (arguments.strict && !found.sound())
        throw Error(ErrorKind::defect, fmt::format("{}: the mesh has defects", file.path));
    return 0;
}

struct LayerTotals {
    std::uint64_t contours = 0;
    std::uint64_t open_chains = 0;
    std::uint64_t points = 0;
    double volume_mm3 = 0;
};

LayerTotals totals_of(const LayerFile& file) {
    LayerTotals totals;
    for (const LayerPart& part : file.parts)
        for (const Layer& layer : part.layers) {
            const LayerMeasure measured = measure(layer);
            totals.contours += measured.contours;
            totals.open_chains += measured.open_chains;
            totals.points += measured.points;
            totals.volume_mm3 += measured.area_mm2 * layer.thickness();
        }
    return totals;
}

std::vector<std::string> labels_of(const LayerFile& file) {
    std::vector<std::string> labels;
    for (const LayerPart& part : file.parts)
        labels.push_back(part.label);
    return labels;
}

std::string layers_text(const LayerFile& file, const LayerTotals& totals) {
    std::string text = fmt::format("{}: slice file, {}\n", one_line(file.path), file.format);
    std::string_view name = file.parts.size() == 1 ? "label" : "parts";
    for (const std::string& label : labels_of(file)) {
        if (file.parts.size() == 1 && label.empty())
            continue;
        text += line(name, label.empty() ? "(without a label)" : one_line(label));
        name = "";
    }
    const LayerStack& layers = file.parts.front().layers;
    text += line("layers", grouped(layers.size()));
    if (!layers.empty())
        text += line("from",
                     fmt::format("z = {} to {} mm", brief(layers.front().bottom), brief(layers.back().top)));
    text += line("contours", grouped(totals.contours));
    text += line("open chains", totals.open_chains == 0 ? "none" : grouped(totals.open_chains));
    text += line("points", grouped(totals.points));
    text += line("volume", fmt::format("{} mm3", brief(totals.volume_mm3)));
    return text;
}

Json layers_json(const LayerFile& file, const LayerTotals& totals) {
    const LayerStack& layers = file.parts.front().layers;
    return {{"path", file.path},
            {"format", file.format},
            {"label", file.parts.front().label},
            {"parts", labels_of(file)},
            {"units_mm", file.units_mm},
            {"layers", layers.size()},
            {"z_range", layers.empty() ? Json() : Json{layers.front().bottom, layers.back().top}},
            {"contours", totals.contours},
            {"open_chains", totals.open_chains},
            {"points", totals.points},
            {"volume_mm3", totals.volume_mm3}};
}

int tell_layers(const InfoArguments& arguments, const LayerFile& file, const Context& context) {
    for (const std::string& warning : file.warnings)
        context.messages.warn(warning);
    if (arguments.placement.given())
        throw Error(ErrorKind::usage,
                    fmt::format("{}: --unit is for meshes; a slice file knows its unit", file.path));
    const LayerTotals totals = totals_of(file);
    context.messages.result(arguments.json ? json_text(layers_json(file, totals))
                                           : layers_text(file, totals));
    if (arguments.strict && totals.open_chains > 0)
        throw Error(ErrorKind::defect,
                    fmt::format("{}: has {}", file.path, counted(totals.open_chains, "open chain")));
    return 0;
}

int run_info(const InfoArguments& arguments, const Context& context) {
    const Execution execution = arguments.run.execution(context);
    const auto file = read_either(arguments.input, {.strict = arguments.strict}, execution);
    if (const auto* mesh = std::get_if<MeshFile>(&file))
        return tell_mesh(arguments, *mesh, context, execution);
    return tell_layers(arguments, std::get<LayerFile>(file), context);
}

} // namespace

Command info_command() {
    const auto arguments = std::make_shared<InfoArguments>();
    return {.name = "info",
            .summary = "what is in a mesh or slice file: size, volume, defects",
            .description =
                "Tells what a file holds. Of a mesh (STL, OBJ, PLY, OFF): size, volume, area, shells, and "
                "every kind of "
                "defect with what it means for slicing. Of a slice file (CLI, SVG): layers, contours, "
                "points and volume. Nothing is repaired or written.",
            .operands = {{.placeholder = "FILE",
                          .help = "a mesh or a slice file; - is standard input",
                          .set =
                              [arguments](const std::string& text) {
                                  arguments->input = text;
                              }}},
            .groups = {{"What is told",
                        {flag("json", "print JSON", arguments->json), unit_option(arguments->placement.unit),
                         flag("strict", "exit with code 4 where there is any defect", arguments->strict)}},
                       run_options(arguments->run),
                       common_options(true)},
            .examples = {{"lamella info part.stl", "is it closed, how large is it?"},
                         {"lamella info part.cli --json", "for programs"}},
            .run = [arguments](const Context& context) {
                return run_info(*arguments, context);
            }};
}

} // namespace lamella::app

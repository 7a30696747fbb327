#include "lamella/core/error.hpp"
#include "lamella/inputs/read_file.hpp"
#include "lamella/jobs/repair_policies.hpp"
#include "lamella/jobs/verify.hpp"

#include "command_line.hpp"
#include "commands.hpp"
#include "failure.hpp"
#include "figures.hpp"
#include "layering_options.hpp"
#include "numbers.hpp"
#include "options.hpp"
#include "repair_options.hpp"
#include "scan_options.hpp"
#include "standard_streams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace lamella::app {
namespace {

struct VerifyArguments {
    std::string input;
    std::string mesh;
    std::string slice_at;
    double tolerance = 0;
    std::optional<double> snap;
    bool strict = false;
    bool json = false;
    PlacementOptions placement;
    RepairPolicies repair;
    LayerStepOptions making;
    bool scan = false;
    ScanArguments scanning;
    ReadLimits limits;
    RunOptions run;
};

Json heights_json(const std::optional<CoveredHeights>& heights, const Findings& findings) {
    if (!heights)
        return {};
    return {{"layers", {heights->bottom, heights->top}},
            {"mesh", {heights->mesh_bottom, heights->mesh_top}},
            {"layers_above", heights->layers_above},
            {"layers_below", heights->layers_below},
            {"gaps", findings.of(FindingKind::layer_gaps).count},
            {"gaps_mm", findings.of(FindingKind::layer_gaps).amount}};
}

std::string heights_text(const std::optional<CoveredHeights>& heights, const Findings& findings) {
    if (!heights)
        return {};
    const double whole = heights->mesh_top - heights->mesh_bottom;
    const double covered = std::min(heights->top, heights->mesh_top) -
                           std::max(heights->bottom, heights->mesh_bottom) -
                           findings.of(FindingKind::layer_gaps).amount;
    std::string text =
        fmt::format("  layers from z = {} to {} mm, of a mesh from {} to {} mm: {:.4g} % of its height",
                    height(heights->bottom), height(heights->top), height(heights->mesh_bottom),
                    height(heights->mesh_top), whole > 0 ? 100 * std::max(0.0, covered) / whole : 0);
    for (const auto& [layers, where] :
         {std::pair{heights->layers_above, "above"}, std::pair{heights->layers_below, "below"}})
        if (layers > 0)
            text += fmt::format("; {} {} {} it", grouped(layers), layers == 1 ? "layer lies" : "layers lie",
                                where);
    return text + "\n";
}

/// Adds the numbers of the findings of a check, and their texts.
void add_findings(Json& object, const Findings& findings, FindingOrigin check) {
    for (const FindingNumber& number : findings.numbers(check))
        std::visit([&](auto value) { object[number.key] = value; }, number.value);
    object["findings"] = findings.texts();
}

/// Returns an object whose keys have this order. The numbers of further kinds of findings follow.
Json with_keys(std::initializer_list<const char*> keys) {
    Json object;
    for (const char* key : keys)
        object[key] = nullptr;
    return object;
}

Json verification_json(const Verification& found) {
    Json object = with_keys({"layers", "contours", "open_chains", "crossings", "misoriented", "overlapping",
                             "volume_mm3", "max_area_error_mm2", "displaced", "height_overlaps", "hatches",
                             "heights", "findings", "hint"});
    object["layers"] = found.layers;
    object["contours"] = found.contours;
    object["volume_mm3"] = found.volume_mm3;
    object["heights"] = heights_json(found.heights, found.findings);
    add_findings(object, found.findings, FindingOrigin::layers);
    if (found.max_area_error_mm2)
        object["max_area_error_mm2"] = *found.max_area_error_mm2;
    if (!found.open_layers.empty()) {
        Json& layers = object["open_layers"] = Json::array();
        for (const Verification::OpenLayer& layer : found.open_layers) {
            layers.push_back({{"index", layer.index}, {"z", layer.z}});
            layers.back().update(open_gaps_json(layer.gaps));
        }
    }
    return object;
}

bool areas_agree(const Verification& found) {
    return found.findings.count(FindingKind::other_areas) == 0;
}

std::string verification_text(const std::string& mesh, const Verification& found, const std::string& hint) {
    std::string text;
    for (const std::string& finding : found.findings.texts())
        text += fmt::format("  {}\n", with_options(finding));
    text += fmt::format("  {}, {}, {}, volume {} mm3\n", counted(found.layers, "layer"),
                        counted(found.contours, "contour"), counted(found.points, "point"),
                        brief(found.volume_mm3));
    if (found.max_area_error_mm2)
        text +=
            fmt::format("  areas differ from the sections of {} by at most {} mm2{}\n", one_line(mesh),
                        brief(*found.max_area_error_mm2), areas_agree(found) ? ", as rounding allows" : "");
    if (!hint.empty())
        text += fmt::format("  {}\n", hint);
    text += heights_text(found.heights, found.findings);
    if (found.ok())
        text += fmt::format(
            "  every contour is closed, none cross, holes and outer contours run the right way{}\n",
            mesh.empty() ? "; --mesh part.stl would check areas and places, too" : "");
    return text;
}

Json vectors_json(bool strategy, const VectorVerification& found) {
    Json object =
        with_keys({"layers", "contour_vectors", "hatch_vectors", "open_chains", "crossings", "misoriented",
                   "outside", "too_short", "inverted_rings", "inverted_mm3", "height_overlaps", "unbounded",
                   "unreached_layers", "unreached_mm2", "heights", "findings", "hint"});
    object["layers"] = found.layers;
    object["contour_vectors"] = found.contour_vectors;
    object["hatch_vectors"] = found.hatch_vectors;
    object["heights"] = heights_json(found.heights, found.findings);
    add_findings(object, found.findings, FindingOrigin::vectors);
    if (!strategy)
        object["unreached_mm2"] = nullptr;
    return object;
}

std::string vectors_text(const std::string& mesh, bool strategy, const VectorVerification& found,
                         const std::string& hint) {
    std::string text;
    for (const std::string& finding : found.findings.texts())
        text += fmt::format("  {}\n", finding);
    text += fmt::format("  {}, {} along contours and {} of hatches\n", counted(found.layers, "layer"),
                        counted(found.contour_vectors, "vector"), grouped(found.hatch_vectors));
    if (const double unreached = found.findings.of(FindingKind::unreached_layers).amount; unreached >= 5e-4)
        text += fmt::format("  {:.4g} mm2 of the material are reached by no vector\n", unreached);
    if (!hint.empty())
        text += fmt::format("  {}\n", hint);
    text += heights_text(found.heights, found.findings);
    const std::uint64_t all = found.contour_vectors + found.hatch_vectors;
    const std::uint64_t unbounded = found.findings.count(FindingKind::unbounded_vectors);
    if (found.ok() && unbounded < all)
        text += fmt::format("  all {}vectors lie within {}{}\n", unbounded > 0 ? "other " : "",
                            mesh.empty() ? "the outermost contours of their part" : one_line(mesh),
                            strategy ? ", as far from its edges as the strategy says"
                                     : "; --scan or --strategy FILE would check their distance from its "
                                       "edges and what they reach, too");
    else if (found.ok() && all > 0)
        text += "  whether they lie within the material was not checked; --mesh part.stl would do so\n";
    return text;
}

/// Returns a hint if layers differ from a mesh probably because the format does not store the heights of cuts
/// and the layers were not cut at mid-height. `agree(file, rule)` checks them again.
template <class Agree>
std::string cut_hint(const LayerFile& file, const Agree& agree) {
    const std::string guess =
        fmt::format("{} does not keep where layers were cut; the middle was assumed", file.format);
    for (const SliceAt at : {SliceAt::top, SliceAt::bottom}) {
        LayerFile moved = file;
        const PlaneRule rule = place_cuts(moved, at);
        if (agree(moved, rule))
            return fmt::format("{}: add --slice-at {}, by which they agree", guess,
                               at == SliceAt::top ? "top" : "bottom");
    }
    return guess +
           ": where they were cut elsewhere, say so by --slice-at, or check a file of a format that keeps "
           "cuts, such as json; where they were rounded before, say by how much with --tolerance MM";
}

/// Returns the file with its parts that are scan vectors or, if `vectors` is false, with the others.
LayerFile with_kind(const LayerFile& file, bool vectors) {
    std::vector<std::size_t> parts;
    for (std::size_t i = 0; i < file.parts.size(); ++i)
        if (file.parts[i].exposure.has_value() == vectors)
            parts.push_back(i);
    LayerFile some = file;
    static_cast<PlaneSource&>(some) = with_parts(file, std::move(parts));
    return some;
}

/// Rejects options about a mesh if there is none.
void check_arguments(const VerifyArguments& arguments) {
    if (!arguments.mesh.empty())
        return;
    if (arguments.placement.given())
        throw Error(ErrorKind::usage,
                    "unit, pose and direction are those of a mesh: name it with --mesh part.stl");
    if (arguments.snap)
        throw Error(ErrorKind::usage, "--snap says how a mesh is cut: name it with --mesh part.stl");
    if (arguments.repair.change_the_mesh() || arguments.repair.close_gaps_mm)
        throw Error(ErrorKind::usage,
                    "what was mended is mended in the mesh, too: name it with --mesh part.stl");
    if (arguments.making.steps().any())
        throw Error(ErrorKind::usage, "what was made of the layers is checked against a mesh: name it with "
                                      "--mesh part.stl");
}

/// Reads the mesh with which the file is compared, if there is one.
void read_mesh_into(VerifyOptions& options, const VerifyArguments& arguments, std::uint64_t held,
                    Messages& messages, const Execution& execution) {
    if (arguments.mesh.empty())
        return;
    const std::array inputs{PlateInput{.path = arguments.mesh,
                                       .unit_mm = arguments.placement.unit_mm(),
                                       .placement = arguments.placement.pose()}};
    Plate plate = load_plate(inputs, arguments.limits.of_meshes(held), execution);
    messages.warn_of(input_name(arguments.mesh), plate.files.front().warnings);
    constexpr std::uint64_t bytes_per_triangle = 64; // for joining all parts into one mesh
    if (plate.parts.size() > 1)
        check_memory(plate, bytes_per_triangle, options.max_memory, held);
    options.plate = repaired(std::move(plate), arguments.repair, execution).plate;
    options.mesh = joined(*options.plate, execution);
}

/// The result of the command.
struct Report {
    Json object;
    std::string text = {};
    bool ok = true;
};

/// Checks contours. If they differ from a mesh, and their cuts are only assumed, tries other cuts.
void report_layers(Report& report, const LayerFile& plain, VerifyOptions options, const std::string& mesh,
                   bool cut_is_assumed, const Execution& execution) {
    const Verification found = verify(plain, options, execution);
    report.ok = report.ok && found.ok();
    report.object.update(verification_json(found));
    const auto disagree = [](const Verification& one) {
        return !areas_agree(one) || one.findings.count(FindingKind::displaced_layers) > 0;
    };
    std::string hint;
    if (cut_is_assumed && disagree(found))
        hint = cut_hint(plain, [&](const LayerFile& moved, PlaneRule rule) {
            options.rule = rule;
            return !disagree(verify(moved, options, execution));
        });
    else if (!areas_agree(found))
        hint = "layers that were rounded before may be off by more: say by how much with --tolerance MM";
    if (!hint.empty())
        report.object["hint"] = hint;
    report.text += verification_text(mesh, found, hint);
}

/// Does so for scan vectors.
void report_vectors(Report& report, const LayerFile& vectors, VerifyOptions options, const std::string& mesh,
                    bool cut_is_assumed, const Execution& execution) {
    const VectorVerification found = verify_vectors(vectors, options, execution);
    report.ok = report.ok && found.ok();
    report.object["vectors"] = vectors_json(options.strategy.has_value(), found);
    const auto disagree = [](const VectorVerification& one) {
        return one.findings.count(FindingKind::outside_vectors) > 0 ||
               one.findings.count(FindingKind::misplaced_vectors) > 0 ||
               one.findings.count(FindingKind::unreached_layers) > 0;
    };
    std::string hint;
    if (cut_is_assumed && disagree(found))
        hint = cut_hint(vectors, [&](const LayerFile& moved, PlaneRule rule) {
            options.rule = rule;
            return !disagree(verify_vectors(moved, options, execution));
        });
    if (!hint.empty())
        report.object["vectors"]["hint"] = hint;
    report.text += vectors_text(mesh, options.strategy.has_value(), found, hint);
}

int run_verify(const VerifyArguments& arguments, const Context& context) {
    check_arguments(arguments);
    const Execution execution = arguments.run.execution(context);
    arguments.limits.prepare_memory();
    LayerFile file = read_layers(arguments.input, arguments.limits.of_layers(), execution);
    for (std::string& warning : file.warnings)
        warning = with_options(std::move(warning));
    VerifyOptions options{.snap_mm = arguments.snap.value_or(0),
                          .close_gaps_mm = arguments.repair.close_gaps_mm,
                          .steps = arguments.making.steps(),
                          .rounding = file.rounding,
                          .tolerance_mm = arguments.tolerance,
                          .max_memory = arguments.limits.max_memory.value_or(0)};
    if (arguments.scan || arguments.scanning.given())
        options.strategy = arguments.scanning.strategy();
    options.rule =
        arguments.slice_at.empty() ? file.rule : place_cuts(file, slice_at_named(arguments.slice_at));
    context.messages.warn_of(input_name(file.path), file.warnings);
    read_mesh_into(options, arguments, file.bytes, context.messages, execution);
    const bool cut_is_assumed =
        options.mesh && arguments.slice_at.empty() && !layer_format(file.format, {}).cuts;

    Report report{.object = {{"path", arguments.input}, {"ok", true}, {"warnings", file.warnings}},
                  .ok = !arguments.strict || file.warnings.empty()};
    if (arguments.strict)
        for (const std::string& warning : file.warnings)
            report.text += fmt::format("  {}\n", one_line(warning));
    if (const LayerFile plain = with_kind(file, false); !plain.parts.empty())
        report_layers(report, plain, options, arguments.mesh, cut_is_assumed, execution);
    if (const LayerFile vectors = with_kind(file, true); options.strategy || !vectors.parts.empty())
        report_vectors(report, vectors, options, arguments.mesh, cut_is_assumed, execution);
    report.object["ok"] = report.ok;
    context.messages.result(arguments.json ? json_text(report.object)
                                           : fmt::format("{}: {}\n{}", one_line(file.path),
                                                         report.ok ? "ok" : "NOT ok", report.text));
    if (!report.ok)
        throw Error(ErrorKind::defect, fmt::format("{}: the check failed", file.path));
    return 0;
}

} // namespace

Command verify_command() {
    const auto arguments = std::make_shared<VerifyArguments>();
    return {
        .name = "verify",
        .summary = "check the layers or scan vectors of a slice file",
        .description =
            "Checks the layers of a slice file: every contour is closed; outer contours run "
            "counter-clockwise and holes clockwise, by their nesting; no contour crosses another or itself. "
            "With --mesh, the area and the centre of every layer are compared with those of the section of "
            "that mesh, which is computed directly from its triangles; a layer that is rotated about its "
            "centre is not found. Scan vectors are checked, too: they must lie inside the mesh or, without "
            "--mesh, inside the outermost contour of their part. With --strategy or --scan, the check "
            "also covers their distance from the edge, the length of hatch lines, and whether vectors reach "
            "all "
            "of the material. Exit code 4: the check failed.",
        .operands = {{.placeholder = "FILE",
                      .help = "the slice file; - is standard input",
                      .set =
                          [arguments](const std::string& text) {
                              arguments->input = text;
                          }}},
        .groups =
            {{"checks",
              "Checks",
              {input_file("mesh",
                          "the mesh that was sliced; give the same options of input, repair and layer steps "
                          "as for slicing",
                          arguments->mesh),
               choice("slice-at", "WHERE",
                      "height within a layer at which it was cut, if the file does not state it correctly",
                      slice_at_names(), arguments->slice_at),
               snap_option(arguments->snap),
               row("tolerance", ValueKind::number, "MM",
                   "allowed error of points, ends of lines and cuts, in addition to the rounding of the "
                   "format, for layers that were rounded before (default: 0)",
                   [arguments](const std::string& text) { arguments->tolerance = parse_not_negative(text); }),
               flag("strict", "the check also fails if reading the file causes a warning", arguments->strict),
               flag("json", "print JSON", arguments->json)}},
             placement_options(arguments->placement, {include_option(arguments->limits)}),
             repair_options(arguments->repair),
             layer_step_options(arguments->making),
             scan_options(arguments->scanning,
                          {flag("scan", "check scan vectors against the default strategy", arguments->scan)}),
             run_options(arguments->run, {max_triangles_option(arguments->limits),
                                          max_memory_option(arguments->limits, "the files together take")}),
             common_options(true)},
        .examples = {{"lamella verify part.cli", "the slice file alone"},
                     {"lamella verify part.cli --mesh part.stl --rotate-x 90",
                      "the slice file against its mesh, which was rotated"},
                     {"lamella verify job.ilt --mesh part.stl --scan",
                      "scan vectors against the mesh and the default strategy"}},
        .run = [arguments](const Context& context) {
            return run_verify(*arguments, context);
        }};
}

} // namespace lamella::app

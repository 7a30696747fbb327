#include "lamella/core/error.hpp"
#include "lamella/inputs/read_file.hpp"
#include "lamella/jobs/compare_files.hpp"
#include "lamella/polygon/compare.hpp"

#include "command_line.hpp"
#include "commands.hpp"
#include "figures.hpp"
#include "numbers.hpp"
#include "options.hpp"
#include "standard_streams.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lamella::app {
namespace {

struct CompareArguments {
    std::vector<std::string> inputs;
    std::optional<double> tolerance;
    bool area_difference = false;
    bool json = false;
    ReadLimits limits;
    RunOptions run;
};

/// A plane that differs, with the details of its layers other than contours.
struct Differing {
    const ComparedPlane* plane;
    const PlaneDetails* details;
};

/// Returns the size of a difference, for sorting. A missing layer has the largest size.
double size_of(const Differing& one) {
    if (!one.plane->first || !one.plane->second)
        return std::numeric_limits<double>::infinity();
    if (one.details->other_pixels)
        return static_cast<double>(*one.details->other_pixels);
    return std::max(
        {one.plane->difference.distance_mm, one.details->hatch_distance_mm, one.details->height_distance_mm});
}

std::string contours_text(const LayerDifference& found) {
    std::string text;
    if (std::isinf(found.distance_mm))
        text += fmt::format("{} contours against {}", grouped(found.first.contours),
                            grouped(found.second.contours));
    else
        text += fmt::format("{} mm apart at ({}, {})", brief(found.distance_mm), brief(found.where.x),
                            brief(found.where.y));
    if (found.first.contours != found.second.contours && !std::isinf(found.distance_mm))
        text += fmt::format(", {} against {}", counted(found.first.contours, "contour"),
                            grouped(found.second.contours));
    if (found.first.open_chains != found.second.open_chains)
        text += fmt::format(", {} against {}", counted(found.first.open_chains, "open chain"),
                            grouped(found.second.open_chains));
    return text +
           fmt::format(", area {} against {} mm2", brief(found.first.area_mm2), brief(found.second.area_mm2));
}

std::string difference_text(const Differing& one, const CompareArguments& arguments) {
    const ComparedPlane& plane = *one.plane;
    const PlaneDetails& details = *one.details;
    if (!plane.first || !plane.second)
        return fmt::format("z = {} mm: only {} has {} there", height(plane.z),
                           one_line(input_name(arguments.inputs[plane.first ? 0 : 1])),
                           details.first_hatches + details.second_hatches == 0 ? "contours" : "vectors");
    std::vector<std::string> texts;
    if (details.other_pixels && *details.other_pixels > 0)
        texts.push_back(fmt::format("{} by up to {} of 255", counted(*details.other_pixels, "pixel"),
                                    details.largest_pixel_difference));
    else if (!plane.difference.same)
        texts.push_back(contours_text(plane.difference));
    if (details.first_hatches != details.second_hatches)
        texts.push_back(fmt::format("{} against {}", counted(details.first_hatches, "hatch line"),
                                    grouped(details.second_hatches)));
    else if (std::isinf(details.hatch_distance_mm))
        texts.emplace_back("hatch lines shared out otherwise among the parts");
    else if (details.hatch_distance_mm > 0)
        texts.push_back(fmt::format("ends of hatch lines {} mm apart at ({}, {})",
                                    brief(details.hatch_distance_mm), brief(details.hatch_where.x),
                                    brief(details.hatch_where.y)));
    if (!details.exposed_alike)
        texts.emplace_back("contours shared out otherwise among the exposures");
    if (!details.followed_alike)
        texts.emplace_back("contours followed in another order, or from other points");
    if (!details.heights_agree)
        texts.push_back(fmt::format("bottom or top {} mm apart", brief(details.height_distance_mm)));
    return fmt::format("z = {} mm: {}", height(plane.z), fmt::join(texts, ", "));
}

std::string exposures_text(const FileComparison& found, const CompareArguments& arguments) {
    constexpr std::size_t most = 12;
    std::string text;
    for (std::size_t i = 0; i < std::min(found.parameters.size(), most); ++i) {
        const ParameterDifference& one = found.parameters[i];
        text += fmt::format("    {}: {} {} against {}\n", one_line(one.label), one.parameter,
                            brief(one.first), brief(one.second));
    }
    if (found.parameters.size() > most)
        text += fmt::format("    and {} more\n", grouped(found.parameters.size() - most));
    const std::vector<std::string>* const only[] = {&found.only_first, &found.only_second};
    for (std::size_t i = 0; i < std::size(only); ++i)
        for (const std::string& label : *only[i])
            text += fmt::format("    {}: only in {}\n", one_line(label),
                                one_line(input_name(arguments.inputs[i])));
    if (!found.exposures_in_order)
        text += "    exposures come in another order\n";
    return text.empty() ? "" : "  parts are exposed otherwise:\n" + text;
}

Json plane_json(const Differing& one) {
    const ComparedPlane& plane = *one.plane;
    const PlaneDetails& details = *one.details;
    const bool both = plane.first && plane.second;
    const LayerDifference& found = plane.difference;
    const bool measured = both && std::isfinite(found.distance_mm);
    Json json{{"z", plane.z},
              {"in", both          ? "both"
                     : plane.first ? "first"
                                   : "second"},
              {"distance_mm", measured ? Json(found.distance_mm) : Json()},
              {"at", measured ? Json{found.where.x, found.where.y} : Json()},
              {"contours", {found.first.contours, found.second.contours}},
              {"open_chains", {found.first.open_chains, found.second.open_chains}},
              {"area_mm2", {found.first.area_mm2, found.second.area_mm2}},
              {"hatches", {details.first_hatches, details.second_hatches}},
              {"hatch_distance_mm",
               both && std::isfinite(details.hatch_distance_mm) ? Json(details.hatch_distance_mm) : Json()},
              {"height_distance_mm", both ? Json(details.height_distance_mm) : Json()},
              {"exposed_alike", both ? Json(details.exposed_alike) : Json()},
              {"followed_alike", both ? Json(details.followed_alike) : Json()}};
    if (details.other_pixels) {
        json["other_pixels"] = *details.other_pixels;
        json["largest_pixel_difference"] = details.largest_pixel_difference;
    }
    return json;
}

Json parameters_json(const std::vector<ParameterDifference>& parameters) {
    Json list = Json::array();
    for (const ParameterDifference& one : parameters)
        list.push_back({{"part", one.label},
                        {"parameter", one.parameter},
                        {"first", one.first},
                        {"second", one.second}});
    return list;
}

/// Area of the symmetric difference of two layers at a plane.
struct AreaDifference {
    double z = 0;
    double mm2 = 0;
};

/// Returns the area differences of all planes where they are not 0.
std::vector<AreaDifference> area_differences(const FileComparison& files) {
    std::vector<AreaDifference> differences;
    for (std::size_t i = 0; i < files.details.size(); ++i)
        if (const double mm2 = files.details[i].area_difference_mm2; mm2 != 0)
            differences.push_back({files.layers.planes[i].z, mm2});
    return differences;
}

double sum_of(const std::vector<AreaDifference>& differences) {
    double sum = 0;
    for (const AreaDifference& difference : differences)
        sum += difference.mm2;
    return sum;
}

std::string area_text(const std::vector<AreaDifference>& differences) {
    std::string text = fmt::format("  area in one file only: {} mm2 in all, in {}\n",
                                   brief(sum_of(differences)), counted(differences.size(), "layer"));
    for (const AreaDifference& difference : differences)
        text += fmt::format("    z = {} mm: {} mm2\n", height(difference.z), brief(difference.mm2));
    return text;
}

std::string cut_apart_text(const LayerFile& first, const LayerFile& second) {
    const Layer& one = first.planes.front();
    const Layer& other = second.planes.front();
    return fmt::format(
        "{} and {} are cut at different heights: the layer from z = {} to {} mm at {} mm in the first "
        "and at {} mm in the second; formats that do not keep the cut, such as CLI, are read as if it "
        "were in the middle",
        first.path, second.path, height(one.bottom), height(one.top), height(one.z), height(other.z));
}

int run_compare(const CompareArguments& arguments, const Context& context) {
    const Execution execution = arguments.run.execution(context);
    arguments.limits.prepare_memory();
    const LayerFile first = read_layers(arguments.inputs[0], arguments.limits.of_layers(), execution);
    const LayerFile second =
        read_layers(arguments.inputs[1], arguments.limits.of_layers(first.bytes), execution);
    for (const LayerFile* file : {&first, &second})
        context.messages.warn_of(input_name(file->path), file->warnings);

    const FileComparison files = compare_files(first, second,
                                               {.tolerance_mm = arguments.tolerance,
                                                .area_difference = arguments.area_difference,
                                                .max_memory = arguments.limits.max_memory.value_or(0)},
                                               execution);
    const StackComparison& found = files.layers;
    if (found.cut_apart)
        context.messages.warn(cut_apart_text(first, second));
    const double tolerance = found.tolerance_mm;
    std::vector<Differing> differing;
    std::uint64_t same = 0;
    for (std::size_t i = 0; i < found.planes.size(); ++i) {
        same += files.details[i].same ? 1 : 0;
        if (!found.planes[i].agree)
            differing.push_back({&found.planes[i], &files.details[i]});
    }
    const auto largest =
        std::max_element(differing.begin(), differing.end(),
                         [](const Differing& a, const Differing& b) { return size_of(a) < size_of(b); });

    std::vector<AreaDifference> areas;
    if (arguments.area_difference)
        areas = area_differences(files);

    if (arguments.json) {
        Json layers = Json::array();
        for (const Differing& plane : differing)
            layers.push_back(plane_json(plane));
        Json report{{"first", arguments.inputs[0]},
                    {"second", arguments.inputs[1]},
                    {"agree", files.agree()},
                    {"tolerance_mm", tolerance},
                    {"layers", found.planes.size()},
                    {"same", same},
                    {"differing", differing.size()},
                    {"first_difference", differing.empty() ? Json() : plane_json(differing.front())},
                    {"largest_difference", differing.empty() ? Json() : plane_json(*largest)},
                    {"differences", std::move(layers)},
                    {"parameters", parameters_json(files.parameters)},
                    {"only_first", files.only_first},
                    {"only_second", files.only_second},
                    {"exposures_in_order", files.exposures_in_order}};
        if (arguments.area_difference) {
            report["area_difference_mm2"] = sum_of(areas);
            report["area_differences"] = Json::array();
            for (const AreaDifference& area : areas)
                report["area_differences"].push_back({{"z", area.z}, {"area_mm2", area.mm2}});
        }
        context.messages.result(json_text(report));
    } else {
        std::string text = fmt::format(
            "{} and {}: {}\n  {} compared, {} of them the same to the last bit\n",
            one_line(input_name(arguments.inputs[0])), one_line(input_name(arguments.inputs[1])),
            differing.empty()
                ? fmt::format("{} within {} mm", files.agree() ? "agree" : "layers agree", brief(tolerance))
                : fmt::format("{} within {} mm",
                              differing.size() == 1 ? "1 layer does not agree"
                                                    : grouped(differing.size()) + " layers do not agree",
                              brief(tolerance)),
            counted(found.planes.size(), "layer"), grouped(same));
        if (!differing.empty()) {
            text +=
                fmt::format("  the first difference:   {}\n", difference_text(differing.front(), arguments));
            text += fmt::format("  the largest difference: {}\n", difference_text(*largest, arguments));
        }
        text += exposures_text(files, arguments);
        if (arguments.area_difference)
            text += area_text(areas);
        context.messages.result(text);
    }
    if (!files.agree())
        throw Error(ErrorKind::defect, fmt::format("{} and {} differ", input_name(arguments.inputs[0]),
                                                   input_name(arguments.inputs[1])));
    return 0;
}

} // namespace

Command compare_command() {
    const auto arguments = std::make_shared<CompareArguments>();
    const auto operand = [&](const char* placeholder, const char* help) {
        return Operand{.placeholder = placeholder, .help = help, .set = [arguments](const std::string& text) {
                           arguments->inputs.push_back(text);
                       }};
    };
    return {
        .name = "compare",
        .summary = "compare two slice files",
        .description =
            "Compares the layers of two slice files of any formats, plane by plane: the distance between "
            "their contours, areas and their centres, open contours, hatch lines one by one, heights, and "
            "the parameters of exposures; of jobs for resin printers, pixels and exposures. Prints the first "
            "and the largest difference. Exit code 4: they do "
            "not agree within the tolerance.",
        .operands = {operand("FIRST", "a slice file; - is standard input"),
                     operand("SECOND", "the slice file to compare it with")},
        .groups = {{"output",
                    "Comparison and output",
                    {row("tolerance", ValueKind::number, "MM",
                         "allowed distance between contours, ends of hatch lines and cuts (default: the "
                         "rounding of both formats)",
                         [arguments](const std::string& text) {
                             arguments->tolerance = parse_not_negative(text);
                         }),
                     flag("area-difference",
                          "also print the area that only one of the files has, plane by plane and in total",
                          arguments->area_difference),
                     flag("json", "print JSON", arguments->json)}},
                   run_options(arguments->run, {max_memory_option(arguments->limits,
                                                                  "the layers of both files together take")}),
                   common_options(true)},
        .examples = {{"lamella compare part.cli part.svg", "whether both files have the same layers"},
                     {"lamella compare old.cli new.cli --tolerance 0.01 --json", "the result for programs"}},
        .run = [arguments](const Context& context) {
            return run_compare(*arguments, context);
        }};
}

} // namespace lamella::app

#include "options.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/core/suggest.hpp"

#include "crash.hpp"
#include "heap.hpp"
#include "names.hpp"
#include "numbers.hpp"
#include "standard_streams.hpp"
#include "system/program_start.hpp"
#include "viewer/viewer_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <system_error>
#include <tuple>
#include <utility>

namespace lamella::app {
namespace {

struct Unit {
    std::string_view name;
    double mm;
};
// If a unit has several names, the first is printed.
constexpr std::array<Unit, 9> units{Unit{"mm", 1},  {"cm", 10},      {"m", 1000},
                                    {"inch", 25.4}, {"ft", 304.8},   {"um", 0.001},
                                    {"in", 25.4},   {"foot", 304.8}, {"micron", 0.001}};

Option scale_option(std::optional<std::vector<double>>& target) {
    return row("scale", ValueKind::numbers, "F|X,Y,Z",
               "scale by a factor, or by one factor along each axis; a negative one mirrors",
               [&target](const std::string& text) {
                   std::vector<double> factors = parse_numbers(text);
                   if (factors.size() != 1 && factors.size() != 3)
                       throw Error(ErrorKind::usage,
                                   fmt::format("\"{}\" is neither one number nor three", excerpt(text)));
                   if (std::find(factors.begin(), factors.end(), 0.0) != factors.end())
                       throw Error(ErrorKind::usage, "a factor of 0 leaves nothing to slice");
                   target = std::move(factors);
               });
}

/// Returns whether both names refer to the same file.
bool are_same(const std::string& first, const std::string& second) {
    std::error_code ignored;
    return place_of(first) == place_of(second) || std::filesystem::equivalent(first, second, ignored);
}

} // namespace

Option row(std::string name, ValueKind kind, std::string placeholder, std::string help,
           std::function<void(const std::string&)> set) {
    return {.name = std::move(name),
            .kind = kind,
            .placeholder = std::move(placeholder),
            .help = std::move(help),
            .set = std::move(set)};
}

Option flag(std::string name, std::string help, bool& target) {
    return row(std::move(name), ValueKind::flag, "", std::move(help),
               [&target](const std::string& text) { target = text == "true"; });
}

Option count(std::string name, std::string placeholder, std::string help,
             std::optional<std::uint64_t>& target) {
    Option option = row(std::move(name), ValueKind::count, std::move(placeholder), std::move(help),
                        [&target](const std::string& text) { target = parse_count(text); });
    if (target)
        option.preset = std::to_string(*target);
    return option;
}

Option length(std::string name, std::string help, std::optional<double>& target) {
    Option option = row(std::move(name), ValueKind::number, "MM", std::move(help),
                        [&target](const std::string& text) { target = parse_positive(text); });
    if (target)
        option.preset = exact(*target);
    return option;
}

Option number(std::string name, std::string placeholder, std::string help, std::optional<double>& target) {
    Option option = row(std::move(name), ValueKind::number, std::move(placeholder), std::move(help),
                        [&target](const std::string& text) { target = parse_number(text); });
    if (target)
        option.preset = exact(*target);
    return option;
}

Option triple(std::string name, std::string placeholder, std::string help,
              std::optional<std::array<double, 3>>& target) {
    return row(std::move(name), ValueKind::numbers, std::move(placeholder), std::move(help),
               [&target](const std::string& text) { target = parse_triple(text); });
}

Option choice(std::string name, std::string placeholder, std::string help, std::vector<std::string> choices,
              std::string& target) {
    Option option = row(std::move(name), ValueKind::choice, std::move(placeholder), std::move(help),
                        [&target](const std::string& text) { target = text; });
    option.choices = std::move(choices);
    option.preset = target;
    return option;
}

Option text(std::string name, std::string placeholder, std::string help, std::string& target) {
    Option option = row(std::move(name), ValueKind::text, std::move(placeholder), std::move(help),
                        [&target](const std::string& value) { target = value; });
    option.preset = target;
    return option;
}

Option input_file(std::string name, std::string help, std::string& target) {
    Option option = text(std::move(name), "FILE", std::move(help), target);
    option.kind = ValueKind::input;
    return option;
}

Option output_file(std::string name, std::string help, std::string& target,
                   std::vector<std::string_view> extensions) {
    return row(std::move(name), ValueKind::output, "FILE", std::move(help),
               [&target, extensions = std::move(extensions)](const std::string& path) {
                   const std::string extension = extension_of(path);
                   if (!extensions.empty() && !extension.empty() &&
                       std::find(extensions.begin(), extensions.end(), extension) == extensions.end())
                       throw Error(
                           ErrorKind::usage,
                           fmt::format("\"{}\" has the extension of another format; what is written is {}",
                                       path, fmt::join(extensions, " or ")));
                   target = path;
               });
}

Option byte_limit(std::string name, std::string help, std::optional<std::uint64_t>& target) {
    return row(std::move(name), ValueKind::text, "SIZE", std::move(help),
               [&target](const std::string& text) { target = parse_byte_size(text); });
}

Option unit_option(std::string& target) {
    Option option =
        choice("unit", "UNIT", "unit of the file, unless the file states it", names_of(units), target);
    option.preset = "mm";
    return option;
}

OptionGroup pose_options(PlacementOptions& target) {
    OptionGroup group{"placement", "Placement", {}, "The part is scaled, then rotated, then moved."};
    group.options.push_back(scale_option(target.scale));
    group.options.push_back(
        triple("rotate", "X,Y,Z", "rotate by these degrees about the x axis, then y, then z", target.rotate));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const char letter = "xyz"[axis];
        group.options.push_back(number(fmt::format("rotate-{}", letter), "DEG",
                                       fmt::format("rotate about the {} axis only", letter),
                                       target.rotate_axis[axis]));
    }
    group.options.push_back(triple("translate", "X,Y,Z", "move by these millimetres", target.translate));
    return group;
}

OptionGroup placement_options(PlacementOptions& target, const std::vector<Option>& more) {
    OptionGroup group = pose_options(target);
    group.name = "input";
    group.title = "Input";
    group.options.insert(group.options.begin(), unit_option(target.unit));
    group.options.push_back(triple("direction", "X,Y,Z",
                                   "slice along this direction instead of z: the part is rotated so that the "
                                   "direction points up",
                                   target.direction));
    group.options.insert(group.options.end(), more.begin(), more.end());
    return group;
}

bool PlacementOptions::given() const {
    return !unit.empty() || scale || rotate || rotate_axis[0] || rotate_axis[1] || rotate_axis[2] ||
           translate || direction;
}

std::string unit_name(double mm) {
    const auto found =
        std::find_if(units.begin(), units.end(), [&](const Unit& one) { return one.mm == mm; });
    return found != units.end() ? std::string(found->name) : fmt::format("{} mm", exact(mm));
}

std::optional<double> PlacementOptions::unit_mm() const {
    if (unit.empty())
        return std::nullopt;
    return std::find_if(units.begin(), units.end(), [&](const Unit& one) { return one.name == unit; })->mm;
}

Transform PlacementOptions::pose() const {
    Transform map;
    const auto then = [&map](const Transform& next) {
        map = compose(next, map);
    };
    if (scale)
        then(scale->size() == 1 ? scaling((*scale)[0], (*scale)[0], (*scale)[0])
                                : scaling((*scale)[0], (*scale)[1], (*scale)[2]));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const char letter = "xyz"[axis];
        if (rotate && rotate_axis[axis])
            throw Error(
                ErrorKind::usage,
                fmt::format("--rotate and --rotate-{} contradict each other: give one of them", letter));
        if (rotate)
            then(rotation(letter, (*rotate)[axis]));
        else if (rotate_axis[axis])
            then(rotation(letter, *rotate_axis[axis]));
    }
    if (translate)
        then(translation((*translate)[0], (*translate)[1], (*translate)[2]));
    if (direction)
        then(upright({(*direction)[0], (*direction)[1], (*direction)[2]}));
    return map;
}

OptionGroup run_options(RunOptions& target, const std::vector<Option>& more) {
    OptionGroup group{
        "limits",
        "Limits and processes",
        {count("threads", "N",
               "number of threads; 0, the default, uses all processors; the result is always the same",
               target.threads),
         choice("progress", "STYLE",
                "progress on standard error, as a bar or as one JSON object per line (without this option, a "
                "bar on a terminal only)",
                {"bar", "json", "none"}, target.progress),
         flag("quiet", "print no progress and no summary, but results, warnings and errors", target.quiet)}};
    group.options.front().letter = 'j';
    group.options.back().letter = 'q';
    group.options.insert(group.options.end(), more.begin(), more.end());
    return group;
}

Execution RunOptions::execution(const Context& context) const {
    if (threads.value_or(0) > most_threads)
        throw Error(ErrorKind::usage,
                    fmt::format("--threads: {} are too many, {} is the most", *threads, most_threads));
    const bool asked = find_option(context.command, "progress")->given.has_value();
    check_conflict(quiet, asked && progress != "none", "--quiet and --progress",
                   "one wants progress, the other none");
    const ProgressStyle style = quiet                                     ? ProgressStyle::quiet
                                : progress == "json"                      ? ProgressStyle::json
                                : progress == "none"                      ? ProgressStyle::none
                                : asked || terminal_columns().has_value() ? ProgressStyle::bar
                                                                          : ProgressStyle::none;
    context.messages.set_style(style);
    report_crashes(style);
    return {.threads = static_cast<unsigned>(threads.value_or(0)),
            .progress = [&messages = context.messages](const Progress& p) { messages.progress(p); },
            .cancel = context.cancel};
}

void ReadLimits::prepare_memory() const noexcept {
    if (max_memory)
        return_freed_memory();
}

MeshReadOptions ReadLimits::of_meshes(std::uint64_t held) const {
    return {.include = include,
            .max_triangles = max_triangles.value_or(0),
            .max_memory = max_memory.value_or(0),
            .held = held,
            .kept = KeptPlanes::if_faster};
}

LayerReadOptions ReadLimits::of_layers(std::uint64_t held) const {
    return {.max_memory = max_memory.value_or(0), .held = held, .kept = KeptPlanes::if_faster};
}

Option include_option(ReadLimits& target) {
    std::vector<std::string> words;
    for (const MeshRoleRow& known : mesh_roles())
        if (known.role != MeshRole::part)
            words.emplace_back(known.word);
    return row(
        "include", ValueKind::text, "WHAT",
        fmt::format("also read bodies that 3MF and AMF files mark with these roles, as solids: {}; commas "
                    "separate several. Without it, negative volumes are subtracted and other such bodies are "
                    "left out",
                    fmt::join(words, ", ")),
        [&target, words](const std::string& text) {
            try {
                target.include = roles_named(text);
            } catch (const Error& error) {
                throw Error(error.kind(), error.what() + did_you_mean(text, words));
            }
        });
}

Option max_triangles_option(ReadLimits& target) {
    return row("max-triangles", ValueKind::count, "N",
               "stop at a file with more than N triangles (exit code 5)", [&target](const std::string& text) {
                   target.max_triangles = parse_count(text);
                   if (*target.max_triangles == 0) // 0 means no limit in the library
                       throw Error(ErrorKind::usage, "there must be one at least");
               });
}

Option max_memory_option(ReadLimits& target, std::string_view what) {
    return byte_limit("max-memory",
                      fmt::format("stop if {} more memory than this, such as 500M or 2G (exit code 5); "
                                  "default: three quarters of the memory of the machine",
                                  what),
                      target.max_memory);
}

std::string formats_with(bool LayerFormat::*takes) {
    std::vector<std::string_view> names;
    for (const LayerFormat& format : layer_formats())
        if (format.*takes)
            names.push_back(format.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

void check_format(const LayerFormat& chosen, bool given, std::string_view option, bool LayerFormat::*takes) {
    if (given && !(chosen.*takes))
        throw Error(ErrorKind::usage, fmt::format("--{} goes with the formats {}, not with {}", option,
                                                  formats_with(takes), chosen.name));
}

std::vector<Option> layer_output_options(LayerOutputOptions& target) {
    // Options of some formats have no default, because a configuration file with all defaults must be valid
    // for any format.
    return {
        choice("format", "NAME",
               "format of the slice file; needed if the extension of its name does not determine it",
               names_of(layer_formats()), target.format),
        length("units-mm",
               fmt::format(
                   "{}: millimetres per unit of the file (default: 0.001); coordinates are rounded to whole "
                   "units in cli-ascii, in 3mf-toolpath and with --short",
                   formats_with(&LayerFormat::units)),
               target.units_mm),
        flag("short",
             fmt::format("{}: 16-bit coordinates, half the size", formats_with(&LayerFormat::short_form)),
             target.short_form),
        byte_limit(
            "max-output",
            "stop if the layers take more than this in the slice file, such as 500M or 2G (exit code 5)",
            target.max_output)};
}

const LayerFormat& LayerOutputOptions::chosen(const std::string& output) const {
    if (image.printer.empty())
        return layer_format(format, output);
    const ResinPrinter& printer = find_resin_printer(image.printer);
    if (!format.empty()) {
        const LayerFormat& named = layer_format(format, output);
        check_format(named, true, "printer", &LayerFormat::image);
        if (named.exposure && named.name != printer.format)
            throw Error(ErrorKind::usage, fmt::format("--format {}: the {} reads the format {}", named.name,
                                                      printer.name, printer.format));
        return named;
    }
    const std::string extension = extension_of(output);
    if (output != "-" && !extension.empty() && extension != printer.extension)
        throw Error(ErrorKind::usage,
                    fmt::format("'{}': the {} reads files with the extension {}; choose that, or png-zip as "
                                "--format for images alone",
                                one_line(output), printer.name, printer.extension));
    return layer_format(printer.format, output);
}

std::string_view LayerOutputOptions::file_extension(const std::string& folder) const {
    const LayerFormat& known = chosen(folder);
    return known.exposure && !image.printer.empty() ? find_resin_printer(image.printer).extension
                                                    : known.file_extension;
}

LayerWriteOptions LayerOutputOptions::write_options(const LayerFormat& chosen) const {
    check_format(chosen, units_mm.has_value(), "units-mm", &LayerFormat::units);
    check_format(chosen, short_form, "short", &LayerFormat::short_form);
    LayerWriteOptions options;
    options.units_mm = units_mm.value_or(options.units_mm);
    options.short_form = short_form;
    options.most_bytes = max_output.value_or(0);
    image.apply(chosen, options);
    options.page.viewer = viewer_page();
    options.page.no_viewer = no_viewer();
    return options;
}

namespace {

/// Parses two lengths, such as "0.2:0.5". Throws Error{usage}.
std::pair<double, double> parse_ramp(const std::string& text) {
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos)
        throw Error(ErrorKind::usage, "expected two lengths, such as 0.2:0.5");
    return {parse_positive(text.substr(0, colon)), parse_positive(text.substr(colon + 1))};
}

} // namespace

LayerSteps LayerStepOptions::steps() const {
    LayerSteps steps;
    for (const FillRule rule : {FillRule::nonzero, FillRule::evenodd, FillRule::positive})
        if (fill == fill_rule_name(rule))
            steps.fill = rule;
    steps.offset_mm = offset.value_or(0);
    if (bottom_offset)
        steps.bottom = {.inset_mm = bottom_offset->first, .height_mm = bottom_offset->second};
    for (const OffsetCorner corner : {OffsetCorner::bevel, OffsetCorner::round})
        if (offset_corners == offset_corner_name(corner))
            steps.offset_corners.shape = corner;
    if (steps.offset_corners.shape != OffsetCorner::mitre && !steps.offsets())
        throw Error(ErrorKind::usage, "--offset-corners goes with --offset or --bottom-offset");
    steps.largest_only = largest_only;
    steps.min_area_mm2 = min_area.value_or(0);
    steps.simplify_mm = simplify.value_or(0);
    return steps;
}

OptionGroup layer_step_options(LayerStepOptions& target) {
    std::vector<std::string> rules;
    for (const FillRule rule : {FillRule::none, FillRule::nonzero, FillRule::evenodd, FillRule::positive})
        rules.emplace_back(fill_rule_name(rule));
    std::vector<std::string> corners;
    for (const OffsetCorner corner : {OffsetCorner::mitre, OffsetCorner::bevel, OffsetCorner::round})
        corners.emplace_back(offset_corner_name(corner));
    return {"steps",
            "Layer steps (applied in this order)",
            {choice("fill", "RULE",
                    "unite contours that overlap; the rule decides by the winding number where material is",
                    std::move(rules), target.fill),
             number("offset", "MM", "move contours outwards, or inwards by a negative number", target.offset),
             row("bottom-offset", ValueKind::text, "MM:HEIGHT",
                 "move contours inwards by MM at the plate, and by less up to this HEIGHT above it, against "
                 "the bulge of the first layers (elephant's foot); holes grow",
                 [&target](const std::string& text) { target.bottom_offset = parse_ramp(text); }),
             choice("offset-corners", "SHAPE", "how offsets join sides that separate at a corner",
                    std::move(corners), target.offset_corners),
             flag("largest-only", "keep the largest body of each layer, with its holes", target.largest_only),
             row("min-area", ValueKind::number, "MM2", "drop bodies and holes of a smaller area",
                 [&target](const std::string& text) { target.min_area = parse_positive(text); }),
             length("simplify", "drop points; contours move by at most this distance", target.simplify)}};
}

std::string changes_text(const LayerSteps& steps, const LayerChanges& changes) {
    std::string options;
    for (const auto& [taken, option] :
         {std::pair{steps.fill != FillRule::none, "--fill"}, std::pair{steps.offset_mm != 0, "--offset"},
          std::pair{steps.bottom.inset_mm != 0, "--bottom-offset"},
          std::pair{steps.largest_only, "--largest-only"}, std::pair{steps.min_area_mm2 != 0, "--min-area"},
          std::pair{steps.simplify_mm != 0, "--simplify"}})
        if (taken)
            options += fmt::format("{}{}", options.empty() ? "" : ", ", option);
    std::string text = fmt::format("{} by {}", counted(changes.changed_layers, "layer"), options);
    if (changes.changed_layers == 0)
        return text;
    text += fmt::format(": area {} to {} mm2 in all", brief(changes.area_before_mm2),
                        brief(changes.area_after_mm2));
    for (const auto& [n, noun, what] : {std::tuple{changes.rings_united, "ring", "united"},
                                        std::tuple{changes.rings_reversed, "ring", "reversed"},
                                        std::tuple{changes.points_dropped, "point", "left out"}})
        if (n > 0)
            text += fmt::format(", {} {}", counted(n, noun), what);
    const std::uint64_t lost = changes.rings_dropped + changes.rings_vanished;
    return text + (lost == 0 ? "; no ring lost" : fmt::format("; {} lost", counted(lost, "ring")));
}

const std::vector<std::string>& slice_at_names() {
    static const std::vector<std::string> names{"bottom", "middle", "top"};
    return names;
}

void check_conflict(bool first, bool second, std::string_view names, std::string_view reason) {
    if (first && second)
        throw Error(ErrorKind::usage, fmt::format("{} contradict each other: {}", names, reason));
}

void check_outputs(const Command& command, const std::vector<NamedFile>& more) {
    std::vector<NamedFile> outputs = files_of(command, ValueKind::output);
    outputs.insert(outputs.end(), more.begin(), more.end());
    const std::vector<NamedFile> inputs = files_of(command, ValueKind::input);
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        const NamedFile& output = outputs[i];
        for (std::size_t k = 0; k < i; ++k)
            if (outputs[k].path == output.path ||
                (outputs[k].path != "-" && output.path != "-" && are_same(outputs[k].path, output.path)))
                throw Error(ErrorKind::usage,
                            fmt::format("{} and {} contradict each other: both would go to {}",
                                        outputs[k].name, output.name,
                                        output.path == "-" ? "standard output" : "the same file"));
        for (const NamedFile& input : inputs)
            if (input.path != "-" && output.path != "-" && are_same(input.path, output.path))
                throw Error(ErrorKind::usage,
                            fmt::format("{}: the output would overwrite the input; choose another name",
                                        output.path));
        if (output.path == "-" && output_is_closed())
            throw Error(ErrorKind::output, "standard output: cannot be written: it is closed");
    }
}

} // namespace lamella::app

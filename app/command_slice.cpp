#include "lamella/core/error.hpp"
#include "lamella/inputs/read_file.hpp"
#include "lamella/jobs/plate.hpp"
#include "lamella/jobs/slice_file.hpp"
#include "lamella/slices/layer_writer.hpp"
#include "lamella/slicing/slice.hpp"
#include "lamella/system/whole_file.hpp"

#include "batch.hpp"
#include "batch_files.hpp"
#include "command_line.hpp"
#include "commands.hpp"
#include "deadline.hpp"
#include "failure.hpp"
#include "figures.hpp"
#include "layering_options.hpp"
#include "names.hpp"
#include "numbers.hpp"
#include "options.hpp"
#include "page_notes.hpp"
#include "print_check_report.hpp"
#include "repair_options.hpp"
#include "resin_figures.hpp"
#include "run_warnings.hpp"
#include "scan_figures.hpp"
#include "scan_options.hpp"
#include "shard_stamp.hpp"
#include "standard_streams.hpp"
#include "text_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace lamella::app {
namespace {

/// Placement of the parts of one file.
struct InputOptions {
    PlacementOptions placement;
    std::optional<std::uint64_t> copies;
    std::optional<double> spacing;
    std::string label;
    bool support = false;
    bool negative = false;
};

struct SliceArguments {
    std::vector<PlateInput> inputs;
    /// Options of the last file so far; before the first file, options of all files.
    InputOptions of_input;
    InputOptions of_all;
    std::optional<std::array<double, 3>> build_volume;
    ReadLimits limits;

    std::string output;
    LayerOutputOptions writing;

    LayeringOptions layering;
    std::optional<std::pair<std::uint32_t, std::uint32_t>> shard;
    bool resume = false;

    RepairPolicies repair;
    std::string engine;
    bool inspect = false;
    bool strict = false;
    bool check = false;
    PrintCheckArguments checking;
    LayerStepOptions making;
    bool scan = false;
    ScanArguments scanning;
    std::string stats;
    std::string report;
    std::optional<double> timeout;
    RunOptions run;
    BatchArguments batch;
    Communicator* team = nullptr; ///< see slice_command
};

/// Returns options for writing the slice file, which have no effect without an output.
std::vector<Option> with_output(std::vector<Option> options) {
    for (Option& option : options)
        option.goes_with = "output";
    return options;
}

OptionGroup output_options(SliceArguments& target) {
    OptionGroup group{"output", "Output", {}};
    Option output = output_file("output",
                                "the slice file; its extension determines the format, and .gz after it "
                                "compresses it; - is standard output",
                                target.output);
    output.letter = 'o';
    group.options.push_back(std::move(output));
    for (Option& option : with_output(layer_output_options(target.writing)))
        group.options.push_back(std::move(option));
    group.options.push_back(
        output_file("report", "also write an HTML page that shows the layers and the figures of the run",
                    target.report, page_extensions()));
    group.options.push_back(output_file("stats",
                                        "write figures of the run and of every layer as JSON; - is standard "
                                        "output; FILE must not be in a folder that -o makes",
                                        target.stats));
    return group;
}

void finish_input(SliceArguments& target) {
    PlateInput& input = target.inputs.back();
    const InputOptions& options = target.of_input;
    input.unit_mm = options.placement.unit_mm();
    input.placement = options.placement.pose();
    input.copies = options.copies.value_or(input.copies);
    input.spacing_mm = options.spacing.value_or(input.spacing_mm);
    input.label = options.label;
    input.support = options.support;
    input.negative = options.negative;
}

void add_input(SliceArguments& target, const std::string& path) {
    if (target.inputs.empty())
        target.of_all = target.of_input;
    else
        finish_input(target);
    target.of_input = target.of_all;
    target.inputs.push_back({.path = path});
}

OptionGroup input_options(SliceArguments& target) {
    OptionGroup group = placement_options(target.of_input.placement);
    group.note =
        "Options after a file apply to that file, those before the first file to all. Parts are scaled, "
        "then rotated, then moved.";
    group.options.push_back(row("copies", ValueKind::count, "N",
                                "number of copies, side by side in rows (default: 1)",
                                [&target](const std::string& text) {
                                    target.of_input.copies = parse_count(text);
                                    if (*target.of_input.copies == 0)
                                        throw Error(ErrorKind::usage, "there must be one at least");
                                }));
    Option spacing =
        row("spacing", ValueKind::number, "MM", "gap between copies",
            [&target](const std::string& text) { target.of_input.spacing = parse_number(text); });
    spacing.goes_with = "copies";
    spacing.preset = exact(PlateInput{}.spacing_mm);
    group.options.push_back(std::move(spacing));
    group.options.push_back(
        text("label", "TEXT",
             "name of the part in the slice file (default: the name of its object, or of the file)",
             target.of_input.label));
    group.options.push_back(
        flag("support",
             "treat the parts of the file as supports, whatever it says: their scan vectors follow the "
             "rules for supports",
             target.of_input.support));
    group.options.push_back(flag("negative",
                                 "make no parts of the file: subtract its bodies from the parts of all "
                                 "other files",
                                 target.of_input.negative));
    for (Option& option : group.options)
        option.of_each_file = true;
    group.options.push_back(triple("build-volume", "X,Y,Z",
                                   "refuse parts that extend beyond the box from 0,0,0 to X,Y,Z",
                                   target.build_volume));
    group.options.push_back(include_option(target.limits));
    return group;
}

OptionGroup shard_options(SliceArguments& target) {
    Option resume = flag("resume",
                         "exit at once if the stamp beside the slice file records that this shard, its "
                         "--stats and its --report are complete",
                         target.resume);
    resume.goes_with = "shard";
    return {
        "shards",
        "Shards",
        {row("shard", ValueKind::text, "I/N",
             "slice only the I-th of N ranges of layers with about equal work; lamella merge joins the files",
             [&target](const std::string& text) { target.shard = parse_share(text); }),
         std::move(resume)}};
}

OptionGroup checking_options(SliceArguments& target) {
    Option engine = choice("engine", "NAME", "the slicing algorithm", names_of(engines()), target.engine);
    engine.preset = engines().front().name;
    OptionGroup group{
        "checks",
        "Checks and engine",
        {std::move(engine),
         flag("inspect", "count the defects of the mesh first, for --stats and the summary (takes longer)",
              target.inspect),
         flag("strict",
              "treat as errors: defects of the file or the mesh, data that the format cannot store, material "
              "that no scan vector reaches, steps that leave nothing, findings of --check; write no file",
              target.strict),
         flag("check",
              "find islands, overhangs and enclosed resin, as lamella check does, for the summary, --stats "
              "and --report",
              target.check)}};
    for (Option& option : print_check_options(target.checking)) {
        option.goes_with = "check";
        group.options.push_back(std::move(option));
    }
    return group;
}

OptionGroup timed_run_options(SliceArguments& target) {
    OptionGroup group = run_options(target.run);
    group.options.push_back(max_triangles_option(target.limits));
    group.options.push_back(byte_limit(
        "max-memory",
        "use at most this much memory, such as 500M or 2G (default: three quarters of the memory of the "
        "machine); larger STL files are sliced in ranges of planes, if necessary with temporary files in "
        "$TMPDIR or /var/tmp, with the same result; other jobs that do not fit end with exit code 5",
        target.limits.max_memory));
    group.options.push_back(
        row("timeout", ValueKind::number, "SECONDS",
            "stop after this time with exit code 5, report the progress, and leave no output",
            [&target](const std::string& text) { target.timeout = parse_positive(text); }));
    return group;
}

/// Returns the strategy if scan vectors are requested.
std::optional<ScanStrategy> strategy_of(const SliceArguments& arguments) {
    const bool scans = arguments.scan || !arguments.scanning.file.empty();
    if (!scans && !arguments.scanning.changes.empty())
        throw Error(ErrorKind::usage, fmt::format("--{} goes with --scan or --strategy",
                                                  arguments.scanning.changes.front().first));
    return scans ? std::optional(arguments.scanning.strategy()) : std::nullopt;
}

/// Checks that a shard reads and writes files, not standard streams, because its stamp records their
/// contents; and that its output can be merged.
void check_shard(const SliceArguments& arguments) {
    if (!arguments.shard)
        return;
    check_conflict(std::any_of(arguments.inputs.begin(), arguments.inputs.end(),
                               [](const PlateInput& input) { return input.path == "-"; }),
                   true, "- and --shard", "every shard has to read the whole mesh, from a file");
    check_conflict(arguments.output == "-", true, "--output - and --shard", "a shard is a file of its own");
    if (arguments.resume && arguments.output.empty())
        throw Error(ErrorKind::usage, "--resume goes with --output: a shard that is finished is a file");
    check_conflict(arguments.resume, arguments.stats == "-", "--resume and --stats -",
                   "a shard that is finished has no figures");
    if (arguments.output.empty())
        return;
    const LayerFormat& format = arguments.writing.chosen(arguments.output);
    if (format.one_way || format.image) // images have heights above the plate, so shards would overlap
        throw Error(
            ErrorKind::usage,
            fmt::format("--shard goes with files that lamella merge can read; {} is none", format.name));
}

/// Checks that no other result lies in the output folder, which is replaced as a whole.
void check_folder(const SliceArguments& arguments) {
    if (arguments.output.empty() || !arguments.writing.chosen(arguments.output).directory)
        return;
    const std::filesystem::path folder = place_of(arguments.output);
    for (const auto& [name, path] :
         {std::pair("--stats", arguments.stats), std::pair("--report", arguments.report)})
        for (std::filesystem::path place = place_of(path); !path.empty() && place.has_relative_path();
             place = place.parent_path())
            if (place.parent_path() == folder)
                throw Error(
                    ErrorKind::usage,
                    fmt::format("--output and {} contradict each other: {} would lie in the folder that "
                                "is made",
                                name, path));
}

/// Throws for an output that was given like an input.
void check_inputs(const SliceArguments& arguments) {
    if (!arguments.output.empty() || arguments.inputs.size() < 2)
        return;
    const std::string& last = arguments.inputs.back().path;
    const std::string extension = extension_of(last);
    std::error_code ignored;
    if (!extension.empty() && !std::filesystem::exists(last, ignored) &&
        std::any_of(layer_formats().begin(), layer_formats().end(),
                    [&](const LayerFormat& format) { return format.extension == extension; }))
        throw Error(ErrorKind::usage, fmt::format("{0}: there is no such file; did you mean -o {0}?", last));
}

FileJob make_job(const SliceArguments& arguments) {
    check_inputs(arguments);
    if (arguments.output.empty() && arguments.stats.empty() && arguments.report.empty())
        throw Error(ErrorKind::usage,
                    "where should the result go? Say -o part.cli (or --stats - for figures only)");
    check_shard(arguments);
    check_folder(arguments);

    FileJob job;
    job.inputs = arguments.inputs;
    if (arguments.build_volume) {
        const auto& [x, y, z] = *arguments.build_volume;
        job.build_volume = Point3{x, y, z};
    }
    job.include = arguments.limits.include;
    job.max_triangles = arguments.limits.max_triangles.value_or(0);
    job.max_memory = arguments.limits.max_memory.value_or(0);
    job.layering = arguments.layering.layering(job.max_memory);
    if (arguments.shard)
        job.shard = Shard{arguments.shard->first, arguments.shard->second};
    job.repair = arguments.repair;
    job.engine = arguments.engine;
    job.inspect = arguments.inspect;
    job.strict = arguments.strict;
    job.steps = arguments.making.steps();
    job.scan = strategy_of(arguments);
    if (arguments.check)
        job.check = arguments.checking.options(job.max_memory);
    job.layer_statistics = !arguments.stats.empty() || (!arguments.report.empty() && job.steps.any());
    job.output = arguments.output;
    if (!job.output.empty()) {
        const LayerFormat& format = arguments.writing.chosen(job.output);
        job.format = format.name;
        job.write = arguments.writing.write_options(format);
        job.image_cuts = arguments.writing.image.cuts.value_or(job.image_cuts);
    }
    job.write.strict = job.strict;
    job.write.page.title = title_of(job.inputs);
    if (!arguments.report.empty()) {
        job.report = {
            .path = arguments.report, .page = page_options(job.inputs.front().path), .notes = run_notes};
        job.report.page.title = title_of(job.inputs);
    }
    return job;
}

std::string summary(const FileJob& job, const FileResult& result) {
    const std::size_t parts = result.parts.size();
    std::string text = fmt::format(
        "read     {}{}: {}, {}\n", one_line(input_name(job.inputs.front().path)),
        job.inputs.size() == 1 ? "" : fmt::format(" and {} more", counted(job.inputs.size() - 1, "file")),
        counted(triangles_read(result), "triangle"), size_text(result.box));
    if (parts > 1)
        text += fmt::format("plate    {}: {}\n", counted(parts, "part"), labels_text(result.parts));
    text += fmt::format("sliced   {} from z = {} to {} mm: {}, {}{}\n",
                        counted(result.report.layers, "layer"), height(result.bottom), height(result.top),
                        counted(result.report.contours, "contour"), counted(result.report.points, "point"),
                        result.ranges == 0 ? "" : fmt::format(", in {}", counted(result.ranges, "range")));
    if (job.shard)
        text += fmt::format("shard    {} of {}: layers {} to {} of {}\n", job.shard->number, job.shard->count,
                            result.shard.begin, result.shard.end - 1, result.planned_layers);
    if (result.inspection)
        text +=
            fmt::format("mesh     {}\n",
                        result.unsound.empty()
                            ? "closed, consistently oriented, no defects"
                            : "has defects" + ask_info(one_line(result.files[result.unsound.front()].path)));
    for (const FileResult::MeshRepair& repair : result.repairs)
        text += repairs_text(repair.repairs);
    if (job.repair.close_gaps_mm)
        text += gaps_text(result.gaps);
    if (result.changes)
        text += fmt::format("changed  {}\n", changes_text(job.steps, *result.changes));
    if (job.scan)
        text += fmt::format("scan     {}\n", scan_text(result.exposures));
    if (result.check)
        text += fmt::format("checked  for printing\n{}", print_check_text(*result.check));
    using Seconds = FileResult::Seconds;
    std::string stages;
    for (const auto& [stage, seconds] : {std::pair(stage_name(Stage::read), &Seconds::read),
                                         {stage_name(Stage::weld), &Seconds::weld},
                                         {stage_name(Stage::link), &Seconds::link},
                                         {stage_name(Stage::slice), &Seconds::slice},
                                         {"end", &Seconds::end}})
        if (result.seconds.*seconds > 0)
            stages += fmt::format("{}{} {:.3f}", stages.empty() ? "" : ", ", stage, result.seconds.*seconds);
    text += fmt::format("took     {:.3f} s on {} ({})\n", result.seconds.total,
                        counted(result.threads, "thread"), stages);
    if (!result.format.empty())
        text += fmt::format("written  {}: {}, {}\n", one_line(output_name(job.output)), result.format,
                            byte_size(result.bytes));
    if (result.resin)
        text += as_lines(amount_figures(*result.resin));
    if (!job.report.path.empty())
        text += fmt::format("report   {}: open it with a browser\n", one_line(job.report.path));
    return text;
}

/// Returns the names of the files that are read before the meshes, which may be pipes to which nobody writes.
/// Without such files, returns `meshes`.
std::string files_before(const std::string& meshes, const SliceArguments& arguments) {
    std::vector<std::string> names;
    for (const std::string& path : {arguments.layering.z_list, arguments.scanning.file})
        if (!path.empty())
            names.push_back(one_line(input_name(path)));
    return names.empty() ? meshes : fmt::format("{}", fmt::join(names, " and "));
}

/// Returns the extension of a batch's outputs if `pattern` does not contain it; "" for formats of folders.
std::string_view batch_extension(const SliceArguments& arguments) {
    if (arguments.output.empty() || has_placeholder(arguments.output))
        return {};
    if (arguments.writing.format.empty() && arguments.writing.image.printer.empty() &&
        extension_of(arguments.output).empty())
        throw Error(ErrorKind::usage,
                    fmt::format("{} becomes a folder with a file for each mesh; choose their format, such as "
                                "--format cli",
                                arguments.output));
    return arguments.writing.file_extension(arguments.output);
}

int slice_batch(SliceArguments& arguments, const Context& context) {
    if (arguments.team != nullptr)
        throw Error(ErrorKind::usage, "--batch is for lamella: here all processes work on one plate");
    if (!arguments.inputs.empty())
        throw Error(ErrorKind::usage,
                    fmt::format("--batch and the file {} contradict each other: put it into the folder or "
                                "the list, too",
                                arguments.inputs.front().path));
    const bool to_stdout = arguments.output == "-" || arguments.stats == "-";
    check_conflict(true, to_stdout, "--batch and -", "standard output is where the results of the files go");
    check_conflict(true, !arguments.report.empty(), "--batch and --report", "a page shows one part");
    const std::vector<BatchItem> items =
        batch_items(arguments.batch, arguments.output, batch_extension(arguments), arguments.stats,
                    files_of(context.command, ValueKind::input));
    // All files have the options of the first one.
    add_input(arguments, items.front().input);
    finish_input(arguments);
    arguments.output = items.front().output;
    arguments.stats = items.front().stats;
    const Execution execution = arguments.run.execution(context);
    // Lists and strategies are read once, because they may come from pipes.
    FileJob model =
        Deadline(arguments.timeout, files_before(one_line(input_name(arguments.batch.source)), arguments),
                 context.messages, execution)
            .run([&](const Execution&) { return make_job(arguments); });
    check_conflict(model.shard.has_value(), true, "--batch and --shard", "share out the list instead");
    model.layer_statistics = true; // needed for the hashes
    Messages unheard;              // not printed; the results of the files contain the messages
    unheard.set_style(ProgressStyle::silent);
    const SliceItem slice = [&](const BatchItem& item, const Execution& given) {
        FileJob job = model;
        job.inputs.front().path = item.input;
        job.output = item.output;
        job.write.page.title = title_of(item.input);
        Deadline deadline(arguments.timeout, one_line(item.input), unheard, given);
        BatchResult result{deadline.run([&](const Execution& run) { return slice_file(job, run); }), {}, {}};
        result.warnings = run_warnings(job, result.file);
        if (!item.stats.empty())
            result.stats = json_text(stats_json(context.command, job, result.file));
        return result;
    };
    return run_batch(items, arguments.batch, slice, execution, context.messages);
}

/// Returns the path of the stamp for a shard with an output file; else "".
std::string stamp_of(const SliceArguments& arguments) {
    return arguments.shard && !arguments.output.empty() && arguments.output != "-"
               ? stamp_path(arguments.output)
               : std::string();
}

void check_files_of_team(const Command& command) {
    for (const NamedFile& input : files_of(command, ValueKind::input))
        if (input.path == "-")
            throw Error(
                ErrorKind::usage,
                fmt::format("{}: standard input reaches one of the processes only; give the name of a file",
                            input.name));
}

/// Throws on all processes if their jobs differ.
void check_job_of_team(const Command& command, const FileJob& job, Communicator& processes) {
    const std::vector<std::string> all = processes.gather(compact_json(job_parameters(command, job)));
    for (const std::string& other : all)
        if (const std::string difference = first_difference(Json::parse(all.front()), Json::parse(other));
            !difference.empty())
            throw Error(ErrorKind::usage,
                        fmt::format("the processes were not given one job: {}", difference));
}

/// Checks that statistics and stamp can be written, because this would otherwise fail only after hours of
/// slicing. All processes fail together.
void check_positions(const SliceArguments& arguments) {
    Communicator* const team = arguments.team;
    std::string refusal;
    if (team == nullptr || team->process() == 0) {
        try {
            for (const std::string& path : {arguments.stats, stamp_of(arguments)})
                if (!path.empty())
                    check_writable(path);
        } catch (const Error& error) {
            refusal = error.what();
        }
    }
    if (team != nullptr)
        refusal = team->gather(refusal).front();
    if (!refusal.empty())
        throw Error(ErrorKind::output, refusal);
}

int run_slice(SliceArguments& arguments, const Context& context) {
    if (arguments.team != nullptr)
        check_files_of_team(context.command);
    if (!arguments.batch.source.empty())
        return slice_batch(arguments, context);
    if (arguments.inputs.empty())
        throw Error(ErrorKind::usage, "lamella slice needs FILE: a mesh, or --batch for many of them; see "
                                      "lamella slice --help");
    std::vector<NamedFile> stamp;
    if (const std::string path = stamp_of(arguments); !path.empty())
        stamp.push_back({"the stamp of the shard", path});
    check_outputs(context.command, stamp);
    finish_input(arguments);
    Communicator* const team = arguments.team;
    const Execution execution = arguments.run.execution(context);
    FileJob job;
    Json origin; // origin of a shard with a stamp
    const std::string meshes = one_line(inputs_name(arguments.inputs));
    Deadline deadline(arguments.timeout, files_before(meshes, arguments), context.messages, execution);
    const auto slice = [&](const Execution& run) -> std::optional<FileResult> {
        job = make_job(arguments);
        deadline.note_input(meshes);
        if (job.shard && team != nullptr)
            throw Error(ErrorKind::usage, "--shard is for lamella: here the layers are shared out already");
        if (job.shard && !job.output.empty()) {
            origin = shard_origin(context.command, job, run);
            if (arguments.resume && is_finished_shard(job, arguments.stats, origin, run))
                return std::nullopt;
        }
        if (team != nullptr)
            check_job_of_team(context.command, job, *team);
        check_positions(arguments);
        if (!origin.is_null())
            remove_stamp_without_output(job.output);
        return team != nullptr ? slice_file(job, run, *team) : slice_file(job, run);
    };
    const std::optional<FileResult> outcome = deadline.run(slice);
    deadline.note_output(job.output);
    if (!outcome) {
        context.messages.written(fmt::format("{}: shard {}/{} is finished\n", one_line(job.output),
                                             job.shard->number, job.shard->count),
                                 job.output);
        return 0;
    }
    const FileResult& result = *outcome;
    if (team != nullptr && team->process() != 0)
        return 0;
    for (const std::string& warning : run_warnings(job, result))
        context.messages.warn(warning);
    after_output(job.output, [&] {
        if (!arguments.stats.empty()) {
            Json stats = stats_json(context.command, job, result);
            if (team != nullptr)
                stats["processes"] = processes_json(result.processes);
            const std::string text = json_text(stats);
            if (arguments.stats == "-")
                context.messages.result(text);
            else
                write_text_file(arguments.stats, text);
        }
        // The stamp is written last, because it marks the shard as finished, with all requested results.
        if (!origin.is_null())
            stamp_shard(job, arguments.stats, result, origin, execution);
    });
    const bool to_output = arguments.output == "-" || arguments.stats == "-" || arguments.report == "-";
    context.messages.written(summary(job, result), to_output ? "-" : arguments.output);
    finish_printing(); // while the deadline still applies
    return 0;
}

} // namespace

Command slice_command(Communicator* team) {
    const auto arguments = std::make_shared<SliceArguments>();
    arguments->team = team;
    OptionGroup images = image_options(arguments->writing.image);
    images.options.push_back(z_antialias_option(arguments->writing.image));
    images.options = with_output(std::move(images.options));
    return {
        .name = "slice",
        .summary = "cut a mesh into layers and write a slice file",
        .description =
            "Cuts meshes into layers and writes their contours: outer contours counter-clockwise, holes "
            "clockwise. Several files, and all objects that a 3MF or AMF file places, make up a build plate: "
            "they are cut on common planes, and stay separate in formats that distinguish parts. A mesh is "
            "repaired only if options ask for it. Where it has a hole, contours stay open; the slice file "
            "marks them if its format can, and a warning counts them. The result does not depend on the "
            "number of threads or the order of the triangles.",
        .operands = {{.placeholder = "FILE",
                      .help = fmt::format("a mesh (.{}); - is standard input",
                                          fmt::join(mesh_extensions(), ", .")),
                      .required = false,
                      .repeated = true,
                      .own_options = true,
                      .set =
                          [arguments](const std::string& text) {
                              add_input(*arguments, text);
                          }}},
        .groups = {output_options(*arguments), layering_options(arguments->layering),
                   input_options(*arguments), repair_options(arguments->repair),
                   layer_step_options(arguments->making),
                   scan_options(arguments->scanning,
                                {flag("scan", "write scan vectors instead of contours", arguments->scan)}),
                   std::move(images), checking_options(*arguments), batch_options(arguments->batch),
                   shard_options(*arguments), timed_run_options(*arguments), common_options(true)},
        .examples = {{"lamella slice part.stl -o part.cli --layer-height 0.05",
                      "a binary CLI file, layers of 0.05 mm"},
                     {"lamella slice part.stl -o part.sl1 --layer-height 0.05 --exposure 8",
                      "a job for an Original Prusa SL1"},
                     {"lamella slice part.stl -o part.svg --unit inch --rotate-x 90",
                      "a part in inches, rotated by 90 degrees, as SVG"},
                     {"lamella slice a.stl --copies 4 b.stl --translate 60,0,0 -o plate.cli",
                      "a plate with four copies of one part and one of another"},
                     {"lamella slice part.stl -o job.cli --layer-height 0.03 --strategy 316l.toml",
                      "scan vectors for a powder-bed machine"},
                     {"lamella slice part.stl --stats - --layers 100:110", "only the figures of ten layers"},
                     {"lamella slice part.stl -o part.3.cli --shard 3/8 --resume",
                      "the third of eight shards, unless it is complete"},
                     {"lamella slice --batch parts -o layers --format cli",
                      "each mesh of a folder by itself, into another folder"},
                     {"lamella slice part.stl -o part.cli --config machine.toml",
                      "with the options in a file"}},
        .run = [arguments](const Context& context) {
            return run_slice(*arguments, context);
        }};
}

} // namespace lamella::app

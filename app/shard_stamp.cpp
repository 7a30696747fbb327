#include "shard_stamp.hpp"

#include "lamella/container/file_hash.hpp"
#include "lamella/core/error.hpp"
#include "lamella/core/version.hpp"

#include "config_file.hpp"
#include "strategy_file.hpp"
#include "text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>

namespace lamella::app {
namespace {

/// Returns the hash of a file as text, since a JSON number loses digits beyond 2^53.
std::string hash_text(const std::string& path, const Execution& execution) {
    return fmt::format("{:016x}", file_hash(path, execution));
}

/// Options that do not affect the bytes of the slice file, or that the origin contains in another form.
constexpr std::array<std::string_view, 16> not_of_the_origin{
    "shard",   "resume",   "output", "format", "report",     "stats",         "engine",     "inspect",
    "threads", "progress", "quiet",  "config", "max-memory", "max-triangles", "max-output", "timeout"};

Json input_json(const PlateInput& input) {
    Json placement = Json::array();
    for (const auto& row : input.placement.linear)
        placement.insert(placement.end(), {row[0], row[1], row[2]});
    placement.insert(placement.end(),
                     {input.placement.offset[0], input.placement.offset[1], input.placement.offset[2]});
    return {{"unit_mm", input.unit_mm.value_or(0)},
            {"placement", std::move(placement)},
            {"copies", input.copies},
            {"spacing", input.spacing_mm},
            {"label", input.label},
            {"support", input.support},
            {"negative", input.negative}};
}

Json read_stamp(const std::string& output) {
    const std::string path = stamp_path(output);
    Json stamp = Json::parse(read_text_file(path), nullptr, false);
    if (!stamp.is_object() || !stamp.contains("output") || !stamp.value("origin", Json()).is_object())
        throw Error(ErrorKind::input,
                    fmt::format("{}: is no stamp of a shard; slice this shard again", path));
    return stamp;
}

Json output_json(const std::string& path, const Execution& execution) {
    std::string hash = hash_text(path, execution); // throws if the file cannot be read
    std::error_code ignored;
    return {{"bytes", std::filesystem::file_size(path, ignored)}, {"hash", std::move(hash)}};
}

/// Does the same for a further result file. Returns null if it was not requested, and for pipes and devices,
/// which keep no data.
Json file_json(const std::string& path, const Execution& execution) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(path, ignored) ? output_json(path, execution) : Json();
}

struct Stamped {
    std::string path;
    Json stamp;
    std::uint64_t begin;
    std::uint64_t end;
};

Stamped stamped(const std::string& path, const Execution& execution) {
    Stamped file{path, read_stamp(path), 0, 0};
    std::uint64_t all = 0;
    try {
        file.begin = file.stamp.at("layers").at(0).get<std::uint64_t>();
        file.end = file.stamp.at("layers").at(1).get<std::uint64_t>();
        all = file.stamp.at("of").get<std::uint64_t>();
    } catch (const Json::exception&) {
        throw Error(ErrorKind::input,
                    fmt::format("{}: is no stamp of a shard; slice this shard again", stamp_path(path)));
    }
    std::error_code ignored;
    if (std::filesystem::status(path, ignored).type() == std::filesystem::file_type::not_found)
        throw Error(
            ErrorKind::input,
            fmt::format("{}: there is no such file, only its stamp: layers {} to {} of {} are missing; "
                        "slice this shard again",
                        path, file.begin, file.end - 1, all));
    if (file.stamp["output"] != output_json(path, execution))
        throw Error(ErrorKind::input,
                    fmt::format("{}: is not as it was when its stamp {} was written; slice this shard again",
                                path, stamp_path(path)));
    return file;
}

/// Throws unless both belong to one job.
void check_origins(const Stamped& a, const Stamped& b) {
    const Json& of_a = a.stamp["origin"];
    const Json& of_b = b.stamp["origin"];
    if (const std::string difference = first_difference(of_a, of_b); !difference.empty())
        throw Error(ErrorKind::input, fmt::format("{} and {} are not shards of one job: by their stamps {}",
                                                  a.path, b.path, difference));
}

} // namespace

std::string stamp_path(const std::string& output) {
    return output + ".shard";
}

std::string first_difference(const Json& one, const Json& other) {
    const Json changes = Json::diff(one, other); // independent of the order of keys
    if (changes.empty())
        return {};
    const Json::json_pointer first(changes[0]["path"].get<std::string>());
    const auto value_in = [&](const Json& object) {
        return object.contains(first) ? compact_json(object[first]) : "nothing";
    };
    return fmt::format("{} is {} in the one and {} in the other", first.to_string().substr(1), value_in(one),
                       value_in(other));
}

Json job_parameters(const Command& command, const FileJob& job) {
    Json options = options_in_effect(command);
    for (const std::string_view name : not_of_the_origin)
        options.erase(std::string(name));
    for (const OptionGroup& group : command.groups)
        for (const Option& option : group.options)
            if (option.of_each_file)
                options.erase(option.name);
    options["units-mm"] = job.write.units_mm; // whether given or not
    options["short"] = job.write.short_form;
    if (const auto* const listed = std::get_if<ListedPlanes>(&job.layering.cut))
        options["z-list"] = listed->z;
    if (job.scan)
        options["strategy"] = strategy_json(*job.scan);
    Json inputs = Json::array();
    for (const PlateInput& input : job.inputs)
        inputs.push_back(input_json(input));
    return {{"lamella", version()},
            {"format", job.output.empty() ? "" : layer_format(job.format, job.output).name},
            {"inputs", std::move(inputs)},
            {"options", std::move(options)}};
}

Json shard_origin(const Command& command, const FileJob& job, const Execution& execution) {
    Json origin = job_parameters(command, job);
    origin["shards"] = job.shard->count;
    for (std::size_t i = 0; i < job.inputs.size(); ++i)
        origin["inputs"][i]["hash"] = hash_text(job.inputs[i].path, execution);
    return origin;
}

bool is_finished_shard(const FileJob& job, const std::string& stats, const Json& origin,
                       const Execution& execution) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(job.output, ignored) ||
        !std::filesystem::exists(stamp_path(job.output), ignored))
        return false;
    const Json stamp = Json::parse(read_text_file(stamp_path(job.output)), nullptr, false);
    const auto has = [&](const char* key, const std::string& path) {
        if (path.empty())
            return true;
        const Json file = file_json(path, execution);
        return !file.is_null() && stamp.value(key, Json()) == file;
    };
    return stamp.is_object() && first_difference(stamp.value("origin", Json()), origin).empty() &&
           stamp.value("shard", Json()) == Json(job.shard->number) && has("output", job.output) &&
           has("stats", stats) && has("report", job.report.path);
}

void remove_stamp_without_output(const std::string& output) {
    std::error_code ignored;
    if (std::filesystem::status(output, ignored).type() == std::filesystem::file_type::not_found)
        std::filesystem::remove(stamp_path(output), ignored);
}

void stamp_shard(const FileJob& job, const std::string& stats, const FileResult& result, const Json& origin,
                 const Execution& execution) {
    const Json stamp{{"shard", job.shard->number},
                     {"layers", {result.shard.begin, result.shard.end}},
                     {"of", result.planned_layers},
                     {"origin", origin},
                     {"output", output_json(job.output, execution)},
                     {"stats", file_json(stats, execution)},
                     {"report", file_json(job.report.path, execution)}};
    write_text_file(stamp_path(job.output), stamp.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void check_stamps(const std::vector<std::string>& paths, const Execution& execution) {
    const auto has_stamp = [](const std::string& path) {
        std::error_code ignored; // if the path cannot be examined or is too long, there is no stamp
        return std::filesystem::exists(stamp_path(path), ignored);
    };
    if (std::none_of(paths.begin(), paths.end(), has_stamp))
        return;
    std::vector<Stamped> files;
    for (const std::string& path : paths) {
        if (!has_stamp(path))
            throw Error(ErrorKind::input,
                        fmt::format("{}: has no stamp ({}), and others have; a shard without a stamp is not "
                                    "finished",
                                    path, stamp_path(path)));
        files.push_back(stamped(path, execution));
    }
    std::sort(files.begin(), files.end(),
              [](const Stamped& a, const Stamped& b) { return a.begin < b.begin; });
    const Stamped& first = files.front();
    std::uint64_t next = 0;
    const auto missing = [&](std::uint64_t end) {
        throw Error(
            ErrorKind::input,
            fmt::format("layers {} to {} of {} are in none of the files: a shard is missing; name it, "
                        "too, or slice it again",
                        next, end - 1, first.stamp["of"].get<std::uint64_t>()));
    };
    const Stamped* last = &first;
    for (const Stamped& file : files) {
        check_origins(first, file);
        if (file.begin > next)
            missing(file.begin);
        if (file.begin < next)
            throw Error(ErrorKind::input,
                        fmt::format("{}: holds layers from {} on, and {} holds those up to {}; name each "
                                    "shard once",
                                    file.path, file.begin, last->path, next - 1));
        next = file.end;
        last = &file;
    }
    if (const auto all = first.stamp["of"].get<std::uint64_t>(); next < all)
        missing(all);
}

} // namespace lamella::app

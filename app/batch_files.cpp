#include "batch_files.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/inputs/read_file.hpp"

#include "names.hpp"
#include "numbers.hpp"
#include "standard_streams.hpp"
#include "system/program_start.hpp"
#include "text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

namespace lamella::app {
namespace {

namespace fs = std::filesystem;

/// Returns the name without the extension, and without that of gzip.
fs::path stem_of(const fs::path& path) {
    const fs::path name = path.filename();
    return extension_of(name) == ".gz" ? name.stem().stem() : name.stem();
}

[[noreturn]] void refuse(const std::string& source, const std::string& what) {
    throw Error(ErrorKind::input, fmt::format("{}: {}", source, what));
}

/// Returns whether a path is a pipe, socket or device. These are skipped, because their data may never end
/// and the user did not name them.
bool is_stream(const fs::path& path) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    return fs::is_other(status);
}

/// Appends the meshes in a folder and its subfolders, except for the folder `apart`. Calls `fail` with the
/// path and the reason if a folder cannot be listed.
template <class Fail>
void find_meshes(const fs::path& folder, const fs::path& apart, std::vector<std::string>& found,
                 const Fail& fail) {
    std::error_code error;
    fs::directory_iterator entries(folder, error);
    for (; !error && entries != fs::directory_iterator(); entries.increment(error)) {
        const fs::path& path = entries->path();
        if (path.filename().generic_string().starts_with('.'))
            continue;
        std::error_code ignored;
        if (entries->is_directory(ignored)) {
            // Links are not followed: they may form a cycle.
            if (!entries->is_symlink(ignored) &&
                (apart.empty() || fs::weakly_canonical(path, ignored) != apart))
                find_meshes(path, apart, found, fail);
        } else if (is_mesh_name(path.generic_string()) && !is_stream(path)) {
            found.push_back(path.generic_string());
        }
    }
    if (error)
        fail(folder, error);
}

std::vector<std::string> files_in(const std::string& folder, const std::string& results) {
    std::error_code error;
    fs::path apart = results.empty() ? fs::path() : fs::weakly_canonical(results, error);
    if (apart == fs::canonical(folder, error))
        apart.clear();
    std::vector<std::string> found;
    find_meshes(folder, apart, found, [&](const fs::path& at, const std::error_code& why) {
        if (at == folder)
            refuse(folder, fmt::format("the folder cannot be listed: {}", why.message()));
        // The folder is added to the files; opening it will give the same error.
        found.push_back(at.generic_string());
    });
    if (found.empty())
        refuse(folder, fmt::format("no file in this folder has a name as of a mesh (.{}); other names can be "
                                   "given in a list",
                                   fmt::join(mesh_extensions(), ", .")));
    std::sort(found.begin(), found.end());
    return found;
}

std::vector<std::string> lines_of(const std::string& list, std::string_view text) {
    const char separator = text.find('\0') == std::string_view::npos ? '\n' : '\0';
    std::vector<std::string> lines;
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::size_t end = text.find(separator);
        std::string_view line = text.substr(0, end);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        if (separator == '\n' && line.ends_with('\r'))
            line.remove_suffix(1);
        if (line.empty() || (separator == '\n' && line.starts_with('#')))
            continue;
        if (line.size() >= longest_path())
            refuse(list, fmt::format("line {} is longer than any path; expected one path a line", number));
        lines.emplace_back(line);
    }
    return lines;
}

std::vector<std::string> files_listed(const std::string& list) {
    if (is_mesh_name(list))
        throw Error(
            ErrorKind::usage,
            fmt::format("{}: has the name of a mesh; expected a folder, or a file that lists paths, one "
                        "a line",
                        list));
    std::vector<std::string> lines = lines_of(input_name(list), read_text_file(list));
    if (lines.empty())
        refuse(input_name(list), "the list names no file; expected one path a line");
    if (std::find(lines.begin(), lines.end(), "-") != lines.end())
        refuse(input_name(list), "standard input (-) cannot be one of many files");
    return lines;
}

fs::path common_folder(std::span<const fs::path> paths) {
    std::optional<fs::path> common;
    for (const fs::path& path : paths) {
        const fs::path folder = path.parent_path();
        if (!common) {
            common = folder;
            continue;
        }
        fs::path shared;
        auto ours = common->begin();
        for (auto theirs = folder.begin();
             ours != common->end() && theirs != folder.end() && *ours == *theirs; ++ours, ++theirs)
            shared /= *ours;
        common = std::move(shared);
    }
    return common.value_or(fs::path());
}

/// Returns the pattern with these values for {name}, {folder} and {index}.
std::string filled(std::string_view pattern, const std::array<std::string, 3>& values) {
    constexpr std::array<std::string_view, 3> placeholders{"{name}", "{folder}", "{index}"};
    std::string text;
    std::string_view rest = pattern;
    for (std::size_t brace = 0; (brace = rest.find('{')) != std::string_view::npos;) {
        text += rest.substr(0, brace);
        rest.remove_prefix(brace);
        const auto found =
            std::find_if(placeholders.begin(), placeholders.end(),
                         [&](std::string_view placeholder) { return rest.starts_with(placeholder); });
        if (found == placeholders.end()) {
            const std::size_t end = rest.find('}');
            throw Error(ErrorKind::usage,
                        fmt::format("{}: \"{}\" is none of {{name}}, {{folder}} and {{index}}", pattern,
                                    excerpt(rest.substr(0, end == std::string_view::npos ? end : end + 1))));
        }
        text += values.at(static_cast<std::size_t>(found - placeholders.begin()));
        rest.remove_prefix(found->size());
    }
    return text.append(rest);
}

/// Returns "out/a.obj.cli" for "out/a.cli" and ".obj".
std::string with_tag(const fs::path& name, const std::string& tag) {
    return (name.parent_path() / (name.stem().generic_string() + tag + name.extension().generic_string()))
        .generic_string();
}

} // namespace

std::vector<std::string> batch_inputs(const std::string& source, const std::string& results) {
    std::error_code ignored;
    return fs::is_directory(source, ignored) ? files_in(source, results) : files_listed(source);
}

void check_distinct(std::span<const std::string> inputs, std::span<const std::string> outputs) {
    std::map<fs::path, const std::string*> places;
    for (const std::string& output : outputs)
        if (const auto [other, is_new] = places.emplace(place_of(output), &output); !is_new)
            throw Error(ErrorKind::usage,
                        fmt::format("{} and {} are one file, through a link; choose another folder",
                                    *other->second, output));
    std::map<FileIdentity, const std::string*> known;
    for (const std::string& input : inputs)
        if (const auto file = identity_of(input))
            known.emplace(*file, &input);
    for (const std::string& output : outputs) {
        const auto file = identity_of(output);
        if (!file)
            continue;
        if (const auto found = known.find(*file); found != known.end())
            throw Error(ErrorKind::usage,
                        fmt::format("{}: this output would overwrite the input {}; choose another folder",
                                    output, *found->second));
    }
}

bool has_placeholder(std::string_view pattern) noexcept {
    return pattern.find('{') != std::string_view::npos;
}

bool OutputNames::take(const std::string& name) {
    return !folders_.contains(name) && taken_.insert(name).second;
}

void OutputNames::note_folders(const fs::path& name) {
    for (fs::path folder = name.parent_path(); !folder.empty() && folder != folder.parent_path();
         folder = folder.parent_path()) {
        if (taken_.contains(folder.generic_string()))
            throw Error(ErrorKind::usage,
                        fmt::format("{}: would lie within the result {}; choose another folder",
                                    name.generic_string(), folder.generic_string()));
        if (!folders_.insert(folder.generic_string()).second)
            return; // its parent folders are known, too
    }
}

std::vector<std::string> OutputNames::give(std::span<const std::string> inputs, const std::string& pattern,
                                           std::string_view extension) {
    std::vector<fs::path> paths;
    for (const std::string& input : inputs) {
        std::error_code error;
        paths.push_back(fs::absolute(input, error).lexically_normal());
        if (error)
            refuse(input, fmt::format("the working folder, in which this path begins, cannot be found: {}",
                                      error.message()));
    }
    const fs::path shared = common_folder(paths);
    std::vector<fs::path> wanted;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        const fs::path folder = paths[i].parent_path().lexically_relative(shared);
        const std::string stem = stem_of(paths[i]).generic_string();
        const fs::path named =
            has_placeholder(pattern)
                ? fs::path(filled(pattern, {stem, folder.generic_string(), std::to_string(i)}))
                : fs::path(pattern) / folder / (stem + std::string(extension));
        wanted.push_back(named.lexically_normal());
        note_folders(wanted.back());
    }
    std::vector<std::string> names;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        std::string name = wanted[i].generic_string();
        const std::string own = paths[i].extension().generic_string();
        for (std::size_t number = 1; !take(name); ++number)
            name = with_tag(wanted[i], number == 1 ? own : fmt::format("{}-{}", own, number));
        names.push_back(std::move(name));
    }
    return names;
}

} // namespace lamella::app
